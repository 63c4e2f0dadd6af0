// A whole controller led by a headset over a network with a virtual clock: what it does when the headset is lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "arms_operator/arms_board.hpp"
#include "arms_operator/arms_text.hpp"
#include "operator/networked_robot.hpp"
#include "operator/robot_driver.hpp"
#include "vr/headset.hpp"
#include "vr/vr_command.hpp"

namespace pmg::vr {
namespace {

using control::Mode;
using State = pmg_msgs::arms_state_t;

class VrRobot : public testing::Test {
 protected:
  VrRobot() {
    driver_.set_limits(robot_.robot.command_limits);
    vr_.begin(network_.clock.now_ns());
    run(0.5);
  }
  void step() {
    network_.advance();
    if (talks_) vr_.take(headset_.next(network_.clock.now_ns()), network_.clock.now_ns());
    vr_.learn(board_.of("z1"));
    driver_.step();
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  Mode mode() const { return robot_.result().mode; }
  Eigen::Vector3d palm(Foot side) const { return Eigen::Vector3d(ops::arm_news(board_.of("z1")->state, side).p_m); }
  std::int8_t activity(Foot side) const { return ops::arm_news(board_.of("z1")->state, side).activity; }
  /// Stands, and walks on the spot with a squeezed grip and a pulled trigger.
  void lead_right() {
    stand_.emplace(source_, "z1", ops::Goal::kStand, 10.0);
    for (int k = 0; k < 600 && mode() != Mode::kStand; ++k) {
      step();
      stand_->step();
    }
    ASSERT_EQ(mode(), Mode::kStand);
    headset_.squeeze();
    run(0.1);
    for (int k = 0; k < 25; ++k) {
      headset_.step(0.005, 0.0);  // beyond the dead zone: a squeezed grip alone asks for nothing
      step();
    }
    run(1.0);
    ASSERT_EQ(mode(), Mode::kWalk) << driver_.text();
    headset_.pull(kRight);
    run(0.3);
    for (int k = 0; k < 20; ++k) {
      headset_.move(kRight, {0.005, 0.0, 0.005});
      step();
    }
  }
  /// The largest step of the palm between two ARMS_STATE within a time.
  double largest_step(double seconds) {
    double largest_m = 0.0;
    Eigen::Vector3d before = palm(kRight);
    for (; seconds > 0.0; seconds -= 0.01) {
      step();
      largest_m = std::max(largest_m, (palm(kRight) - before).norm());
      before = palm(kRight);
    }
    return largest_m;
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("z1", {}, test::z1());
  ops::OperatorSource source_{network_.link, "vr.1", 1, network_.clock};
  ops::ArmsBoard board_{network_.link, network_.clock};
  VrCommand vr_{-1};
  ops::RobotDriver driver_{source_, "z1", vr_};
  std::optional<ops::ModeWish> stand_;
  test::Headset headset_;
  bool talks_ = true;
};

TEST_F(VrRobot, ALedPalmFollowsWithoutAJumpAndStaysWhenTheLinkIsLostAndWhenItIsBack) {
  lead_right();
  EXPECT_EQ(activity(kRight), State::FOLLOWING);
  EXPECT_EQ(activity(kLeft), State::REFERENCE) << "nobody leads it";
  run(1.0);
  const Eigen::Vector3d led = palm(kRight);
  talks_ = false;
  EXPECT_LT(largest_step(3.0), 0.02);
  EXPECT_EQ(mode(), Mode::kStand) << driver_.text();
  EXPECT_EQ(activity(kRight), State::HELD);
  EXPECT_LT((palm(kRight) - led).norm(), 0.02) << "it doesn't go back";
  talks_ = true;
  EXPECT_LT(largest_step(1.0), 0.02);
  EXPECT_EQ(mode(), Mode::kStand) << "the old squeeze doesn't count";
}

TEST_F(VrRobot, ALostHandHoldsItsPalmWhileTheRobotGoesOn) {
  lead_right();
  run(1.0);
  const Eigen::Vector3d led = palm(kRight);
  headset_.news.hands[kRight].pose.reset();
  EXPECT_LT(largest_step(1.0), 0.02);
  EXPECT_EQ(mode(), Mode::kWalk);
  EXPECT_EQ(activity(kRight), State::HELD);
  EXPECT_LT((palm(kRight) - led).norm(), 0.02);
}

}  // namespace
}  // namespace pmg::vr
