// A simulation waits for its computer: Z1 walks while a thread of its controller is late on purpose, on a clock that
// only the test moves. A robot doesn't wait, and a thread that hangs is a fault in a simulation, too.
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <random>

#include "control/control_cycle.hpp"
#include "hal/bus_cycle.hpp"
#include "runtime/periodic_schedule.hpp"
#include "runtime/turns.hpp"
#include "sil/varied_robot.hpp"

namespace pmg::sil {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// Bus and control thread as runtime::Controller has them, each woken as late as it is told.
class LateComputer {
 public:
  using Lateness = std::function<std::int64_t(std::int64_t cycle)>;  ///< (number of the wake-up) => how late [ns]

  explicit LateComputer(bool waits) {
    if (waits) turns_.emplace();
  }

  /// So many ticks more: the first 150 stand, then the robot walks. false: it didn't get so far within ten times the
  /// time.
  bool run(std::int64_t ticks, const Lateness& bus_late, const Lateness& control_late) {
    const std::int64_t last = ticks_ + ticks, end_ns = clock_.now_ns() + 10 * ticks * control::ControlCycle::kPeriod_ns;
    while (ticks_ < last && clock_.now_ns() < end_ns) {
      if (bus_wakes_ns_ <= control_wakes_ns_) {
        clock_.advance_to(bus_wakes_ns_);
        wake_bus();
        bus_wakes_ns_ = bus_schedule_.planned_ns() + bus_late(++bus_wakes_);
      } else {
        clock_.advance_to(control_wakes_ns_);
        if (wake_control()) {
          control_wakes_ns_ = control_schedule_.planned_ns() + control_late(ticks_);
        } else {
          control_wakes_ns_ += runtime::Turns::kLook_ns;
        }
      }
    }
    return ticks_ == last;
  }

  /// From now on, wherever they are; the control thread is back a little later than the bus thread.
  void stop_both(std::int64_t for_ns) {
    bus_wakes_ns_ = std::max(bus_wakes_ns_, clock_.now_ns() + for_ns);
    control_wakes_ns_ = std::max(control_wakes_ns_, clock_.now_ns() + for_ns + 3 * kMillisecond_ns);
  }

  const control::TickResult& result() const { return cycle_.record().result; }
  std::uint32_t trips() const { return bus_.guard().trips(); }
  bool damping() const { return bus_.guard().damping(); }
  std::uint64_t longest_step() const { return longest_step_; }  ///< bus samples between two ticks
  std::uint64_t shortest_step() const { return shortest_step_; }
  std::int64_t lost_ns() const { return turns_ ? turns_->lost_ns() : 0; }
  double time_s() const { return it_.world.time_s(); }  ///< of the physics

 private:
  void wake_bus() {
    for (int due = turns_ ? turns_->due(clock_.now_ns()) : 1; due > 0; --due) bus_.run();
    if (turns_) turns_->ran();
    bus_schedule_.advance(clock_.now_ns(), clock_.now_ns());
  }
  bool wake_control() {
    if (turns_ && !turns_->may_tick()) return false;
    speak();
    cycle_.run(turns_ ? clock_.now_ns() : control_schedule_.planned_ns());
    if (turns_) turns_->ticked(control_schedule_.planned_ns());
    const std::uint64_t sample = cycle_.record().state.bus_sample;
    if (ticks_++ > 0) {
      longest_step_ = std::max(longest_step_, sample - sample_);
      shortest_step_ = std::min(shortest_step_, sample - sample_);
    }
    sample_ = sample;
    control_schedule_.advance(clock_.now_ns(), clock_.now_ns());
    return true;
  }
  void speak() {
    const std::int64_t now_ns = clock_.now_ns();
    const control::Source source = control::Source::make("test", 1);
    control::DriveMessage drive{.source = source,
                                .sequence = ++sequence_,
                                .stamp_ns = now_ns,
                                .received_ns = now_ns,
                                .lease_s = 2.0,
                                .command = {}};
    drive.command[kVx] = 0.4;
    inbox_.put(drive);
    if (ticks_ != 1 && ticks_ != 150) return;
    inbox_.put(control::ModeRequest{.source = source,
                                    .sequence = ++sequence_,
                                    .stamp_ns = now_ns,
                                    .received_ns = now_ns,
                                    .mode = ticks_ == 1 ? control::Mode::kStand : control::Mode::kWalk});
  }

  test::VariedRobot it_{0, "pmg", [](auto own) { return own; },
                        [](control::TickOptions& options) { expect_shared_host(options); }};
  io::SimulationClock clock_;
  hal::BusLink link_;
  control::OperatorInbox inbox_{link_.stop};
  hal::BusCycle bus_{it_.drives, link_, it_.robot, clock_, it_.tick->guard()};
  control::ControlCycle cycle_{*it_.tick, link_, inbox_, clock_};
  std::optional<runtime::Turns> turns_;
  // The control thread's cycles begin 0.8 ms after one of the bus thread's, after the first ones.
  runtime::PeriodicSchedule bus_schedule_{2 * kMillisecond_ns, hal::BusCycle::kPeriod_ns};
  runtime::PeriodicSchedule control_schedule_{10'800'000, control::ControlCycle::kPeriod_ns};
  std::int64_t bus_wakes_ns_ = 2 * kMillisecond_ns, control_wakes_ns_ = 10'800'000;
  std::int64_t ticks_ = 0, bus_wakes_ = 0, sequence_ = 0;
  std::uint64_t sample_ = 0, longest_step_ = 0, shortest_step_ = 1000;
};

std::int64_t in_time(std::int64_t /*cycle*/) { return 0; }

/// One wake-up in twenty up to 0.3 s late, one in four a few milliseconds.
LateComputer::Lateness loaded(std::uint64_t seed) {
  return [random = std::mt19937_64(seed)](std::int64_t cycle) mutable -> std::int64_t {
    const std::uint64_t drawn = random() % 300;
    if (cycle < 200) return 0;  // the robot walks first
    return static_cast<std::int64_t>(drawn < 15 ? drawn * 20 : drawn < 90 ? drawn % 8 : 0) * kMillisecond_ns;
  };
}

TEST(WaitingSimulation, WhoseThreadsAreInTimeRunsAsFastAsARobot) {
  LateComputer computer(true);
  ASSERT_TRUE(computer.run(300, in_time, in_time));
  EXPECT_EQ(computer.longest_step(), 5u);
  EXPECT_EQ(computer.shortest_step(), 5u);
  EXPECT_LT(computer.lost_ns(), 2 * hal::BusCycle::kPeriod_ns);
  EXPECT_EQ(computer.result().mode, control::Mode::kWalk);
}

TEST(WaitingSimulation, PhysicsNeverPassALateControllerAndTheWalkGoesOn) {
  constexpr std::uint64_t kSeed = 32;
  LateComputer computer(true);
  ASSERT_TRUE(computer.run(400, loaded(kSeed), loaded(kSeed + 1)));
  EXPECT_EQ(computer.longest_step(), 5u) << "seed " << kSeed;
  EXPECT_EQ(computer.shortest_step(), 5u) << "the controller waits for late physics, too";
  EXPECT_EQ(computer.trips(), 0u);
  EXPECT_EQ(computer.result().mode, control::Mode::kWalk) << to_string(computer.result().fault.code);
  EXPECT_GT(computer.lost_ns(), 500 * kMillisecond_ns) << "what it waited for is told";
}

TEST(WaitingSimulation, ARobotDoesNotWait) {
  constexpr std::uint64_t kSeed = 32;
  LateComputer computer(false);
  computer.run(400, loaded(kSeed), loaded(kSeed + 1));
  EXPECT_GT(computer.longest_step(), 5u);
  EXPECT_GT(computer.trips(), 0u);
  EXPECT_EQ(computer.result().mode, control::Mode::kFault);
}

TEST(WaitingSimulation, AControlThreadThatHangsIsDampedAfterHalfASecondAndFaults) {
  LateComputer computer(true);
  const auto hangs_for = [](std::int64_t hang_ns) {
    return [hang_ns](std::int64_t tick) { return tick == 300 ? hang_ns : std::int64_t{0}; };
  };
  // 5 cycles of its turn, 250 that are left out, and the guard's 25, of which the turn's four are a part.
  ASSERT_TRUE(computer.run(301, in_time, hangs_for(700 * kMillisecond_ns)));
  EXPECT_EQ(computer.trips(), 1u);
  ASSERT_TRUE(computer.run(5, in_time, in_time));
  EXPECT_EQ(computer.result().fault.code, faults::FaultCode::kControlFrozen);

  LateComputer other(true);
  ASSERT_TRUE(other.run(302, in_time, hangs_for(480 * kMillisecond_ns)));
  EXPECT_EQ(other.trips(), 0u) << "it wasn't hanging yet";
  EXPECT_EQ(other.result().mode, control::Mode::kWalk);
}

TEST(WaitingSimulation, ABusThreadThatHangsIsAStaleState) {
  LateComputer computer(true);
  ASSERT_TRUE(computer.run(300, in_time, in_time));
  std::int64_t late_ns = 1200 * kMillisecond_ns;
  ASSERT_TRUE(computer.run(
      40, [&](std::int64_t) { return std::exchange(late_ns, 0); }, in_time));
  EXPECT_EQ(computer.result().fault.code, faults::FaultCode::kStaleState);
}

TEST(WaitingSimulation, AComputerThatStopsBothThreadsIsNoHang) {
  LateComputer computer(true);
  ASSERT_TRUE(computer.run(300, in_time, in_time));
  const double before_s = computer.time_s();
  computer.stop_both(3'000 * kMillisecond_ns);
  ASSERT_TRUE(computer.run(100, in_time, in_time));
  EXPECT_EQ(computer.trips(), 0u);
  EXPECT_EQ(computer.result().mode, control::Mode::kWalk) << to_string(computer.result().fault.code);
  EXPECT_LT(computer.time_s() - before_s, 1.1);
}

}  // namespace
}  // namespace pmg::sil
