// A log of led arms is enough to compute every tick again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "control/control_rig.hpp"
#include "control/control_setup.hpp"
#include "io/log_writer.hpp"
#include "log_surgery.hpp"
#include "logs/replay.hpp"
#include "pmg_msgs/arms_input_t.hpp"
#include "pmg_msgs/arms_state_t.hpp"
#include "pmg_msgs/arms_t.hpp"
#include "recording/tick_log.hpp"
#include "temporary_folder.hpp"

namespace pmg::logs {
namespace {

namespace fs = std::filesystem;

constexpr int kArmsTicks = 700, kFirstArms = 350, kLastArms = 600;

/// Z1 walks; from kFirstArms on its left palm circles and its right one is told what nobody may tell; after kLastArms
/// nothing more is heard of arms.
void record_arms(const fs::path& file) {
  control::ControlSetup setup;
  setup.robot = "z1";
  setup.policy = "none";
  control::LoadedControl loaded = control::load_control(setup);
  test::ControlRig rig(loaded.robot, loaded.library, loaded.options, false);
  recording::RunInfo run{.robot = "z1", .session = 1, .policy = "none"};
  run.options = control::control_json(loaded).dump();
  run.bundle = loaded.bundle;
  run.files = loaded.files;
  io::LogWriter writer(file);
  recording::TickLog log(writer, loaded.robot, run, 100.0);
  control::ArmsMessage arms{.source = rig.drive.source, .lease_s = 0.2};
  rig.drive.command[kVx] = 0.3;
  rig.ask(control::Mode::kWalk);
  for (int tick = 0; tick < kArmsTicks; ++tick) {
    const double t = 0.01 * (tick - kFirstArms);
    if (tick == kFirstArms) arms.arm[kLeft].palm = rig.tick.result().arms.arm[kLeft].palm;
    if (tick >= kFirstArms && tick < kLastArms) {
      ++arms.sequence;
      arms.stamp_ns = arms.received_ns = rig.clock.now_ns();
      arms.arm[kLeft].wish = control::ArmWish::kAim;
      arms.arm[kLeft].palm.p_m += 0.01 * Eigen::Vector3d(0.3 * std::cos(2.0 * t), 0.0, 0.3 * std::sin(2.0 * t));
      rig.inbox.put(arms);
      control::ArmsMessage stranger = arms;
      stranger.source = control::Source::make("stranger", 2);
      if (tick % 7 == 0) rig.inbox.put(stranger);
    }
    for (int cycle = 0; cycle < 5; ++cycle) rig.cycle();
    log.write(rig.control_cycle.record());
  }
  writer.flush();
}

class ArmsReplay : public testing::Test {
 protected:
  ArmsReplay() { record_arms(log_); }
  fs::path copy(const std::function<bool(test::LogEvent&)>& keep) const {
    test::copy_log(log_, folder_.file("copy.lcm"), keep);
    return folder_.file("copy.lcm");
  }

  const test::TemporaryFolder folder_;
  const fs::path log_ = folder_.file("log.lcm");
};

TEST_F(ArmsReplay, TicksWithLedArmsAreTheSameAgainBitForBit) {
  int states = 0, followed = 0, held = 0, refused = 0;
  for (const test::LogEvent& event : test::read_events(log_)) {
    if (event.channel != "ARMS_STATE") continue;
    const auto state = event.as<pmg_msgs::arms_state_t>();
    ++states;
    followed += state.left == pmg_msgs::arms_state_t::FOLLOWING;
    held += state.left == pmg_msgs::arms_state_t::HELD;
    refused += state.last_refusal == pmg_msgs::arms_state_t::OTHER_SOURCE;
  }
  EXPECT_EQ(states, kArmsTicks - kFirstArms) << "from the first target to the end, where the arm is still held";
  EXPECT_GT(followed, 200);
  EXPECT_GT(held, 50);
  EXPECT_GT(refused, 200);
  const ReplayReport report = replay({log_}, {});
  EXPECT_TRUE(report.equal()) << report.first->channel << " " << report.first->field << " at " << report.first->time_s;
  EXPECT_EQ(report.compared_messages, 3 * kArmsTicks + states);
  EXPECT_TRUE(report.notes.empty()) << report.notes.front();
}

TEST_F(ArmsReplay, EveryInputOfTheArmsCounts) {
  const auto differs = [&](const char* what, const std::function<bool(test::LogEvent&)>& keep) {
    EXPECT_FALSE(replay({copy(keep)}, {}).equal()) << what;
  };
  differs("target", [](test::LogEvent& event) {
    if (event.channel != "ARMS") return true;
    auto arms = event.as<pmg_msgs::arms_t>();
    if (arms.sequence == 100) arms.left_p_m[0] += 1e-3;
    event.set(arms);
    return true;
  });
  differs("reception", [](test::LogEvent& event) {
    if (event.channel != "ARMS_INPUT") return true;
    auto input = event.as<pmg_msgs::arms_input_t>();
    for (std::int64_t& received_ns : input.received_ns) received_ns -= 150'000'000;
    event.set(input);
    return true;
  });
  differs("report", [](test::LogEvent& event) {
    if (event.channel != "ARMS_STATE") return true;
    auto state = event.as<pmg_msgs::arms_state_t>();
    state.left_error_m = std::nextafter(state.left_error_m, 1.0);
    event.set(state);
    return true;
  });
}

TEST_F(ArmsReplay, MissingMessagesOfATickAreTold) {
  for (const char* channel : {"ARMS", "ARMS_INPUT"}) {
    bool first = true;
    const fs::path holed =
        copy([&](test::LogEvent& event) { return event.channel != channel || !std::exchange(first, false); });
    try {
      replay({holed}, {});
      ADD_FAILURE() << channel;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("not all in the log")) << channel;
    }
  }
}

}  // namespace
}  // namespace pmg::logs
