// Queues, stalls and cables that are out for a while: what comes late or bunched is one drive's, what is old counts as
// old, and two drives of one node number are named all the same.
#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "can/queued_robot.hpp"
#include "can/roll_call.hpp"

namespace pmg::can {
namespace {

using drives::Trouble;
using hal::BusStatus;
using test::QueuedRobot;

constexpr std::int64_t kMs_ns = 1'000'000;

/// Whatever happens to this bus and computer, within its queue's room.
class Disturbances {
 public:
  explicit Disturbances(std::uint64_t seed) : random_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  /// Even over the orders of magnitude.
  double spread(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool once_in(double cycles) { return uniform(0.0, cycles) < 1.0; }

  /// One cycle, perhaps with the begin of something.
  BusStatus cycle(QueuedRobot& robot) {
    test::QueuedBus& bus = *robot.bus;
    if (once_in(150)) bus.held_until_ns = robot.now_ns() + ms(4, 20);
    if (!bus.cut && once_in(400)) back_ns_ = robot.now_ns() + static_cast<std::int64_t>(kMs_ns * spread(5, 500));
    bus.cut = robot.now_ns() < back_ns_;
    if (hiccups_ == 0 && once_in(400)) hiccups_ = 3, next_ns_ = 0;
    std::int64_t stall_ns = once_in(150) ? ms(4, 20) : 0;
    if (hiccups_ > 0 && robot.now_ns() >= next_ns_) {  // three within 80 ms
      --hiccups_;
      next_ns_ = robot.now_ns() + ms(8, 35);
      (once_in(2) ? stall_ns : held_ns_) = 4 * kMs_ns;
      if (held_ns_ > 0) bus.held_until_ns = robot.now_ns() + held_ns_;
      held_ns_ = 0;
    }
    return robot.cycle(stall_ns);
  }
  void end(QueuedRobot& robot) {
    robot.bus->cut = false;
    robot.bus->held_until_ns = back_ns_ = hiccups_ = 0;
  }

 private:
  std::int64_t ms(double low, double high) { return static_cast<std::int64_t>(kMs_ns * uniform(low, high)); }

  std::mt19937_64 random_;
  std::int64_t back_ns_ = 0, next_ns_ = 0, held_ns_ = 0;
  int hiccups_ = 0;
};

/// Names a motor of which something is said that a queue, a stall or a cable can't cause; -1: none.
int falsely_named(const QueuedRobot& robot) {
  for (std::size_t m = 0; m < robot.bus->motors(); ++m) {
    const Trouble trouble = robot.trouble(m);
    for (const Trouble never : {Trouble::kTwoOfOneNode, Trouble::kPositionJump, Trouble::kFrozenEncoder})
      if (trouble == never) return static_cast<int>(m);
  }
  return -1;
}

constexpr int kDisturbedCycles = 1000;
/// A full queue of 1,000 frames takes 0.25 s on the wire with its answers, and as long again while commands go on. Then
/// the robot is damped for a while.
constexpr int kSettlesWithin = 700;
/// The robot may stand while a queue's last answers still come; as long again until what was given up is looked after.
constexpr int kLookedAfterWithin = 500;
/// What was lost before may be taken for a second drive's answers: as many as a queue holds.
constexpr int kNamedWithin = drives::AnswerLedger::kMostOwed + 100;

void expect_no_false_fault(std::uint64_t seed) {
  Disturbances disturbances(seed);
  const auto room = static_cast<std::size_t>(disturbances.spread(10, 1000));
  QueuedRobot robot(static_cast<std::size_t>(disturbances.uniform(1, 7.99)), room);
  for (int k = 0; k < kDisturbedCycles; ++k) {
    disturbances.cycle(robot);
    ASSERT_EQ(falsely_named(robot), -1) << robot.trouble() << "; seed " << seed << ", cycle " << k << ", room " << room;
  }
  disturbances.end(robot);
  robot.cycle();  // tells whether a cable that was out in the last cycle has taken the robot down
  for (int k = 0; k < kSettlesWithin && !robot.stands; ++k) robot.cycle();
  // One request of each motor in turn is left out, which makes its state a cycle older once; nothing is lost.
  for (int k = 0; k < kLookedAfterWithin; ++k) {
    ASSERT_NE(robot.cycle(), BusStatus::kLost) << robot.trouble() << "; seed " << seed << ", cycle " << k;
    ASSERT_EQ(falsely_named(robot), -1) << robot.trouble() << "; seed " << seed << ", room " << room;
  }
  ASSERT_TRUE(robot.stands) << robot.trouble() << "; seed " << seed << ", room " << room;
  for (int k = 0; k < 200; ++k)
    ASSERT_EQ(robot.cycle(), BusStatus::kOk) << robot.trouble() << "; seed " << seed << ", room " << room;
  for (std::size_t m = 0; m < robot.bus->motors(); ++m) EXPECT_EQ(robot.hal->motor(0, m).uncalled(), 0u) << seed;
}

void expect_the_second_drive_named(std::uint64_t seed) {
  Disturbances disturbances(seed);
  const auto room = static_cast<std::size_t>(disturbances.spread(10, 1000));
  QueuedRobot robot(static_cast<std::size_t>(disturbances.uniform(1, 7.99)), room);
  const auto second =
      static_cast<std::size_t>(disturbances.uniform(0, static_cast<double>(robot.bus->motors()) - 0.01));
  const int from = static_cast<int>(disturbances.uniform(0, kDisturbedCycles));
  const auto expect_no_other = [&] {
    const int named = falsely_named(robot);
    ASSERT_TRUE(named == -1 || named == static_cast<int>(second)) << named << "; seed " << seed;
  };
  for (int k = 0; k < kDisturbedCycles; ++k) {
    if (k == from) robot.bus->drive(second).twice = true;
    disturbances.cycle(robot);
    ASSERT_NO_FATAL_FAILURE(expect_no_other());
  }
  disturbances.end(robot);
  int cycles = 0;
  for (; cycles < kNamedWithin && robot.trouble(second) != Trouble::kTwoOfOneNode; ++cycles) robot.cycle();
  ASSERT_LT(cycles, kNamedWithin) << "seed " << seed << ", room " << room;
  robot.bus->drive(second).twice = false;
  for (int k = 0; k < kSettlesWithin && !robot.stands; ++k) robot.cycle();
  EXPECT_EQ(robot.cycle(), BusStatus::kOk) << "the second drive is gone: " << robot.trouble() << "; seed " << seed;
}

TEST(Queues, NoStallCableOrQueueIsTakenForASecondDrive) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) expect_no_false_fault(seed);
}

TEST(Queues, ASecondDriveIsNamedAmongStallsAndGoneWhenItIsOff) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) expect_the_second_drive_named(seed);
}

TEST(QueuesCampaign, NoneOfAThousandTrialsHasAFalseFaultAndEverySecondDriveIsNamed) {
  for (std::uint64_t seed = 101; seed <= 1100; ++seed) {
    expect_no_false_fault(seed);
    expect_the_second_drive_named(seed);
  }
}

TEST(Queues, AnswersThatAreFourCyclesLateForEverAreOldAndNamed) {
  for (const int late : {2, 3, 4, 5}) {
    QueuedRobot robot(6, 64);
    for (int k = 0; k < 100; ++k) robot.cycle();
    ASSERT_TRUE(robot.stands);
    robot.bus->answers_late_ns = late * QueuedRobot::kPeriod_ns;
    int until_lost = 1;
    while (robot.cycle() != BusStatus::kLost && until_lost < 100) ++until_lost;
    // The first cycle's state is that of the cycle before, and eight are late. A gap of five cycles is silence first.
    EXPECT_EQ(until_lost, late == 5 ? 6 : 10) << late;
    for (int k = 0; k < 500; ++k) ASSERT_NE(robot.cycle(), BusStatus::kOk) << late << ", " << k;
    EXPECT_EQ(robot.trouble(3), Trouble::kOldState);
    EXPECT_EQ(
        robot.trouble(),
        "left_shoulder_pitch (can2, node 1) answers, but each time with an old state: something holds its bus up");
    EXPECT_GE(robot.hal->motor(0, 3).age_cycles(), late);
    robot.bus->answers_late_ns = 0;
    for (int k = 0; k < 100; ++k) robot.cycle();
    EXPECT_TRUE(robot.stands) << late;
  }
}

TEST(Queues, AnswersThatAreOneCycleLateForEverAreFresh) {
  QueuedRobot robot(3, 64);
  robot.bus->answers_late_ns = QueuedRobot::kPeriod_ns / 2;
  for (int k = 0; k < 100; ++k) robot.cycle();
  for (int k = 0; k < 500; ++k) ASSERT_EQ(robot.cycle(), BusStatus::kOk) << robot.trouble();
  EXPECT_EQ(robot.hal->motor(0, 2).age_cycles(), 1);
  EXPECT_EQ(robot.state.age_ns, QueuedRobot::kPeriod_ns);
}

TEST(Queues, AfterACableWasOutTheStateIsFreshAgainThoughCommandsWentOn) {
  QueuedRobot robot(7, 1000);
  for (int k = 0; k < 100; ++k) robot.cycle();
  robot.bus->cut = true;
  for (int k = 0; k < 140; ++k) robot.cycle();
  EXPECT_GT(robot.bus->waiting(), 900u);
  robot.bus->cut = false;
  int cycles = 0;
  while (!robot.stands && cycles < kSettlesWithin) robot.cycle(), ++cycles;
  EXPECT_LT(cycles, kSettlesWithin);
  EXPECT_LE(robot.bus->waiting(), 7u);
}

/// Asked over a queue while answers are held back and the cable is out now and then, one drive of each node is counted
/// once, and a second one is found.
TEST(Queues, ARollCallCountsNoLateAnswerTwice) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Disturbances disturbances(seed);
    can::BusSetup setup = can::load_drives(z1()).buses[0];
    test::QueuedBus bus(setup, static_cast<std::size_t>(disturbances.spread(10, 1000)));
    bus.drive(2).twice = seed % 2 == 0;
    std::int64_t now_ns = 0, back_ns = 0;
    const Wait wait = [&] {
      now_ns += kMs_ns;
      if (disturbances.once_in(50))
        bus.held_until_ns = now_ns + static_cast<std::int64_t>(kMs_ns * disturbances.uniform(4, 20));
      if (disturbances.once_in(200)) back_ns = now_ns + static_cast<std::int64_t>(kMs_ns * disturbances.spread(5, 100));
      bus.cut = now_ns < back_ns;
      bus.run_to(now_ns);
    };
    for (const Answer& answer : ask_bus(setup, bus, wait, {}))
      EXPECT_EQ(answer.count, seed % 2 == 0 && answer.node == setup.motors[2].node ? 2 : 1)
          << seed << ", " << answer.node;
  }
}

/// A bus whose answers are there only for whoever waits for its descriptor, which is ready all the time.
class AwaitedLink final : public Link {
 public:
  explicit AwaitedLink(const can::BusSetup& bus) : bus_(bus, 64), ready_(eventfd(1, EFD_CLOEXEC)) {}
  ~AwaitedLink() override { close(ready_); }
  AwaitedLink(const AwaitedLink&) = delete;
  AwaitedLink& operator=(const AwaitedLink&) = delete;
  std::size_t send(std::span<const drives::Message> frames) noexcept override {
    looked_ = 0;
    return bus_.send(frames);
  }
  std::size_t receive(std::span<drives::Message> frames) noexcept override {
    if (++looked_ < 2) return 0;
    bus_.run_to(now_ns_ += QueuedRobot::kPeriod_ns);
    return bus_.receive(frames);
  }
  BusHealth health() const noexcept override { return BusHealth::kGood; }
  const LinkCounts& counts() const noexcept override { return bus_.counts(); }
  int descriptor() const noexcept override { return ready_; }

 private:
  test::QueuedBus bus_;
  int ready_, looked_ = 0;
  std::int64_t now_ns_ = 0;
};

TEST(Queues, EveryBusOfManyIsWaitedFor) {
  constexpr std::size_t kBuses = 20;
  const can::DriveSetup z1_drives = can::load_drives(z1());
  can::DriveSetup setup;
  std::vector<drives::MotorSetup> motors;
  for (const can::BusSetup& bus : z1_drives.buses) motors.insert(motors.end(), bus.motors.begin(), bus.motors.end());
  std::vector<std::unique_ptr<Link>> links;
  for (std::size_t b = 0; b < kBuses; ++b) {
    can::BusSetup bus;
    bus.name = "can" + std::to_string(b);
    bus.bitrate = 1'000'000;
    bus.motors.push_back(motors[b]);
    setup.buses.push_back(std::move(bus));
  }
  // Only the last one has anything to wait for: the others answer nothing at all.
  for (std::size_t b = 0; b + 1 < kBuses; ++b) links.push_back(std::make_unique<test::QueuedBus>(setup.buses[b], 64));
  links.push_back(std::make_unique<AwaitedLink>(setup.buses.back()));
  const io::SimulationClock clock;
  CanHal hal(setup, z1(), clock, std::move(links));
  model::RobotState state;
  model::JointCommand limp = standing_command(z1());
  limp.kp.setZero();
  hal.exchange(limp, state);
  EXPECT_TRUE(hal.motor(kBuses - 1, 0).answered());
}

}  // namespace
}  // namespace pmg::can
