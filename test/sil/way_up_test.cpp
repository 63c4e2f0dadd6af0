// No dead end: whatever happens to a simulated robot, somebody who only does what the screen says has it on its feet
// again.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <utility>

#include "control/control_cycle.hpp"
#include "control/control_setup.hpp"
#include "control/controller_outbox.hpp"
#include "control/fixtures.hpp"
#include "hal/bus_cycle.hpp"
#include "keyboard/key_command.hpp"
#include "operator/mode_wish.hpp"
#include "operator/robot_driver.hpp"
#include "operator/robot_text.hpp"
#include "runtime/comms.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::sil {
namespace {

/// Drives whose command and whose sensors something may spoil.
class SpoiltDrives final : public hal::Hal {
 public:
  explicit SpoiltDrives(hal::Hal& drives) : drives_(drives) {}
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    if (!limp) return spoilt(drives_.exchange(command, state), state);
    released_ = command;
    released_.kp.setZero();
    released_.kd.setZero();
    released_.tau_ff.setZero();
    return spoilt(drives_.exchange(released_, state), state);
  }
  bool limp = false;  ///< the power is off
  std::function<hal::BusStatus(model::RobotState&)> spoil;

 private:
  hal::BusStatus spoilt(hal::BusStatus status, model::RobotState& state) const noexcept {
    return spoil ? spoil(state) : status;
  }
  hal::Hal& drives_;
  model::JointCommand released_;
};

/// A policy whose results something may spoil.
class SpoiltPolicy final : public policy::Policy {
 public:
  using Spoil = std::function<void(const Reference&, policy::Status&, JointVector&)>;
  SpoiltPolicy(std::unique_ptr<policy::Policy> own, const Spoil& spoil) : own_(std::move(own)), spoil_(spoil) {}
  Variant variant() const override { return own_->variant(); }
  std::optional<policy::DriveGains> gains() const override { return own_->gains(); }
  std::optional<double> action_bound_rad() const override { return own_->action_bound_rad(); }
  bool needs_ground() const override { return own_->needs_ground(); }
  void reset() noexcept override { own_->reset(); }
  void unsent() noexcept override { own_->unsent(); }
  policy::Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
                     JointVector& q_des) noexcept override {
    policy::Status status = own_->act(state, reference, observed, q_des);
    if (spoil_) spoil_(reference, status, q_des);
    return status;
  }

 private:
  std::unique_ptr<policy::Policy> own_;
  const Spoil& spoil_;
};

/// What something may spoil within the control thread.
struct SpoiltTick final : control::TickSpoiler {
  void spoil(Reference& reference) noexcept override {
    if (reference_is_none) reference.q.setConstant(std::nan(""));
  }
  void spoil(control::TickResult& result) noexcept override {
    if (command_is_none) result.command.q.setConstant(std::nan(""));
  }
  bool reference_is_none = false, command_is_none = false;
};

/// Controller, simulated robot on its hoist, network and keyboard in one thread, on a clock that the simulation moves.
class Driven {
 public:
  Driven() {
    loaded.policy = std::make_unique<SpoiltPolicy>(std::move(loaded.policy), spoil_policy);
    loaded.options.spoiler = &spoilt_tick;
    tick = control::make_tick(loaded, clock);
    cycle = std::make_unique<control::ControlCycle>(*tick, bus_link, inbox, clock);
    bus = std::make_unique<hal::BusCycle>(drives, bus_link, loaded.robot, clock);
    run_info.robot = "z1";
    run_info.session = 1;
    run_info.options = control::control_json(loaded).dump();
    comms = std::make_unique<runtime::Comms>(link, inbox, outbox, loaded.robot, run_info, 100.0, clock);
    comms->work(robot.hoist_line());
    bus->run();
  }
  const control::TickResult& result() const { return cycle->record().result; }
  const ops::RobotNews* news() const {
    const auto found = board.robots().find("z1");
    return found == board.robots().end() ? nullptr : &found->second;
  }

  void step() {  // 10 ms
    if (!control_sleeps) {
      cycle->run(clock.now_ns() - late_ns);
      outbox.publish(cycle->record());
    }
    for (int k = 0; k < 5; ++k) {
      clock.advance_to(clock.now_ns() + hal::BusCycle::kPeriod_ns);
      if (!bus_sleeps) bus->run();
      comms->step(0);
      link.receive(0);
    }
    driver.step(news());
  }
  void run(double seconds) {
    for (double t_s = 0.0; t_s < seconds; t_s += 0.01) step();
  }
  void press(const char* key) { keys.press(key, false, clock.now_ns()); }
  /// A key that is held for so long.
  void hold(const char* key, double seconds) {
    for (double t_s = 0.0; t_s < seconds; t_s += 0.1) {
      if (t_s == 0.0) press(key);
      keys.repeat(key, false, clock.now_ns());
      run(0.1);
    }
    keys.release(key, clock.now_ns());
  }
  /// Another operator's, as by pmg_send.
  void ask(ops::Goal goal) {
    ops::ModeWish wish(other, "z1", goal, 2.0);
    for (int k = 0; k < 300 && wish.step() == ops::Progress::kPending; ++k) step();
    answer = wish.answers().front();
  }
  double lean_rad() const {
    return std::acos(std::clamp((world.truth().q_WT * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  }
  bool stands_alone() {
    return control::upright(result().mode) && robot.hoist_line()->state() == hal::CraneState::kFree &&
           lean_rad() < 0.2 && world.torso_height_m() > -0.1;
  }

  /// Presses what the screen says first, as long as it says something. Returns the texts that it read.
  std::vector<std::string> do_what_the_screen_says(double at_most_s = 60.0) {
    static constexpr std::array<std::pair<const char*, const char*>, 6> kSaid = {
        {{"H lifts it", "h"},
         {"G sets it down", "g"},
         {"R resets it", "r"},
         {"Enter makes it stand up", "enter"},
         {"a key makes it stand up and walk", "w"},
         {"the hoist takes it up", ""}}};
    std::vector<std::string> read;
    for (double t_s = 0.0; t_s < at_most_s; t_s += 0.5) {
      run(0.5);
      const std::string text = driver.text();
      if (read.empty() || read.back() != text) read.push_back(fmt::format("{:.1f} s: {}", t_s, text));
      if (text.starts_with("stands;") && robot.hoist_line()->state() == hal::CraneState::kFree) break;
      const auto* first = std::ranges::min_element(kSaid, {}, [&](const auto& said) { return text.find(said.first); });
      if (text.find(first->first) != std::string::npos && *first->second != '\0') hold(first->second, 0.1);
    }
    run(1.0);
    return read;
  }

  bool control_sleeps = false, bus_sleeps = false;  ///< the thread; its computer does something else
  std::int64_t late_ns = 0;                         ///< of each tick
  SpoiltPolicy::Spoil spoil_policy;
  SpoiltTick spoilt_tick;
  io::SimulationClock clock;
  io::LcmLink link{"memq://"};
  control::LoadedControl loaded = control::load_control({});
  sim::World world{test::z1(), world_with_noise(7, true)};
  SimulatedRobot robot{world, HoistedBy::kCrane, false};
  SpoiltDrives drives{robot};
  hal::BusLink bus_link;
  control::OperatorInbox inbox{bus_link.stop};
  control::ControllerOutbox outbox;
  recording::RunInfo run_info;
  std::unique_ptr<control::Tick> tick;
  std::unique_ptr<control::ControlCycle> cycle;
  std::unique_ptr<hal::BusCycle> bus;
  std::unique_ptr<runtime::Comms> comms;
  ops::OperatorSource source{link, "keyboard", 1, clock}, other{link, "other", 1, clock};
  ops::RobotBoard board{link, clock};
  ops::KeyCommand keys{ops::KeyReport::kPressAndRelease};
  ops::RobotDriver driver{source, "z1", keys};
  ops::Answer answer;
};

struct Mishap {
  const char* name;
  void (*happens)(Driven&);
  faults::FaultCode fault = faults::FaultCode::kNone;  ///< that it ends in; kNone: whatever it ends in
};

void PrintTo(const Mishap& mishap, std::ostream* out) { *out << mishap.name; }

void spoil_for(Driven& driven, double seconds, std::function<hal::BusStatus(model::RobotState&)> spoil) {
  driven.drives.spoil = std::move(spoil);
  driven.run(seconds);
  driven.drives.spoil = nullptr;
}

/// The state that the drives report, for a tenth of a second.
void misread(Driven& driven, void (*spoil)(model::RobotState&)) {
  spoil_for(driven, 0.1, [spoil](model::RobotState& state) {
    spoil(state);
    return hal::BusStatus::kOk;
  });
}

/// One of Driven's flaws, for so long.
template <typename Flaw>
void with(Driven& driven, Flaw& flaw, Flaw bad, double seconds) {
  const Flaw good = std::exchange(flaw, std::move(bad));
  driven.run(seconds);
  flaw = good;
}

constexpr int kKnee = 3;

using faults::FaultCode;

const std::array kMishaps = {
    Mishap{"NothingAtAll", [](Driven&) {}},
    Mishap{"StoppedAMomentAgo",
           [](Driven& driven) {
             driven.press("escape");
             driven.run(0.1);
           }},
    Mishap{"StoppedAndLies",
           [](Driven& driven) {
             driven.press("escape");
             driven.run(3.0);
           }},
    Mishap{"StoppedByAnotherAsItWalks",
           [](Driven& driven) {
             driven.hold("w", 2.0);
             driven.ask(ops::Goal::kDamping);
             driven.run(3.0);
           }},
    Mishap{"LimpByAnother",
           [](Driven& driven) {
             driven.ask(ops::Goal::kDamping);
             driven.run(1.0);
             driven.ask(ops::Goal::kPassive);
             driven.run(2.0);
             EXPECT_EQ(driven.result().mode, control::Mode::kPassive);
           }},
    Mishap{"PowerOffAndTilted",
           [](Driven& driven) {
             driven.drives.limp = true;
             driven.run(3.0);
             driven.drives.limp = false;
             EXPECT_EQ(driven.result().mode, control::Mode::kFault);
           }},
    Mishap{"TooHot",
           [](Driven& driven) {
             spoil_for(driven, 2.0, [](model::RobotState& state) {
               state.temperature_degC[kKnee] = 200.0;
               return hal::BusStatus::kOk;
             });
           },
           FaultCode::kTemperature},
    Mishap{"SensorWithoutANumber",
           [](Driven& driven) { misread(driven, [](model::RobotState& s) { s.q[kKnee] = std::nan(""); }); },
           FaultCode::kStateNotFinite},
    Mishap{"JointTooFast",
           [](Driven& driven) {
             driven.hold("w", 2.0);
             misread(driven, [](model::RobotState& s) { s.dq[kKnee] = 100.0; });
           },
           FaultCode::kJointVelocity},
    Mishap{"JointBeyondItsRange",
           [](Driven& driven) { misread(driven, [](model::RobotState& s) { s.q[kKnee] = 4.0; }); },
           FaultCode::kJointLimit},
    Mishap{"TorqueTooLarge",
           [](Driven& driven) { misread(driven, [](model::RobotState& s) { s.tau[kKnee] = 156.0; }); },
           FaultCode::kJointTorque},
    Mishap{"ImuReadsATilt",
           [](Driven& driven) {
             misread(driven, [](model::RobotState& s) {
               s.orientation_WI = Eigen::AngleAxisd(1.3, Eigen::Vector3d::UnitX()) * s.orientation_WI;
             });
           },
           FaultCode::kTilt},
    Mishap{"ImuReadsALean",
           [](Driven& driven) {
             misread(driven, [](model::RobotState& s) {
               s.orientation_WI = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()) * s.orientation_WI;
             });
           },
           FaultCode::kTorsoAttitude},
    Mishap{"BusLostAsItStands",
           [](Driven& driven) { spoil_for(driven, 0.1, [](model::RobotState&) { return hal::BusStatus::kLost; }); },
           FaultCode::kBusLost},
    Mishap{"BusLostInTheAir",
           [](Driven& driven) {
             driven.press("h");
             driven.run(6.0);
             spoil_for(driven, 0.1, [](model::RobotState&) { return hal::BusStatus::kLost; });
           },
           FaultCode::kBusLost},
    Mishap{"BusThreadSleeps", [](Driven& driven) { with(driven, driven.bus_sleeps, true, 0.1); },
           FaultCode::kStaleState},
    Mishap{"ControlThreadSleeps",
           [](Driven& driven) {
             with(driven, driven.control_sleeps, true, 0.1);
             driven.run(0.1);
           },
           FaultCode::kControlFrozen},
    Mishap{"TicksAreLate", [](Driven& driven) { with(driven, driven.late_ns, std::int64_t{12'000'000}, 0.3); },
           FaultCode::kOverrun},
    Mishap{"CommandWithoutANumber",
           [](Driven& driven) {
             with(driven, driven.spoilt_tick.command_is_none, true, 0.02);
             driven.run(0.1);
           },
           FaultCode::kCommandNotFinite},
    Mishap{"ReferenceWithoutANumber",
           [](Driven& driven) {
             with(driven, driven.spoilt_tick.reference_is_none, true, 0.1);
             driven.run(2.0);
           },
           FaultCode::kReferenceNotFinite},
    Mishap{"PolicyIsLate",
           [](Driven& driven) {
             with(driven, driven.spoil_policy, SpoiltPolicy::Spoil([](const Reference&, policy::Status& status, auto&) {
                    status = policy::Status::kLate;
                  }),
                  0.3);
           },
           FaultCode::kStalePolicy},
    Mishap{"PolicyWithoutANumber",
           [](Driven& driven) {
             with(driven, driven.spoil_policy, SpoiltPolicy::Spoil([](const Reference&, policy::Status&, auto& q_des) {
                    q_des[kKnee] = std::nan("");
                  }),
                  0.1);
           },
           FaultCode::kPolicyNotFinite},
    Mishap{"PolicyPullsFarAway",
           [](Driven& driven) {
             with(driven, driven.spoil_policy,
                  SpoiltPolicy::Spoil([](const Reference& reference, policy::Status&, auto& q_des) {
                    q_des[q_des.size() - 1] = reference.q[q_des.size() - 1] + 5.0;  // an arm's: no fall
                  }),
                  0.4);
           },
           FaultCode::kActionOutOfRange},
    Mishap{"LiftedAsItWalks",
           [](Driven& driven) {
             driven.hold("w", 2.0);
             driven.press("h");
             driven.run(1.0);
           }},
    Mishap{"KeysThatItRefuses",
           [](Driven& driven) {
             driven.press("escape");
             driven.run(3.0);
             for (const char* key : {"enter", "r", "w", "enter", "g"}) {
               driven.press(key);
               driven.run(0.5);
             }
             EXPECT_EQ(driven.result().mode, control::Mode::kDamping)
                 << "a lying robot's request for Stand is no fault";
           }},
};

void let_happen(const Mishap& mishap, Driven& driven) {
  mishap.happens(driven);
  if (mishap.fault == FaultCode::kNone) return;
  EXPECT_EQ(driven.result().mode, control::Mode::kFault);
  EXPECT_STREQ(to_string(driven.result().fault.code), to_string(mishap.fault));
}

TEST(WayUpFaults, EveryFaultHasAMishapThatEndsInIt) {
  for (std::size_t code = 1; code < faults::kFaultCodes; ++code) {
    const auto fault = static_cast<FaultCode>(code);
    EXPECT_NE(std::ranges::find(kMishaps, fault, &Mishap::fault), kMishaps.end()) << to_string(fault);
  }
}

class WayUp : public testing::TestWithParam<Mishap> {};

TEST_P(WayUp, WhatTheScreenSaysEndsOnItsFeet) {
  Driven driven;
  driven.run(1.5);  // the robot's name and limits are known
  driven.press("enter");
  driven.do_what_the_screen_says(20.0);
  ASSERT_TRUE(driven.stands_alone()) << driven.driver.text();
  let_happen(GetParam(), driven);
  const std::vector<std::string> read = driven.do_what_the_screen_says();
  EXPECT_TRUE(driven.stands_alone()) << testing::PrintToString(read);
}

/// Four of them one after another, each after up to two seconds.
class WayUpAgain : public testing::TestWithParam<std::uint64_t> {};

TEST_P(WayUpAgain, WhateverHappensInWhateverOrderItEndsOnItsFeet) {
  Driven driven;
  driven.run(1.5);
  std::mt19937_64 random(GetParam());
  std::vector<std::string> read = driven.do_what_the_screen_says(20.0);
  for (int k = 0; k < 4; ++k) {
    ASSERT_TRUE(driven.stands_alone()) << testing::PrintToString(read);
    const Mishap& mishap = kMishaps.at(random() % kMishaps.size());
    SCOPED_TRACE(mishap.name);
    driven.run(static_cast<double>(random() % 200) * 0.01);
    let_happen(mishap, driven);
    read = driven.do_what_the_screen_says();
  }
  EXPECT_TRUE(driven.stands_alone()) << testing::PrintToString(read);
}

INSTANTIATE_TEST_SUITE_P(Seeds, WayUpAgain, testing::Values(1, 2, 3, 4, 5));

INSTANTIATE_TEST_SUITE_P(Mishaps, WayUp, testing::ValuesIn(kMishaps),
                         [](const auto& mishap) { return std::string(mishap.param.name); });

TEST(WayUpText, ALyingRobotsRequestIsRefusedWithTheWayAndNothingElse) {
  Driven driven;
  driven.run(1.5);
  driven.press("enter");
  driven.do_what_the_screen_says(20.0);
  driven.press("escape");
  driven.run(3.0);
  driven.ask(ops::Goal::kStand);
  EXPECT_EQ(driven.answer.progress, ops::Progress::kFailed);
  EXPECT_THAT(driven.answer.text, testing::HasSubstr("leans too far"));
  driven.press("enter");
  driven.run(0.2);
  EXPECT_THAT(driven.driver.text(),
              testing::MatchesRegex(
                  "it leans too far to stand up: lies \\(1\\.[0-9]+ rad from upright\\): H lifts it, then Enter "
                  "makes it stand up"));
  EXPECT_EQ(driven.result().mode, control::Mode::kDamping);
  const std::vector<std::string> screen = ops::screen(*driven.news(), 0.0);
  EXPECT_THAT(screen, testing::Contains(testing::MatchesRegex("next +lies .*: pmg_send lift lifts it, then .*")));
  EXPECT_THAT(screen, testing::Not(testing::Contains(testing::StartsWith("asked")))) << "no command is in force";
}

}  // namespace
}  // namespace pmg::sil
