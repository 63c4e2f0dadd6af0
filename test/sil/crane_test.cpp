// The hoist sets a robot down when it stands, and takes it up again.
#include "sil/crane.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pmg_msgs/hoist_t.hpp"
#include "runtime/hoist_gate.hpp"

namespace pmg::sil {
namespace {

constexpr double kStep_s = 0.002;
using State = hal::CraneState;

void raise_for(Crane& crane, const CraneView& view, double seconds) {
  for (double t_s = 0.0; t_s < seconds; t_s += kStep_s) crane.step(view, kStep_s);
}

/// Load of the robot's legs, as a share of its weight: the rope sags by 0.02 m under the whole weight.
double carried(const Crane& crane) { return std::clamp(-crane.lift_m() / 0.02, 0.0, 1.0); }

void set_down(Crane& crane) {
  for (double t_s = 0.0; t_s < 6.0; t_s += kStep_s)
    crane.step({.stands = true, .carried_share = carried(crane)}, kStep_s);
}

TEST(Crane, HoldsALimpRobotForEver) {
  Crane crane;
  raise_for(crane, {}, 60.0);
  EXPECT_EQ(crane.state(), State::kHolding);
  EXPECT_EQ(crane.lift_m(), Crane::kLift_m);
  EXPECT_EQ(crane.engaged(), 1.0);
}

TEST(Crane, SetsAStandingRobotDownAndLetsGoOnlyWhenItsFeetHaveCarriedForAWhile) {
  Crane crane;
  raise_for(crane, {.stands = true}, 10.0);
  EXPECT_EQ(crane.state(), State::kLowering) << "nothing carries it yet";
  EXPECT_EQ(crane.engaged(), 1.0);
  raise_for(crane, {.stands = true, .carried_share = 0.49}, 10.0);
  EXPECT_EQ(crane.engaged(), 1.0);
  raise_for(crane, {.stands = true, .carried_share = 0.9}, Crane::kCarriedFor_s - 0.01);
  raise_for(crane, {.stands = true, .carried_share = 0.1}, 0.01);
  raise_for(crane, {.stands = true, .carried_share = 0.9}, Crane::kCarriedFor_s - 0.01);
  EXPECT_EQ(crane.engaged(), 1.0) << "on its feet for a moment only, twice";
  raise_for(crane, {.stands = true, .carried_share = 0.9}, 0.02 + Crane::kLetGo_s + 0.01);
  EXPECT_EQ(crane.state(), State::kFree);
  EXPECT_EQ(crane.engaged(), 0.0);
}

TEST(Crane, TakesUpARobotThatNoLongerStandsWhileItIsSetDown) {
  for (const double after_s : {0.5, 1.9, 2.4, 2.7}) {
    Crane crane;
    for (double t_s = 0.0; t_s < after_s; t_s += kStep_s)
      crane.step({.stands = true, .carried_share = carried(crane)}, kStep_s);
    ASSERT_NE(crane.state(), State::kFree) << after_s;
    raise_for(crane, {.torso_height_m = -0.1}, 5.0);
    EXPECT_EQ(crane.state(), State::kHolding) << after_s;
  }
}

TEST(Crane, LetsARobotThatWasLetGoFall) {
  Crane crane;
  set_down(crane);
  ASSERT_EQ(crane.state(), State::kFree);
  raise_for(crane, {.torso_height_m = -0.7}, 5.0);
  EXPECT_EQ(crane.state(), State::kFree) << "nobody asked";
}

TEST(Crane, CatchesARobotWhereItLiesAndLiftsItWithoutAJerk) {
  for (const double height_m : {-0.75, -0.3, 0.0, 0.4}) {
    Crane crane;
    set_down(crane);
    const CraneView lies{.stays_up = true, .torso_height_m = height_m};
    crane.step(lies, kStep_s);
    EXPECT_EQ(crane.engaged(), 0.0);
    EXPECT_LE(crane.lift_m(), std::max(height_m, Crane::kLift_m)) << "it doesn't pull at first";
    double lift_m = crane.lift_m(), engaged = 0.0;
    for (double t_s = 0.0; t_s < 8.0; t_s += kStep_s) {
      crane.step(lies, kStep_s);
      EXPECT_LE(std::abs(crane.lift_m() - lift_m), Crane::kRaise_m_s * kStep_s * 1.001);
      EXPECT_LE(std::abs(crane.engaged() - engaged), kStep_s / Crane::kCatch_s * 1.001);
      lift_m = crane.lift_m();
      engaged = crane.engaged();
    }
    EXPECT_EQ(crane.state(), State::kHolding);
  }
}

TEST(Crane, ARobotThatIsToStayUpIsNotSetDown) {
  Crane crane;
  raise_for(crane, {.stands = true, .stays_up = true}, 5.0);
  EXPECT_EQ(crane.state(), State::kHolding);
}

TEST(HoistLine, StandingUpAnewEndsAWishToStayUp) {
  hal::HoistLine line;
  const auto see = [&](control::Mode mode, bool entering) { line.see(control::upright(mode), entering); };
  see(control::Mode::kWalk, false);
  line.ask(true);
  see(control::Mode::kWalk, false);
  see(control::Mode::kStand, false);
  EXPECT_TRUE(line.stays_up()) << "from Walk to Stand is no standing up";
  see(control::Mode::kFault, false);
  see(control::Mode::kDamping, false);
  EXPECT_TRUE(line.stays_up());
  EXPECT_FALSE(line.stands());
  see(control::Mode::kStand, true);
  EXPECT_FALSE(line.stays_up());
  EXPECT_FALSE(line.stands()) << "the ramp";
  see(control::Mode::kStand, false);
  EXPECT_TRUE(line.stands());
}

class HoistGateTest : public testing::Test {
 protected:
  using hoist_t = pmg_msgs::hoist_t;
  void send(const hoist_t& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, message.getEncodedSize());
    pmg_msgs::seal_t seal{};
    seal.version = pmg_msgs::seal_t::VERSION;
    seal.boot = seal_.boot();
    seal::append(bytes, seal);
    gate_.take(bytes);
  }
  static hoist_t lift(std::int64_t sequence, bool up = true) {
    hoist_t message{};
    message.version = hoist_t::VERSION;
    message.robot = "biped";
    message.source = "pmg_send.1";
    message.session = 7;
    message.sequence = sequence;
    message.request = up ? hoist_t::LIFT : hoist_t::LOWER;
    return message;
  }
  hal::HoistLine line_;
  io::SimulationClock clock_;
  seal::ControllerSeal seal_;
  runtime::DatagramOrder order_;
  runtime::HoistGate gate_{"biped", clock_, seal_, order_};
};

TEST_F(HoistGateTest, AControllerWithoutAHoistCountsAndIgnores) {
  send(lift(1));
  EXPECT_EQ(gate_.counts().no_hoist, 1);
  pmg_msgs::hoist_state_t state{};
  EXPECT_FALSE(gate_.fill(state));
  gate_.see(control::TickResult{});
}

TEST_F(HoistGateTest, TheNewestRequestCountsHoweverOftenAndLateItComes) {
  gate_.work(&line_);
  send(lift(2));
  EXPECT_TRUE(line_.stays_up());
  pmg_msgs::hoist_state_t state{};
  EXPECT_TRUE(gate_.fill(state));
  EXPECT_EQ(state.source, "pmg_send.1");
  EXPECT_EQ(state.sequence, 2);
  EXPECT_FALSE(gate_.fill(state)) << "said";
  send(lift(3, false));
  send(lift(2));  // overtaken
  EXPECT_FALSE(line_.stays_up());
  EXPECT_TRUE(gate_.fill(state)) << "answered all the same";
  EXPECT_EQ(state.sequence, 3);
}

TEST_F(HoistGateTest, ARepetitionIsAnsweredAndNotCarriedOutAfterAnothersRequest) {
  gate_.work(&line_);
  hoist_t mine = lift(1), others = lift(1, false);
  others.source = "keyboard.2";
  send(mine);
  send(others);
  send(mine);  // played back
  EXPECT_FALSE(line_.stays_up());
  pmg_msgs::hoist_state_t state{};
  gate_.fill(state);
  EXPECT_EQ(state.source, "keyboard.2");
  mine.stamp_ns = 50'000'000;  // its sender repeats it, because it hasn't heard the answer
  send(mine);
  EXPECT_FALSE(line_.stays_up());
  EXPECT_TRUE(gate_.fill(state));
  EXPECT_EQ(state.source, "pmg_send.1") << "it is told, and sees that the hoist does something else";
  EXPECT_FALSE(state.stays_up);
}

TEST_F(HoistGateTest, WhatIsNotMeantForItIsCountedAndIgnored) {
  gate_.work(&line_);
  hoist_t message = lift(1);
  message.robot = "other";
  send(message);
  message = lift(1);
  message.version = 1;
  send(message);
  message = lift(1);
  message.request = 5;
  send(message);
  message = lift(1);
  message.source = "";
  send(message);
  gate_.take(std::vector<std::uint8_t>{1, 2, 3});
  EXPECT_EQ(gate_.counts(), (runtime::GateCounts{.malformed = 3, .other_version = 1, .other_robot = 1}));
  EXPECT_FALSE(line_.stays_up());
}

}  // namespace
}  // namespace pmg::sil
