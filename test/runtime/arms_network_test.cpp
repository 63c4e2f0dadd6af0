// Arms from the network's bytes to the drives, on a virtual clock: who is heard, and what stops them.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "control/control_rig.hpp"
#include "pmg_msgs/arms_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "runtime/operator_gate.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::runtime {
namespace {

using arms::ArmActivity;
using Packet = std::vector<std::uint8_t>;

/// Z1 in Walk behind a gate with keys; anna drives it and may lead its arms.
class ArmsNetwork : public testing::Test {
 protected:
  ArmsNetwork() {
    command_.version = pmg_msgs::command_t::VERSION;
    mode_.version = pmg_msgs::mode_t::VERSION;
    arms_.version = pmg_msgs::arms_t::VERSION;
    command_.robot = mode_.robot = arms_.robot = "z1";
    command_.source = mode_.source = arms_.source = "anna";
    command_.session = mode_.session = arms_.session = 1;
    command_.lease_s = arms_.lease_s = 0.5;
    rig_.silent = true;
  }
  void SetUp() override {
    pmg_msgs::status_t status{};
    status.robot = "z1";
    const io::Bytes told = controller_.prove("STATUS", status);
    const auto heard = seal::decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(told);
    peer_ = anna_.believe("STATUS", heard->message_bytes, heard->seal, 0);
    ASSERT_TRUE(peer_);
    ticks(10);  // both feet stand
    ask_for_walk();
    for (const Foot side : {kLeft, kRight}) rest_[side] = state().arm[side].palm;
  }

  void ask_for_walk() {
    speak();
    mode_.stamp_ns = rig_.clock.now_ns();
    mode_.mode = pmg_msgs::mode_t::WALK;
    ++mode_.sequence;
    gate_.take_mode(sealed("MODE", mode_, anna_));
    for (int k = 0; k < 600 && rig_.mode() != control::Mode::kWalk; ++k) tick();
    ASSERT_EQ(rig_.mode(), control::Mode::kWalk);
  }
  template <typename Message>
  Packet sealed(const char* channel, const Message& message, seal::OperatorSeal& by) {
    peer_->heard_ns = rig_.clock.now_ns();
    const io::Bytes bytes = by.seal(channel, message, &*peer_);
    return {bytes.begin(), bytes.end()};
  }
  void speak() {
    command_.stamp_ns = rig_.clock.now_ns();
    ++command_.sequence;
    gate_.take_command(sealed("COMMAND", command_, anna_));
  }
  /// The left palm so far up from where it was [m].
  Packet lifted(double up_m, seal::OperatorSeal& by) {
    arms_.stamp_ns = rig_.clock.now_ns();
    ++arms_.sequence;
    arms_.left = pmg_msgs::arms_t::AIM;
    for (int axis = 0; axis < 3; ++axis) arms_.left_p_m[axis] = rest_[kLeft].p_m[axis] + (axis == 2 ? up_m : 0.0);
    const Eigen::Quaterniond& R = rest_[kLeft].R;
    arms_.left_orientation[0] = R.w();
    for (int i = 0; i < 3; ++i) arms_.left_orientation[i + 1] = R.vec()[i];
    return sealed("ARMS", arms_, by);
  }
  void tick() {
    speak();
    for (int cycle = 0; cycle < test::kCyclesPerTick; ++cycle) rig_.cycle();
  }
  void ticks(int count) {
    for (int k = 0; k < count; ++k) tick();
  }
  const control::ArmsState& state() const { return rig_.tick.result().arms; }

  seal::Secret secret_ = seal::random_secret();
  seal::ControllerKeys keys_{.own = seal::random_secret(), .operators = {{"anna", secret_}}};
  seal::ControllerSeal controller_{keys_};
  seal::OperatorSeal anna_{{{"anna", seal::Signer(keys_.own).public_key(), secret_}}, false};
  seal::OperatorSeal forger_{{{"anna", seal::Signer(keys_.own).public_key(), seal::random_secret()}}, false};
  std::optional<seal::Peer> peer_;
  test::ControlRig rig_{test::z1()};
  DatagramOrder order_;
  OperatorGate gate_{rig_.inbox, "z1", rig_.clock, controller_, order_};
  pmg_msgs::command_t command_{};
  pmg_msgs::mode_t mode_{};
  pmg_msgs::arms_t arms_{};
  arms::PerArm<arms::PalmPose> rest_;
};

TEST_F(ArmsNetwork, TheDriversKeyLeadsAndForgedReplayedAndMisdirectedTargetsDoNothing) {
  gate_.take_arms(lifted(0.05, forger_));
  EXPECT_EQ(gate_.counts().no_key, 1) << "forged";
  gate_.take_arms(sealed("COMMAND", arms_, anna_));
  EXPECT_EQ(gate_.counts().no_key, 2) << "sealed for another channel";
  Packet changed = lifted(0.05, anna_);
  changed[90] ^= 1;
  gate_.take_arms(changed);
  EXPECT_EQ(gate_.counts().no_key + gate_.counts().malformed, 3) << "changed on its way";
  ticks(5);
  EXPECT_EQ(state().arm[kLeft].activity, ArmActivity::kReference);

  const Packet recorded = lifted(0.05, anna_);
  gate_.take_arms(recorded);
  ticks(1);
  EXPECT_EQ(state().arm[kLeft].activity, ArmActivity::kFollowing);
  gate_.take_arms(recorded);
  ticks(1);
  EXPECT_EQ(gate_.counts().out_of_order, 1) << "played again at once";
  ticks(110);
  EXPECT_EQ(state().arm[kLeft].activity, ArmActivity::kHeld);
  const arms::PalmPose held = state().arm[kLeft].palm;
  const auto not_fresh = gate_.counts().not_fresh;
  gate_.take_arms(recorded);
  ticks(5);
  EXPECT_EQ(gate_.counts().not_fresh, not_fresh + 1) << "and a second later";
  EXPECT_EQ(state().arm[kLeft].palm.p_m, held.p_m);

  controller_.set_operators({});  // revoked
  gate_.take_arms(lifted(0.0, anna_));
  EXPECT_EQ(gate_.counts().no_key + gate_.counts().malformed, 4);
}

TEST_F(ArmsNetwork, AStopDampsWithin50MillisecondsWhileArmsFlood) {
  constexpr int kMost = 25;  // bus cycles of 2 ms
  for (int offset = 0; offset < test::kCyclesPerTick; ++offset) {
    SCOPED_TRACE(offset);
    if (rig_.mode() != control::Mode::kWalk) ask_for_walk();
    const auto flood = [&] {
      for (int k = 0; k < 100; ++k) {
        gate_.take_arms(lifted(0.1 * (k % 2), anna_));
        gate_.take_arms(lifted(1e300, forger_));
        gate_.take_arms(Packet(200, static_cast<std::uint8_t>(k)));
      }
    };
    for (int k = 0; k < 20; ++k) {
      flood();
      tick();
    }
    EXPECT_GT(gate_.counts().flooded, 0);
    ASSERT_EQ(rig_.mode(), control::Mode::kWalk);
    rig_.align(offset);
    flood();
    pmg_msgs::mode_t stop{};
    stop.version = pmg_msgs::mode_t::VERSION;
    stop.source = "bystander";
    stop.mode = pmg_msgs::mode_t::DAMPING;
    Packet bytes(static_cast<std::size_t>(stop.getEncodedSize()));
    stop.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    gate_.take_mode(bytes);  // without a key
    int cycles = 0;
    for (; cycles < 100 && !rig_.bus.damping(); ++cycles) {
      rig_.cycle();
      flood();
    }
    EXPECT_LE(cycles, kMost);
    for (int k = 0; k < 50; ++k) {
      flood();
      tick();
    }
    EXPECT_EQ(rig_.mode(), control::Mode::kDamping) << "targets raise nobody";
    EXPECT_TRUE(rig_.bus.damping());
  }
}

}  // namespace
}  // namespace pmg::runtime
