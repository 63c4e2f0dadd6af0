// The mapping of a headset under the deadman's rule that RobotDriver applies.
#pragma once

#include <gtest/gtest.h>

#include "operator/hold_to_drive.hpp"
#include "vr/headset.hpp"
#include "vr/vr_command.hpp"

namespace pmg::vr {

class VrCommandTest : public testing::Test {
 protected:
  VrCommandTest() {
    CommandLimits limits;
    limits.lower = {-0.5, -0.3, -0.6, -0.1, -0.2, -0.2};
    limits.upper = {0.8, 0.3, 0.6, 0.4, 0.2, 0.02};
    vr_.set_limits(limits);
    vr_.set_robot_span(1.2);
    vr_.begin(now_ns_);
    run(0.1);
  }
  /// 10 ms: a message, if the headset talks, and a look at it as RobotDriver has.
  void step() {
    now_ns_ += 10'000'000;
    if (talks_) vr_.take(headset_.next(now_ns_), now_ns_);
    if (arms_heard_) {
      arms_.heard_ns = now_ns_;
      vr_.learn(&arms_);
    }
    look();
  }
  void look() {
    const bool before = hold_.armed().has_value();
    hold_.step(vr_.holds(now_ns_), now_ns_);
    if (before && !hold_.armed()) vr_.rest();
    command_ = vr_.command(hold_.armed(), now_ns_);
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  void walk() {
    headset_.squeeze();
    run(0.1);
    ASSERT_TRUE(hold_.armed()) << vr_.note();
    glide(kReach_m, 0.0);
    ASSERT_DOUBLE_EQ(command_[kVx], 0.8);
  }
  /// As a person moves: over half a second.
  void glide(double forward_m, double left_m, double up_m = 0.0) {
    for (int k = 0; k < 50; ++k) {
      headset_.step(forward_m / 50, left_m / 50, up_m / 50);
      step();
    }
  }
  void tilt(double yaw, double pitch, double roll) {
    for (int k = 1; k <= 50; ++k) {
      headset_.news.head->R = test::turned(0.5 + yaw * k / 50, pitch * k / 50, roll * k / 50);
      step();
    }
  }
  void expect_held() {
    EXPECT_FALSE(hold_.armed());
    for (const Channel channel : {kVx, kVy, kOmega}) EXPECT_EQ(command_[channel], 0.0);
  }
  /// What was squeezed before has no effect any more; at the centre a fresh squeeze has.
  void expect_fresh_squeeze_needed() {
    run(0.5);
    expect_held();
    headset_.let_go();
    step();
    headset_.squeeze();
    run(0.1);
    EXPECT_TRUE(hold_.armed()) << vr_.note();
  }

  VrCommand vr_{-1};
  ops::HoldToDrive hold_;
  test::Headset headset_;
  ops::HeardArms arms_ = [] {
    ops::HeardArms heard;
    heard.state.left_orientation[0] = heard.state.right_orientation[0] = 1.0;
    heard.state.left_p_m[1] = 0.2;
    heard.state.right_p_m[1] = -0.2;
    return heard;
  }();
  Command command_;
  std::int64_t now_ns_ = 5'000'000'000;
  bool talks_ = true, arms_heard_ = true;
};

}  // namespace pmg::vr
