// What is believed of a hoist's state: the controller's own word alone, of the start that speaks now.
#include "operator/heard_hoist.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "operator/robot_board.hpp"
#include "pmg_msgs/status_t.hpp"
#include "seal/controller_seal.hpp"

namespace pmg::ops {
namespace {

using Hoist = pmg_msgs::hoist_state_t;

constexpr std::int64_t kHeard_ns = 5'000'000'000;

class HeardHoistTest : public testing::Test {
 protected:
  static Hoist said(std::int64_t stamp_ns, std::int8_t state) {
    Hoist hoist{};
    hoist.robot = "biped";
    hoist.stamp_ns = stamp_ns;
    hoist.state = state;
    return hoist;
  }
  template <typename Message>
  static std::vector<std::uint8_t> proven(seal::ControllerSeal& controller, const char* channel,
                                          const Message& message) {
    const io::Bytes bytes = controller.prove(channel, message);
    return {bytes.begin(), bytes.end()};
  }
  void hear(const std::vector<std::uint8_t>& bytes) {
    heard_.hear(seal::decode_sealed<Hoist, pmg_msgs::proof_t>(bytes).value(), controller_.boot(), operator_, kHeard_ns);
  }

  seal::Secret secret_ = seal::random_secret();
  seal::ControllerKeys keys_{.own = seal::random_secret(), .operators = {{"anna", secret_}}};
  seal::ControllerSeal controller_{keys_}, next_start_{keys_};
  seal::ControllerSeal impostor_{seal::ControllerKeys{.own = seal::random_secret(), .operators = {}}};
  seal::OperatorSeal operator_{{{"anna", seal::Signer(keys_.own).public_key(), secret_}}, false};
  HeardHoist heard_;
};

TEST_F(HeardHoistTest, TheNewestWordOfTheControllerCounts) {
  hear(proven(controller_, "HOIST_STATE", said(10, Hoist::LIFTING)));
  hear(proven(controller_, "HOIST_STATE", said(20, Hoist::HOLDING)));
  hear(proven(controller_, "HOIST_STATE", said(10, Hoist::LIFTING)));
  ASSERT_TRUE(heard_.speaking(kHeard_ns));
  EXPECT_EQ(heard_.speaking(kHeard_ns)->state, Hoist::HOLDING);
  EXPECT_FALSE(heard_.speaking(kHeard_ns + HeardHoist::kSilent_ns + 1));
}

TEST_F(HeardHoistTest, NoStrangersWordCounts) {
  std::vector<std::uint8_t> alone;
  seal::append(alone, said(10, Hoist::HOLDING));
  hear(alone);
  EXPECT_FALSE(heard_.state) << "without a seal";
  hear(proven(next_start_, "HOIST_STATE", said(10, Hoist::HOLDING)));
  EXPECT_FALSE(heard_.state) << "of another start, recorded or not";
  const auto forged =
      seal::decode_sealed<Hoist, pmg_msgs::proof_t>(proven(impostor_, "HOIST_STATE", said(10, Hoist::HOLDING)));
  ASSERT_TRUE(forged && forged->seal);
  std::vector<std::uint8_t> bytes;
  seal::append(bytes, forged->message);
  pmg_msgs::proof_t proof = *forged->seal;
  proof.boot = controller_.boot();
  seal::append(bytes, proof);
  hear(bytes);
  EXPECT_FALSE(heard_.state) << "of this start, but with another's signature";
}

TEST_F(HeardHoistTest, WhatEverybodySeesOfARobotKeepsToTheSameRule) {
  io::SimulationClock clock;
  io::LcmLink link{"memq://"};
  clock.advance_to(kHeard_ns);
  const RobotBoard board(link, clock, operator_);
  const auto send = [&](seal::ControllerSeal& controller, const char* channel, const auto& message) {
    link.send(channel, proven(controller, channel, message));
    link.receive(0);
  };
  pmg_msgs::status_t status{};
  status.robot = "biped";
  status.stamp_ns = kHeard_ns;
  send(controller_, "STATUS", status);
  link.publish("HOIST_STATE", said(10, Hoist::HOLDING));
  send(next_start_, "HOIST_STATE", said(20, Hoist::HOLDING));
  ASSERT_TRUE(board.robots().contains("biped"));
  const HeardHoist& hoist = board.robots().at("biped").hoist;
  EXPECT_FALSE(hoist.state);
  send(controller_, "HOIST_STATE", said(30, Hoist::FREE));
  ASSERT_TRUE(hoist.state);
  EXPECT_EQ(hoist.state->state, Hoist::FREE);

  clock.advance_to(kHeard_ns + 2 * StatusOrder::kSpeaks_ns);
  status.stamp_ns = clock.now_ns();
  send(next_start_, "STATUS", status);
  EXPECT_FALSE(hoist.state) << "an earlier start's hoist holds nothing any more";
}

}  // namespace
}  // namespace pmg::ops
