// Faults of drives, wires and threads, and after how many bus cycles the drives are damped: the table of
// docs/reference/safety.md.
#include "can/can_hal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <functional>
#include <numbers>
#include <optional>
#include <random>

#include "can/can_backend.hpp"
#include "can/flood.hpp"
#include "can/roll_call.hpp"
#include "can/still_robot.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "generator_core/allocation_count.hpp"
#include "hal/bus_cycle.hpp"

namespace pmg::can {
namespace {

using hal::BusStatus;
using test::MemoryLink;

/// Z1's drives stand in the standing posture unless a test moves them.
class Drives : public testing::Test, protected test::StillRobot {
 protected:
  Drives() : StillRobot(load_drives(z1())) { connect(); }
  void stand() {
    cycle(limp());
    for (int k = 0; k < 5; ++k) ASSERT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
  }
  test::DriveEmulator& knee() { return drives_->drive(0, 3); }
};

TEST_F(Drives, CommandsArriveAndStatesComeBackWithinAStepOfTheirFields) {
  stand();
  for (int j = 0; j < truth_.q.size(); ++j) {
    EXPECT_NEAR(state_.q[j], truth_.q[j], 12.6 / 65535 / 2 + 1e-12) << "half a step of 16 bits";
    EXPECT_NEAR(state_.dq[j], 0.0, 60.0 / 4095 / 2 + 1e-12);
    EXPECT_EQ(state_.temperature_degC[j], 35.0);
    EXPECT_NEAR(acting_.q[j], standing_.q[j], 12.6 / 65535);
    EXPECT_NEAR(acting_.kp[j], standing_.kp[j], 1000.0 / 4095);
  }
}

TEST_F(Drives, NoMotorIsEnabledByACommandWithStiffness) {
  for (int k = 0; k < 20; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kLost) << "not enabled";
  EXPECT_EQ(trouble(), "left_hip_pitch (can0, node 1) is not enabled");
  EXPECT_FALSE(knee().enabled());
  cycle(limp());
  EXPECT_TRUE(knee().enabled());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk);
}

TEST_F(Drives, NorByOneWithFeedForwardAlone) {
  model::JointCommand pushes = limp();
  pushes.tau_ff[0] = 1.0;
  for (int k = 0; k < 20; ++k) EXPECT_EQ(cycle(pushes), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_hip_pitch (can0, node 1) is not enabled");
  EXPECT_FALSE(drives_->drive(0, 0).enabled());
}

TEST_F(Drives, ASilentMotorIsLateInTheSecondCycleAndLostInTheSixth) {
  stand();
  knee().silent = true;
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << "the answer may be under way";
  for (int k = 2; k <= 5; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kStale) << k;
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) answers late");
  EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) does not answer");
}

TEST_F(Drives, AStateKeepsItsValuesWhileSomebodyIsLateOrLost) {
  stand();
  const model::RobotState before = state_;
  knee().silent = true;
  cycle(standing_);
  truth_.q[0] += 0.01;  // of a drive that answers
  while (cycle(standing_) != BusStatus::kLost) EXPECT_EQ(state_.q[0], before.q[0]);
  EXPECT_EQ(state_.q[0], before.q[0]);
  EXPECT_EQ(state_.bus_sample, before.bus_sample + 1) << "the answer of the first cycle may have been under way";
}

TEST_F(Drives, ALossAndItsEndAreToldOnce) {
  BusTrouble change;
  stand();
  while (hal_->take_change(change)) {
  }
  knee().silent = true;
  for (int k = 0; k < 20; ++k) cycle(standing_);
  ASSERT_TRUE(hal_->take_change(change));
  EXPECT_EQ(describe(change, setup_), "left_knee (can0, node 4) does not answer");
  EXPECT_FALSE(hal_->take_change(change));
  knee().silent = false;
  for (int k = 0; k < 3; ++k) cycle(limp());
  ASSERT_TRUE(hal_->take_change(change));
  EXPECT_EQ(describe(change, setup_), "the drives answer");
}

TEST_F(Drives, AWrongIdIsASilentMotorAndAStranger) {
  stand();
  knee().node = 99;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 5);
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) does not answer");
  EXPECT_EQ(hal_->strangers(), 6u);
}

TEST_F(Drives, AReplyWithAnotherIdentifierThanItsDrivesIsNone) {
  stand();
  knee().silent = true;
  hal_->send(standing_);
  const drives::MitProtocol protocol(drives::as_mit(knee().setup().drive)->ranges());
  host_[0]->push(drives::Message::of(0x7E, protocol.reply({.node = 4, .reading = {.q_rad = 0.3}})));
  hal_->receive(state_);
  EXPECT_EQ(hal_->motor(0, 3).age_cycles(), 1);
  EXPECT_EQ(hal_->unreadable(), 1u);
}

TEST_F(Drives, TwoMotorsOfOneNodeAreLostInTheThirdCycle) {
  stand();
  knee().twice = true;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 2);
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) two drives have this node number");
}

TEST_F(Drives, ADuplicatedFrameNowAndThenIsDropped) {
  stand();
  for (int k = 0; k < 300; ++k) {
    knee().twice = k % 60 == 0;
    ASSERT_EQ(cycle(standing_), BusStatus::kOk) << k;
  }
  EXPECT_EQ(hal_->motor(0, 3).uncalled(), 5u);
}

TEST_F(Drives, AnswersOneCycleLateAndOutOfOrderAreTaken) {
  stand();
  // The answers of this cycle are held back and arrive in reverse order, after those of the next.
  hal_->send(standing_);
  drives_->serve();
  std::array<drives::Message, 64> late;
  const std::size_t count = host_[0]->receive(late);
  EXPECT_EQ(hal_->receive(state_), BusStatus::kOk) << "one cycle old";
  hal_->send(standing_);
  drives_->serve();
  for (std::size_t i = count; i-- > 0;) host_[0]->push(late[i]);
  EXPECT_EQ(hal_->receive(state_), BusStatus::kOk);
  EXPECT_EQ(hal_->motor(0, 3).uncalled(), 0u);
  EXPECT_EQ(cycle(standing_), BusStatus::kOk);
}

TEST_F(Drives, AnAnswerThatComesAfterItsCycleIsNoneOfTheNext) {
  stand();
  hal_->send(standing_);
  hal_->receive(state_);
  drives_->serve();  // too late
  knee().silent = true;
  hal_->send(standing_);
  drives_->serve();
  hal_->receive(state_);
  EXPECT_EQ(hal_->motor(0, 3).age_cycles(), 1) << "it answered the cycle before";
  EXPECT_EQ(hal_->motor(0, 2).age_cycles(), 0);
}

TEST_F(Drives, ABusThatIsOffIsLostAtOnceAndComesBackUnderDamping) {
  stand();
  host_[0]->state = BusHealth::kOff;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 0);
  EXPECT_EQ(trouble(), "can0 is off");
  host_[0]->cut = true;
  for (int k = 0; k < 20; ++k) cycle(standing_);
  EXPECT_TRUE(knee().tripped()) << "its own watchdog acted";
  host_[0]->state = BusHealth::kGood;
  host_[0]->cut = false;
  for (int k = 0; k < 5; ++k) EXPECT_EQ(cycle(standing_), BusStatus::kLost) << "not enabled under stiffness";
  EXPECT_EQ(trouble(), "left_hip_pitch (can0, node 1) is not enabled");
  cycle(limp());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk);
}

TEST_F(Drives, APulledCableIsLostInTheSixthCycleAndComesBackUnderDamping) {
  stand();
  host_[1]->cut = true;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 5);
  host_[1]->cut = false;
  EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  cycle(limp());
  cycle(limp());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << trouble();
}

TEST_F(Drives, AnEncoderThatWrapsOrLosesATurnIsNotBelieved) {
  stand();
  knee().turn_rad = 2.0 * std::numbers::pi / 9.0;  // one turn of a motor behind a gear of 9
  const double before = state_.q[3];
  EXPECT_EQ(cycles_until(BusStatus::kLost), 2) << "the third reading in a row";
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) its position jumped: a turn was lost");
  EXPECT_EQ(state_.q[3], before) << "no state has it";
  knee().turn_rad = 0.0;
  EXPECT_EQ(cycle(limp()), BusStatus::kLost) << "until the program is started anew";
}

TEST_F(Drives, AFrozenEncoderIsFoundWhenTheMotorHasTurnedATenthOfARadian) {
  stand();
  const int left_knee = z1().joint_index.at("left_knee");
  knee().stuck_q = truth_.q[left_knee];
  truth_.dq[left_knee] = 5.0;
  EXPECT_EQ(cycles_until(BusStatus::kLost), 9) << "0.1 rad at 5 rad/s are 10 cycles of 2 ms";
  EXPECT_EQ(trouble(), "left_knee (can0, node 4) its encoder stands still while the motor turns");
}

TEST_F(Drives, EveryFaultThatADriveReportsIsLostAtOnce) {
  for (const drives::DriveFault fault :
       {drives::DriveFault::kOverTemperature, drives::DriveFault::kOverVoltage, drives::DriveFault::kUnderVoltage,
        drives::DriveFault::kEncoder, drives::DriveFault::kOther}) {
    stand();
    knee().fault = fault;
    EXPECT_EQ(cycles_until(BusStatus::kLost), 0);
    EXPECT_EQ(trouble(), std::string("left_knee (can0, node 4) reports ") + drives::to_string(fault));
    EXPECT_EQ(knee().command().kp_Nm_per_rad, 0.0);
    knee().fault = drives::DriveFault::kNone;
    cycle(standing_);
    EXPECT_EQ(cycle(standing_), BusStatus::kLost) << "not enabled again by itself";
  }
}

TEST_F(Drives, APauseLongerThanTheDrivesWatchdogsEndsUnderDamping) {
  clock_.advance_to(1'000'000);
  stand();
  clock_.advance_to(clock_.now_ns() + drives::RobotDrives::kPause_ns);
  EXPECT_EQ(cycle(standing_), BusStatus::kOk) << "not longer";
  clock_.advance_to(clock_.now_ns() + drives::RobotDrives::kPause_ns + 1);
  EXPECT_EQ(cycle(standing_), BusStatus::kLost);
  EXPECT_EQ(trouble(), "left_hip_pitch (can0, node 1) is not enabled");
  cycle(limp());
  EXPECT_EQ(cycle(standing_), BusStatus::kOk);
}

TEST_F(Drives, AHotMotorIsReadByTheControlThread) {
  stand();
  knee().temperature_degC = 95.0;
  ASSERT_EQ(cycle(standing_), BusStatus::kOk);
  EXPECT_EQ(state_.temperature_degC[z1().joint_index.at("left_knee")], 95.0);
}

TEST_F(Drives, ASilentImuIsLateAfter10msAndLostAfter20ms) {
  stand();
  drives_->imu_silent = true;
  EXPECT_EQ(cycles_until(BusStatus::kStale), 5);
  EXPECT_EQ(trouble(), "the IMU on can4 does not speak");
  EXPECT_EQ(cycles_until(BusStatus::kLost), 4);
}

TEST_F(Drives, AKilledHostLeavesTheDrivesToTheirWatchdogs) {
  stand();
  for (int k = 1; k < test::DriveEmulator::kWatchdogCycles; ++k) drives_->tick(acting_);  // stand() ended with one
  EXPECT_GT(acting_.kp.minCoeff(), 0.0);
  drives_->tick(acting_);
  EXPECT_EQ(acting_.kp.maxCoeff(), 0.0);
  EXPECT_GT(acting_.kd.minCoeff(), 0.0) << "braked";
}

/// The bus cycle with the guard that the backend asks for.
TEST_F(Drives, AFrozenControlThreadDampsTheDrivesInTheTenthCycle) {
  class Bus final : public hal::Hal {
   public:
    BusStatus exchange(const model::JointCommand& command, model::RobotState&) noexcept override {
      return cycle(command);
    }
    std::function<BusStatus(const model::JointCommand&)> cycle;
  };
  hal::BackendFactory factory;
  register_backend(factory);
  io::SimulationClock clock;
  const auto backend = factory.kind("can").make({.robot = z1(),
                                                 .clock = clock,
                                                 .name = "z1",
                                                 .lcm_url = "memq://",
                                                 .benched_joint = "",
                                                 .keeps_truth = false,
                                                 .options = {}});
  Bus bus;
  bus.cycle = [this](const model::JointCommand& command) { return cycle(command); };
  hal::BusLink link;
  hal::BusCycle thread(bus, link, z1(), clock, backend->limits().guard);
  thread.run();  // no command yet: limp, enables
  hal::ControlOutput output;
  output.joints = standing_;
  link.commands.put(output);
  thread.run();
  ASSERT_GT(acting_.kp.minCoeff(), 0.0);
  int cycles = 0;
  while (acting_.kp.maxCoeff() > 0.0 && cycles < 100) {
    thread.run();
    ++cycles;
  }
  EXPECT_EQ(cycles, 10);
  EXPECT_GT(acting_.kd.minCoeff(), 0.0);
}

TEST_F(Drives, NothingThatABusSaysMovesAMotorBeyondItsLimits) {
  stand();
  std::mt19937_64 random(3);
  for (int k = 0; k < 2000; ++k) {
    for (MemoryLink* link : host_) {
      for (int i = 0; i < 5; ++i) {
        const auto id = static_cast<std::uint32_t>(random() % 4 == 0 ? random() % 2048 : 0);
        link->push(test::any_frame(random, id, static_cast<std::uint8_t>(random() % 8)));
      }
    }
    cycle(standing_);
    ASSERT_TRUE(state_.q.allFinite());
    ASSERT_NO_FATAL_FAILURE(test::expect_within_limits(acting_, z1()));
  }
}

TEST_F(Drives, ACycleAllocatesNothing) {
  stand();
  const long before = test::allocation_count();
  for (int k = 0; k < 100; ++k) cycle(standing_);
  knee().silent = true;
  for (int k = 0; k < 100; ++k) cycle(standing_);
  if (before < 0) GTEST_SKIP() << "sanitizers bring their own malloc";
  EXPECT_EQ(test::allocation_count(), before);
}

/// Z1's left ankle with two motors in the shank, as robot.yaml's `linkages` describes it.
TEST_F(Drives, AParallelAnkleIsReadAndDrivenThroughItsLinkage) {
  can::DriveSetup setup = setup_;
  std::array<std::optional<drives::MotorCommand>, 2> last;  // of each crank
  const auto rod = [](double y, double z) {
    return drives::CrankAndRod{.crank_centre_m = {0.0, y, z},
                               .axis = {0.0, 1.0, 0.0},
                               .crank_end_m = {-0.04, y, z},
                               .rod_end_m = {-0.045, y, -0.01}};
  };
  const drives::RodLinkage<2> ankle({Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()},
                                    {rod(0.035, 0.20), rod(-0.035, 0.28)});
  setup.buses[0].parallel.push_back({.motors = {4, 5}, .linkage = ankle});
  for (const std::size_t m : {4, 5})
    setup.buses[0].motors[m].limits = {.q_lower_rad = -2.0, .q_upper_rad = 2.0, .dq_rad_s = 20.0, .torque_Nm = 150.0};
  auto [host, far] = MemoryLink::pair();
  setup.buses.resize(1);
  std::vector<std::unique_ptr<Link>> links;
  links.push_back(std::move(host));
  CanHal hal(setup, z1(), clock_, std::move(links));
  const drives::MitProtocol protocol(drives::as_mit(setup.buses[0].motors[4].drive)->ranges());

  const Eigen::Vector2d q(-0.2, 0.1), dq(0.8, -0.5), torque(12.0, -3.0);
  Eigen::Vector2d theta = *ankle.motor_angles(q);
  const Eigen::Matrix2d J = ankle.jacobian(theta, q);
  Eigen::Vector2d dtheta = J * dq;
  const Eigen::Vector2d crank_torque = J.transpose().inverse() * torque;
  const auto answer = [&] {
    std::array<drives::Message, 32> got;
    const std::size_t count = far->receive(got);
    for (const drives::Message& frame : std::span(got).first(count)) {
      drives::MitReply reply{.node = static_cast<std::uint8_t>(frame.id), .reading = {}};
      const int crank = static_cast<int>(frame.id) - 5;  // nodes 5 and 6
      if (crank >= 0)
        reply.reading = {.q_rad = theta[crank], .dq_rad_s = dtheta[crank], .torque_Nm = crank_torque[crank]};
      const drives::Message sent = drives::Message::of(0, protocol.reply(reply));
      far->send(std::span(&sent, 1));
      if (crank >= 0)
        last[static_cast<std::size_t>(crank)] = protocol.command([&frame] {
          drives::MitFrame bytes{};
          std::copy_n(frame.data.begin(), 8, bytes.begin());
          return bytes;
        }());
    }
  };
  for (int k = 0; k < 3; ++k) {
    hal.send(k == 0 ? limp() : standing_);
    answer();
    const BusStatus status = hal.receive(state_);
    ASSERT_TRUE(k == 0 || status == BusStatus::kOk) << describe(hal.trouble(), setup);
  }
  const int pitch = z1().joint_index.at("left_ankle_pitch"), roll = z1().joint_index.at("left_ankle_roll");
  // Half a step at a crank: 0.1 mrad, 7 mrad/s, 0.04 Nm. Pitch has ratio 1 to the cranks; roll some 2.
  EXPECT_NEAR(state_.q[pitch], q[0], 5e-4);
  EXPECT_NEAR(state_.q[roll], q[1], 1e-3);
  EXPECT_NEAR(state_.dq[pitch], dq[0], 0.05);
  EXPECT_NEAR(state_.tau[pitch], torque[0], 0.1);
  Eigen::Vector2d given, wanted;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(last[static_cast<std::size_t>(i)]);
    const drives::MotorCommand& crank = *last[static_cast<std::size_t>(i)];
    given[i] = crank.kp_Nm_per_rad * (crank.q_rad - theta[i]) + crank.kd_Nm_s_per_rad * (crank.dq_rad_s - dtheta[i]) +
               crank.torque_Nm;
    const int joint = i == 0 ? pitch : roll;
    wanted[i] = standing_.kp[joint] * (standing_.q[joint] - q[i]) + standing_.kd[joint] * (standing_.dq[joint] - dq[i]);
  }
  // Rounding: 700 Nm/rad times half a step of 0.2 mrad, 12 Nm s/rad times half of 15 mrad/s, half of 0.08 Nm, twice.
  EXPECT_LT((J.transpose() * given - wanted).norm(), 0.8)
      << (J.transpose() * given).transpose() << " for " << wanted.transpose();
  // Cranks' gains change with the angles; answers that were lost are given up all the same.
  for (int k = 0; k < 20; ++k) {
    theta += Eigen::Vector2d(0.001, 0.001);
    hal.send(standing_);
    if (k == 3 || k == 4) {
      std::array<drives::Message, 32> lost;
      far->receive(lost);
    } else {
      answer();
    }
    const BusStatus after = hal.receive(state_);
    ASSERT_TRUE(k < 12 || after == BusStatus::kOk) << k << describe(hal.trouble(), setup);
  }
  // Cranks that no posture of the joints belongs to.
  BusStatus status = BusStatus::kOk;
  for (int k = 0; k < 40 && status == BusStatus::kOk; ++k) {
    theta += Eigen::Vector2d(0.1, -0.1);
    dtheta = Eigen::Vector2d(20.0, -20.0);
    hal.send(limp());
    answer();
    status = hal.receive(state_);
  }
  EXPECT_EQ(status, BusStatus::kLost);
  EXPECT_EQ(hal.motor(0, 4).trouble(false), drives::Trouble::kNone) << "each motor by itself is believed";
  EXPECT_EQ(describe(hal.trouble(), setup), "left_ankle_pitch (can0, node 5) its position jumped: a turn was lost");
}

TEST_F(Drives, TheRollCallNamesEveryProblem) {
  can::BusSetup bus = setup_.buses[0];
  const double stand = bus.motors[0].limits.q_lower_rad;
  std::vector<Answer> answers;
  for (const drives::MotorSetup& motor : bus.motors) {
    Answer answer;
    answer.node = motor.node;
    answer.count = 1;
    answer.reading.q_rad = 0.5 * (motor.limits.q_lower_rad + motor.limits.q_upper_rad);
    answers.push_back(answer);
  }
  EXPECT_TRUE(problems(bus, answers).empty());
  answers[0].reading.q_rad = stand - 0.3;
  answers[1].count = 2;
  answers[2].reading.fault = drives::DriveFault::kUnderVoltage;
  answers[3].node = 77;
  EXPECT_THAT(
      problems(bus, answers),
      testing::ElementsAre(testing::HasSubstr("left_hip_pitch (can0, node 1) is at -2.50 rad; expected -2.20 to 0.90"),
                           "left_hip_roll (can0, node 2) answers 2 times; expected one drive of each node number",
                           "left_hip_yaw (can0, node 3) reports under-voltage; expected no fault",
                           "left_knee (can0, node 4) does not answer; expected a powered drive with this node number",
                           "can0: somebody answers as node 77; expected only the nodes of robot.yaml"));
}

}  // namespace
}  // namespace pmg::can
