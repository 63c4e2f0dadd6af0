// An operator's program leads the arms of a whole controller over the network, and is told what they do and why not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "arms_operator/arms_board.hpp"
#include "arms_operator/arms_lead.hpp"
#include "arms_operator/arms_text.hpp"
#include "operator/drive.hpp"
#include "operator/networked_robot.hpp"
#include "seal/controller_seal.hpp"

namespace pmg::ops {
namespace {

using State = pmg_msgs::arms_state_t;
using testing::HasSubstr;

class ArmsOperator : public testing::Test {
 protected:
  explicit ArmsOperator(const model::RobotModel& model = test::z1()) : robot_(network_.add_robot("z1", {}, model)) {
    for (int k = 0; k < 15; ++k) network_.advance();
  }
  PalmGoal moved(Foot side, double x_m, double z_m) {
    const ArmNews arm = arm_news(board_.of("z1")->state, side);
    return {.wish = pmg_msgs::arms_t::AIM, .p_m = {arm.p_m[0] + x_m, arm.p_m[1], arm.p_m[2] + z_m}};
  }
  /// Drives on the spot for so long, and leads the arms meanwhile.
  void lead(ArmsLead& arms, double duration_s) {
    Drive drive(source_, "z1", Command{}, {.duration_s = duration_s, .climb = true});
    for (int k = 0; k < 3000 && drive.step() == Progress::kPending; ++k) {
      if (drive.driving()) {
        arms.step();
        drive.lead(arms.wishes());
        reached_ = arms.reached();
        text_ = arms.text();
      }
      network_.advance();
    }
    EXPECT_EQ(drive.text(), "");
  }

  test::Network network_;
  test::NetworkedRobot& robot_;
  OperatorSource source_{network_.link, "anna", 5, network_.clock};
  ArmsBoard board_{network_.link, network_.clock};
  bool reached_ = false;
  std::string text_;
};

class ArmsOperatorOfAnArmlessRobot : public ArmsOperator {
 protected:
  ArmsOperatorOfAnArmlessRobot() : ArmsOperator(test::biped()) {}
};

TEST_F(ArmsOperator, PalmsAreLedToTheirTargetsAndHandedBack) {
  ASSERT_NE(board_.of("z1"), nullptr) << "what the arms do is told before anybody leads them";
  PerFoot<PalmGoal> goals;
  goals[kLeft] = moved(kLeft, 0.1, 0.15);
  ArmsLead there(network_.clock, board_, "z1", goals);
  lead(there, 2.0);
  EXPECT_TRUE(reached_) << text_;
  EXPECT_EQ(text_, "left arm: at its target");
  EXPECT_EQ(there.trouble(), "");
  EXPECT_EQ(robot_.result().arms.refused, 0);
  EXPECT_LT((robot_.result().arms.arm[kLeft].palm.p_m - goals[kLeft].p_m).norm(), 0.005);
  EXPECT_EQ(board_.of("z1")->state.left, State::HELD) << "in Stand, afterwards";
  EXPECT_EQ(board_.of("z1")->state.right, State::REFERENCE) << "of which nothing was asked";
  EXPECT_EQ(hold_text(board_.of("z1")->state), "the robot doesn't walk: arms are led in walk only");

  goals[kLeft] = goals[kRight] = {.wish = pmg_msgs::arms_t::HAND_BACK};
  ArmsLead back(network_.clock, board_, "z1", goals);
  lead(back, 3.0);
  EXPECT_TRUE(reached_) << text_;
  EXPECT_EQ(board_.of("z1")->state.left, State::REFERENCE);
}

TEST_F(ArmsOperator, ATargetOutOfReachIsNotReachedAndSaidSo) {
  PerFoot<PalmGoal> goals;
  goals[kRight] = {.wish = pmg_msgs::arms_t::AIM, .p_m = {2.0, -0.3, 0.3}};
  ArmsLead far(network_.clock, board_, "z1", goals);
  lead(far, 3.0);
  EXPECT_FALSE(reached_);
  EXPECT_THAT(text_, testing::MatchesRegex("right arm: .*: 1\\.[0-9]+ m and .* from its target"));
}

TEST_F(ArmsOperator, WhatIsRefusedIsToldWithItsReason) {
  ArmsSource arms(source_);
  PerFoot<PalmWish> palms;
  palms[kLeft].wish = pmg_msgs::arms_t::AIM;
  arms.send("z1", palms, 0.2);  // in Passive, nobody drives
  for (int k = 0; k < 15; ++k) network_.advance();
  const State& state = board_.of("z1")->state;
  EXPECT_EQ(state.last_refusal, State::OTHER_SOURCE);
  EXPECT_THAT(arms_lines(state).back(), HasSubstr("1 targets refused, the last: its source doesn't drive the robot"));
  source_.send_command("z1", Command{}, 0.5);
  palms[kLeft].R.coeffs() *= 2.0;
  arms.send("z1", palms, 0.2);
  for (int k = 0; k < 15; ++k) network_.advance();
  EXPECT_EQ(board_.of("z1")->state.last_refusal, State::NO_POSE);
  EXPECT_EQ(arms_json(board_.of("z1")->state)["last_refusal"], "no_pose");
  EXPECT_EQ(arms_json(board_.of("z1")->state)["refused"], 2);
}

TEST_F(ArmsOperator, WhatASilentControllerSaidCountsNoLonger) {
  network_.control_alive = false;
  for (int k = 0; k < 120; ++k) network_.advance();
  EXPECT_EQ(board_.of("z1"), nullptr);
}

TEST_F(ArmsOperator, OnlyTheControllersOwnWordCounts) {
  const seal::ControllerKeys keys{.own = seal::random_secret(), .operators = {}};
  const seal::OperatorSeal strict({{"anna", seal::Signer(keys.own).public_key(), seal::random_secret()}}, false);
  const ArmsBoard believes(network_.link, network_.clock, strict);
  for (int k = 0; k < 15; ++k) network_.advance();
  EXPECT_EQ(believes.of("z1"), nullptr) << "unsigned";
}

TEST_F(ArmsOperator, InventedNamesFillNoMemory) {
  seal::ControllerSeal anybody;
  State state{};
  for (int k = 0; k < 1000; ++k) {
    state.robot = "robot " + std::to_string(k);
    network_.link.send("ARMS_STATE", anybody.prove("ARMS_STATE", state));
    network_.link.receive(0);
  }
  int known = 0;
  for (int k = 0; k < 1000; ++k) known += board_.of("robot " + std::to_string(k)) != nullptr;
  EXPECT_EQ(known, 63) << "one place is z1's";
}

TEST_F(ArmsOperatorOfAnArmlessRobot, ARobotWithoutArmsIsSaidToHaveNone) {
  PerFoot<PalmGoal> goals;
  goals[kLeft].wish = pmg_msgs::arms_t::HAND_BACK;
  ArmsLead lead(network_.clock, board_, "z1", goals);
  for (int k = 0; k < 120; ++k) {
    lead.step();
    network_.advance();
  }
  EXPECT_THAT(lead.trouble(), HasSubstr("the robot has none that can be led"));
}

TEST(ArmsText, EveryStateHasItsWordsAndAnotherVersionsIsShownAsANumber) {
  const auto text = [](std::int8_t activity) { return arm_text({.activity = activity, .error_m = 0.5}); };
  EXPECT_EQ(text(State::REFERENCE), "the gait moves it");
  EXPECT_EQ(text(State::FOLLOWING), "on the way to its target: 0.500 m and 0.00 rad from its target");
  EXPECT_EQ(text(State::OUT_OF_REACH),
            "out of reach, as near as its joints allow: 0.500 m and 0.00 rad from its target");
  EXPECT_EQ(text(State::BLOCKED), "near another link, comes no closer: 0.500 m and 0.00 rad from its target");
  EXPECT_EQ(text(State::HELD), "stays where it is");
  EXPECT_EQ(text(State::RETURNING), "on the way back to the gait");
  EXPECT_EQ(text(17), "unknown (17)");
  EXPECT_EQ(text(-1), "unknown (-1)");
  for (std::int8_t refusal = State::OTHER_SOURCE; refusal <= State::NO_LEASE; ++refusal)
    EXPECT_STRNE(refusal_words(refusal), "");
  State state{};
  state.left = State::HELD;
  state.order = State::LEASE_OVER;
  EXPECT_EQ(hold_text(state), "the driving source sends no targets any more");
  state.order = State::NONE_CAME;
  EXPECT_EQ(hold_text(state), "the driving source has sent no targets");
  state.order = State::IN_FORCE;
  EXPECT_EQ(hold_text(state), "");
  for (const std::string& line : arms_lines(state)) EXPECT_LE(line.size(), 80u) << line;
}

}  // namespace
}  // namespace pmg::ops
