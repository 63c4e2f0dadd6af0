// Everything that docs/reference/network.md says can't be done is tried at once, while an operator drives and stops.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "networked_robot.hpp"
#include "operator/drive.hpp"
#include "operator/mode_wish.hpp"
#include "pmg_msgs/mode_t.hpp"

namespace pmg::ops {
namespace {

using control::Mode;
using Packet = std::vector<std::uint8_t>;

/// With keys or without. Anna drives. Bob, another operator, sends all that he may and more, under ten names; a
/// recorder plays back what it heard; a stranger forges.
class Attack : public testing::TestWithParam<bool> {
 protected:
  Attack() {
    for (const char* channel : {"COMMAND", "MODE", "STATUS", "ACK", "CLAIM"}) {
      network_.link.subscribe(channel, [this, channel](io::Bytes bytes) {
        record(channel, {bytes.begin(), bytes.end()});
      });
    }
    for (int k = 0; k < 10; ++k) {
      bob_.emplace_back(network_.link, "bob." + std::to_string(k), 1, network_.clock, bobs_);
    }
    for (int k = 0; k < 3; ++k) network_.advance();
  }

  seal::OperatorSeal seal_of(const char* name) const {
    if (!GetParam()) return {};
    return {{{name, seal::Signer(keys_.own).public_key(), keys_.operators.at(name)}}, false};
  }
  void record(const std::string& channel, const Packet& packet) {
    std::deque<Packet>& last = heard_[channel];
    if (packet == forged_ || std::ranges::find(last, packet) != last.end()) return;
    last.push_back(packet);
    if (last.size() > 8) last.pop_front();
  }
  /// In 10 ms some 70 datagrams.
  void attack(bool bob) {
    for (const auto& [channel, packets] : heard_) {
      for (const Packet& packet : packets) network_.link.send(channel, packet);
    }
    for (OperatorSource& name : bob_) {
      if (!bob) break;
      name.send_command("biped", Command{{-0.3}}, 2.0);
      name.request("biped", pmg_msgs::mode_t::STAND, false);
    }
    forged_ = heard_["STATUS"].back();
    forged_[forged_.size() / 2] ^= 1;
    for (int k = 0; k < 5; ++k) network_.link.send("STATUS", forged_);
    network_.link.send("MODE", Packet(100, 0x5a));
    network_.advance();
  }

  test::Network network_;
  seal::ControllerKeys keys_{.own = seal::random_secret(),
                             .operators = {{"anna", seal::random_secret()}, {"bob", seal::random_secret()}}};
  test::NetworkedRobot& robot_ = network_.add_robot("biped", GetParam() ? std::optional(keys_) : std::nullopt);
  seal::OperatorSeal annas_ = seal_of("anna"), bobs_ = seal_of("bob");
  OperatorSource anna_{network_.link, "anna.1", 1, network_.clock, annas_};
  OperatorSource stops_{network_.link, "anna.2", 1, network_.clock, annas_};
  std::deque<OperatorSource> bob_;
  std::map<std::string, std::deque<Packet>> heard_;
  Packet forged_;
};

TEST_P(Attack, AWalkGoesOnAStopDampsWithin50MillisecondsAndNothingRaisesTheRobot) {
  constexpr int kStops = 50;
  int latest_ms = 0;
  for (int k = 0; k < kStops; ++k) {
    SCOPED_TRACE(k);
    Drive drive(anna_, "biped", Command{{0.3}}, {.duration_s = 100.0, .climb = true});
    Progress progress = Progress::kPending;
    while (progress == Progress::kPending && !drive.driving()) {
      attack(false);
      progress = drive.step();
    }
    for (int tick = 0; tick < 20 + k % 7; ++tick) {
      attack(true);
      progress = drive.step();
    }
    ASSERT_TRUE(drive.driving()) << drive.text();
    ASSERT_EQ(robot_.result().mode, Mode::kWalk);
    ModeWish stop(stops_, "biped", Goal::kStop, 2.0);
    int ms = 0;
    for (; ms < 200 && robot_.bus.last_command.kp.sum() != 0.0; ms += 10) attack(true);
    latest_ms = std::max(latest_ms, ms);
    for (int tick = 0; tick < 60; ++tick) {
      attack(false);
      progress = stop.step();
      ASSERT_EQ(robot_.result().mode, Mode::kDamping);
    }
    EXPECT_EQ(progress, Progress::kReached) << "and it is acknowledged";
  }
  EXPECT_LE(latest_ms, 50);
  RecordProperty("latest_ms", latest_ms);
}

INSTANTIATE_TEST_SUITE_P(With, Attack, testing::Bool(),
                         [](const auto& keys) { return keys.param ? "Keys" : "NoKeys"; });

}  // namespace
}  // namespace pmg::ops
