// A simulated robot with an automatic hoist, from limp to walking and back up after a fall: the controller's own parts
// in one thread, on a clock that only the simulation moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "control/control_cycle.hpp"
#include "control/control_setup.hpp"
#include "control/fixtures.hpp"
#include "hal/bus_cycle.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::sil {
namespace {

class HoistedRobot : public testing::TestWithParam<std::uint64_t> {
 protected:
  HoistedRobot() {
    control::ControlSetup setup;
    loaded_ = control::load_control(setup);
    tick_ = control::make_tick(loaded_, clock_);
    cycle_ = std::make_unique<control::ControlCycle>(*tick_, link_, inbox_, clock_);
    bus_ = std::make_unique<hal::BusCycle>(robot_, link_, loaded_.robot, clock_);
    bus_->run();
  }
  const control::TickResult& result() const { return cycle_->record().result; }

  /// 10 ms, with a velocity command.
  void step(double vx_m_s = 0.0) {
    control::DriveMessage drive{.source = control::Source::make("test", 1),
                                .sequence = ++sequence_,
                                .stamp_ns = clock_.now_ns(),
                                .received_ns = clock_.now_ns(),
                                .lease_s = 0.5,
                                .command = {}};
    drive.command[kVx] = vx_m_s;
    inbox_.put(drive);
    cycle_->run(clock_.now_ns());
    robot_.hoist_line()->see(control::upright(result().mode), result().entering);
    for (int k = 0; k < 5; ++k) {
      clock_.advance_to(clock_.now_ns() + hal::BusCycle::kPeriod_ns);
      bus_->run();
    }
    const Eigen::Map<const Eigen::VectorXd> qvel(world_.mj_data()->qvel, world_.mj_model()->nv);
    fastest_joint_rad_s_ = std::max(fastest_joint_rad_s_, qvel.tail(qvel.size() - 6).cwiseAbs().maxCoeff());
  }
  void ask(control::Mode mode, bool reset = false) {
    inbox_.put(control::ModeRequest{.source = control::Source::make("test", 1),
                                    .sequence = ++sequence_,
                                    .stamp_ns = clock_.now_ns(),
                                    .received_ns = clock_.now_ns(),
                                    .mode = mode,
                                    .reset_fault = reset});
  }
  template <typename Condition>
  double until(Condition condition, double at_most_s, double vx_m_s = 0.0) {
    double elapsed_s = 0.0;
    for (; !condition() && elapsed_s < at_most_s; elapsed_s += 0.01) step(vx_m_s);
    return elapsed_s;
  }
  void run(double seconds, double vx_m_s = 0.0) {
    until([] { return false; }, seconds, vx_m_s);
  }
  double lean_rad() const {  // of the torso from upright
    return std::acos(std::clamp((world_.truth().q_WT * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  }
  void stand_on_its_own() {
    ask(control::Mode::kStand);
    until([&] { return robot_.hoist_line()->state() == hal::CraneState::kFree; }, 12.0);
    ASSERT_EQ(robot_.hoist_line()->state(), hal::CraneState::kFree);
    run(1.0);
    ASSERT_EQ(result().mode, control::Mode::kStand) << describe(result().fault, loaded_.robot);
    EXPECT_LT(lean_rad(), 0.15);
  }

  io::SimulationClock clock_;
  control::LoadedControl loaded_;
  sim::World world_{test::z1(), world_with_noise(GetParam(), true)};
  SimulatedRobot robot_{world_, HoistedBy::kCrane, false};
  hal::BusLink link_;
  control::OperatorInbox inbox_{link_.stop};
  std::unique_ptr<control::Tick> tick_;
  std::unique_ptr<control::ControlCycle> cycle_;
  std::unique_ptr<hal::BusCycle> bus_;
  std::int64_t sequence_ = 0;
  double fastest_joint_rad_s_ = 0.0;
};

TEST_P(HoistedRobot, HangsLimpIsSetDownAsItStandsAndWalks) {
  run(2.0);
  EXPECT_GT(world_.torso_height_m(), 0.1) << "feet clear of the ground";
  stand_on_its_own();
  ask(control::Mode::kWalk);
  run(4.0, 0.4);
  EXPECT_EQ(result().mode, control::Mode::kWalk) << describe(result().fault, loaded_.robot);
  EXPECT_GT(world_.truth().p_WB.x(), 1.0) << "no rope holds it back";
  EXPECT_LT(lean_rad(), 0.2);
}

TEST_P(HoistedRobot, AfterAFallItIsCaughtLiftedAndStandsAnew) {
  stand_on_its_own();
  ask(control::Mode::kWalk);
  run(2.0, 0.4);
  ask(control::Mode::kDamping);
  run(3.0);
  ASSERT_LT(world_.torso_height_m(), -0.3) << "it lies";
  fastest_joint_rad_s_ = 0.0;
  robot_.hoist_line()->ask(true);
  until([&] { return robot_.hoist_line()->state() == hal::CraneState::kHolding; }, 15.0);
  run(2.0);
  EXPECT_GT(world_.torso_height_m(), 0.1);
  EXPECT_LT(lean_rad(), 0.1) << "upright";
  EXPECT_LT(fastest_joint_rad_s_, 6.0) << "damped limbs, taken up without a jerk";
  EXPECT_EQ(result().mode, control::Mode::kDamping);
  EXPECT_FALSE(robot_.diverged());
  stand_on_its_own();
}

TEST_P(HoistedRobot, LiftedInMidWalkAndSetDownItIsOnItsFeet) {
  stand_on_its_own();
  ask(control::Mode::kWalk);
  run(2.0, 0.4);
  robot_.hoist_line()->ask(true);
  run(1.0);  // meanwhile the driving source lets go
  ask(control::Mode::kStand);
  until([&] { return robot_.hoist_line()->state() == hal::CraneState::kHolding; }, 10.0);
  ASSERT_EQ(result().mode, control::Mode::kStand) << describe(result().fault, loaded_.robot);
  robot_.hoist_line()->ask(false);
  until([&] { return robot_.hoist_line()->state() == hal::CraneState::kFree; }, 10.0);
  run(2.0);
  EXPECT_EQ(result().mode, control::Mode::kStand) << describe(result().fault, loaded_.robot);
  EXPECT_GT(world_.torso_height_m(), -0.1);
}

INSTANTIATE_TEST_SUITE_P(Seeds, HoistedRobot, testing::Values(1, 2, 3));

}  // namespace
}  // namespace pmg::sil
