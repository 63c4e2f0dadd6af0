// Seals and proofs: a message that was changed, recorded, or made without the key is not taken.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "seal/controller_seal.hpp"
#include "seal/operator_seal.hpp"

namespace pmg::seal {
namespace {

using Judgement = ControllerSeal::Judgement;
using Bytestring = std::vector<std::uint8_t>;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

ControllerKeys keys_with(const std::string& name, const Secret& secret) {
  return {.own = random_secret(), .operators = {{name, secret}}};
}

class Seal : public testing::Test {
 protected:
  Seal() {
    command_.robot = "z1";
    command_.source = "anna.gamepad";
    command_.vx_m_s = 0.25;
  }
  /// The operator hears a STATUS of this time, and seals a command for it.
  Bytestring sealed_command(ControllerSeal& controller, OperatorSeal& driver, std::int64_t heard_ns) {
    const auto peer = heard(controller, driver, heard_ns);
    const io::Bytes bytes = driver.seal("COMMAND", command_, peer ? &*peer : nullptr);
    return {bytes.begin(), bytes.end()};
  }
  static std::optional<Peer> heard(ControllerSeal& controller, OperatorSeal& driver, std::int64_t heard_ns) {
    pmg_msgs::status_t status{};
    status.robot = "z1";
    const io::Bytes bytes = controller.prove("STATUS", status);
    const auto proven = decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
    auto peer = driver.believe("STATUS", proven->message_bytes, proven->seal, 0);
    if (peer) peer->heard_ns = heard_ns;
    return peer;
  }
  static Judgement judge(const ControllerSeal& controller, const Bytestring& bytes, std::int64_t now_ns,
                         const char* channel = "COMMAND") {
    const auto sealed = decode_sealed<pmg_msgs::command_t, pmg_msgs::seal_t>(bytes);
    if (!sealed) return Judgement::kNotFresh;
    return controller.judge(channel, sealed->message.source, sealed->message_bytes, sealed->seal, now_ns);
  }

  pmg_msgs::command_t command_{};
  Secret secret_ = random_secret();
  ControllerKeys keys_ = keys_with("anna", secret_);
  ControllerSeal keyed_{keys_};
  OperatorSeal anna_{{{"anna", Signer(keys_.own).public_key(), secret_}}, false};
};

TEST_F(Seal, AnOperatorWithAKeyIsTakenAndTheMessageIsTheOneThatItSent) {
  const Bytestring bytes = sealed_command(keyed_, anna_, kSecond_ns);
  EXPECT_EQ(judge(keyed_, bytes, kSecond_ns), Judgement::kGood);
  const auto sealed = decode_sealed<pmg_msgs::command_t, pmg_msgs::seal_t>(bytes);
  EXPECT_EQ(sealed->message.vx_m_s, 0.25);
  pmg_msgs::command_t plain{};
  EXPECT_EQ(plain.decode(bytes.data(), 0, static_cast<int>(bytes.size())),
            static_cast<int>(sealed->message_bytes.size()))
      << "a stock decoder reads the message and leaves the seal";
}

TEST_F(Seal, EveryChangedBitIsSeen) {
  const Bytestring good = sealed_command(keyed_, anna_, kSecond_ns);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytestring bytes = good;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1u << bit % 8);
    EXPECT_NE(judge(keyed_, bytes, kSecond_ns), Judgement::kGood) << "bit " << bit;
  }
}

TEST_F(Seal, ASealIsGoodForOneSecondAndOneStartOfTheController) {
  const Bytestring bytes = sealed_command(keyed_, anna_, 5 * kSecond_ns);
  EXPECT_EQ(judge(keyed_, bytes, 6 * kSecond_ns), Judgement::kGood);
  EXPECT_EQ(judge(keyed_, bytes, 6 * kSecond_ns + 1), Judgement::kNotFresh);
  EXPECT_EQ(judge(keyed_, bytes, 5 * kSecond_ns - 1), Judgement::kNotFresh) << "of a STATUS that was never sent";
  const ControllerSeal restarted(keys_);
  EXPECT_EQ(judge(restarted, bytes, 5 * kSecond_ns), Judgement::kNotFresh);
  for (const std::int64_t heard_ns :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(judge(keyed_, sealed_command(keyed_, anna_, heard_ns), 0), Judgement::kNotFresh);
  }
}

TEST_F(Seal, WithoutKeysFreshnessIsAskedForAllTheSame) {
  ControllerSeal open;
  OperatorSeal driver;
  const Bytestring bytes = sealed_command(open, driver, kSecond_ns);
  EXPECT_EQ(judge(open, bytes, kSecond_ns), Judgement::kGood);
  EXPECT_EQ(judge(open, bytes, 3 * kSecond_ns), Judgement::kNotFresh);
  EXPECT_EQ(judge(ControllerSeal(), bytes, kSecond_ns), Judgement::kNotFresh);
  const io::Bytes alone = driver.seal("COMMAND", command_, nullptr);
  EXPECT_EQ(judge(open, {alone.begin(), alone.end()}, kSecond_ns), Judgement::kNotFresh);
}

TEST_F(Seal, AWrongUnknownOrRevokedKeyIsNone) {
  OperatorSeal wrong({{"anna", Signer(keys_.own).public_key(), random_secret()}}, false);
  EXPECT_EQ(judge(keyed_, sealed_command(keyed_, wrong, kSecond_ns), kSecond_ns), Judgement::kNoKey);
  OperatorSeal stranger({{"bert", Signer(keys_.own).public_key(), secret_}}, false);
  EXPECT_EQ(judge(keyed_, sealed_command(keyed_, stranger, kSecond_ns), kSecond_ns), Judgement::kNoKey);
  OperatorSeal none;
  EXPECT_EQ(judge(keyed_, sealed_command(keyed_, none, kSecond_ns), kSecond_ns), Judgement::kNoKey);
  const Bytestring bytes = sealed_command(keyed_, anna_, kSecond_ns);
  keyed_.set_operators({});
  EXPECT_EQ(judge(keyed_, bytes, kSecond_ns), Judgement::kNoKey);
}

TEST_F(Seal, AKeyIsGoodForItsOperatorsNameOnly) {
  const auto judged_as = [&](const char* source) {
    command_.source = source;
    return judge(keyed_, sealed_command(keyed_, anna_, kSecond_ns), kSecond_ns);
  };
  for (const char* source : {"anna", "anna.4711", "anna."}) EXPECT_EQ(judged_as(source), Judgement::kGood) << source;
  for (const char* source : {"bob", "bob.anna", "annabel", "ann", "Anna", "", ".", "anna\x1b"}) {
    EXPECT_EQ(judged_as(source), Judgement::kNoKey) << source;
  }
  EXPECT_EQ(judged_as(anna_.source_name("gamepad").c_str()), Judgement::kGood);
  EXPECT_TRUE(OperatorSeal().source_name("gamepad").starts_with("gamepad."));
}

TEST_F(Seal, ACodeIsGoodOnItsChannelOnly) {
  EXPECT_EQ(judge(keyed_, sealed_command(keyed_, anna_, kSecond_ns), kSecond_ns, "MODE"), Judgement::kNoKey);
}

TEST_F(Seal, AnOperatorWithKeysBelievesItsControllerAlone) {
  EXPECT_TRUE(heard(keyed_, anna_, 0)->key);
  ControllerSeal other(keys_with("anna", secret_)), open;
  EXPECT_FALSE(heard(other, anna_, 0)) << "another controller's key";
  EXPECT_FALSE(heard(open, anna_, 0)) << "no signature";
  OperatorSeal here({{"anna", Signer(keys_.own).public_key(), secret_}}, true);
  EXPECT_FALSE(heard(open, here, 0)->key);
  EXPECT_TRUE(heard(other, here, 0)->wants_key);
}

/// An operator of four robots, and a stranger who writes STATUS as one of them.
class ForgedStatus : public Seal {
 protected:
  ForgedStatus() {
    for (int k = 0; k < 3; ++k)
      keys_of_anna_.push_back({"anna", Signer(random_secret()).public_key(), random_secret()});
    keys_of_anna_.push_back({"anna", Signer(keys_.own).public_key(), secret_});
    operator_.emplace(keys_of_anna_, false);
  }
  /// (STATUS of this time) => believed.
  bool hear(std::int64_t now_ns) {
    pmg_msgs::status_t status{};
    status.stamp_ns = now_ns;
    const io::Bytes bytes = keyed_.prove("STATUS", status);
    const auto proven = decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
    return operator_->believe("STATUS", proven->message_bytes, proven->seal, now_ns).has_value();
  }
  void forge(std::int64_t boot, std::int64_t now_ns) {
    pmg_msgs::proof_t proof{.version = 1, .boot = boot, .signature_size = 64, .signature = {}};
    proof.signature.assign(64, static_cast<std::uint8_t>(++forged_));
    const Bytestring message(100, static_cast<std::uint8_t>(forged_ / 251));
    EXPECT_FALSE(operator_->believe("STATUS", message, proof, now_ns));
  }

  std::vector<OperatorKey> keys_of_anna_;
  std::optional<OperatorSeal> operator_;
  int forged_ = 0;
};

TEST_F(ForgedStatus, AThousandASecondInAKnownStartsNameDeafenNobodyAndCostOneLookEach) {
  int heard = 0;
  for (int ms = 0; ms < 2000; ++ms) {
    const std::int64_t now_ns = ms * 1'000'000;
    if (ms % 10 == 0) heard += hear(now_ns) ? 1 : 0;
    forge(keyed_.boot(), now_ns);
  }
  EXPECT_GE(heard, 100) << "half of 100 a second at least";
  EXPECT_LE(operator_->signatures_checked(), 2000 + 100 + 4);
}

TEST_F(ForgedStatus, InventedStartsTakeNothingFromAKnownOne) {
  EXPECT_TRUE(hear(0));
  int heard = 0;
  for (int ms = 1; ms <= 1000; ++ms) {
    const std::int64_t now_ns = ms * 1'000'000;
    for (int k = 0; k < 80; ++k) forge(random_number(), now_ns);
    if (ms % 10 == 0) heard += hear(now_ns) ? 1 : 0;
  }
  EXPECT_EQ(heard, 100);
  EXPECT_LE(operator_->signatures_checked(), 101 + 40 + 100 + 4) << "of 80,000 forged ones";
}

TEST_F(ForgedStatus, WhatSeveralPartsOfAProgramLookAtIsCheckedOnce) {
  const OperatorSeal board = *operator_;
  pmg_msgs::status_t status{};
  const io::Bytes bytes = keyed_.prove("STATUS", status);
  const auto proven = decode_sealed<pmg_msgs::status_t, pmg_msgs::proof_t>(bytes);
  EXPECT_EQ(operator_->believe("STATUS", proven->message_bytes, proven->seal, 0)->key, 3u);
  EXPECT_EQ(board.believe("STATUS", proven->message_bytes, proven->seal, 0)->key, 3u);
  EXPECT_EQ(board.signatures_checked(), 4) << "once by each key";
  EXPECT_FALSE(board.believe("ACK", proven->message_bytes, proven->seal, 0)) << "on another channel it is another one";
}

TEST_F(Seal, ASignatureOfAnotherMessageOrChannelIsNone) {
  pmg_msgs::ack_t ack{};
  ack.robot = "z1";
  const io::Bytes bytes = keyed_.prove("ACK", ack);
  const auto proven = decode_sealed<pmg_msgs::ack_t, pmg_msgs::proof_t>(bytes);
  EXPECT_TRUE(anna_.believe("ACK", proven->message_bytes, proven->seal, 0));
  EXPECT_FALSE(anna_.believe("STATUS", proven->message_bytes, proven->seal, 0));
  Bytestring changed(proven->message_bytes.begin(), proven->message_bytes.end());
  changed.back() = static_cast<std::uint8_t>(changed.back() ^ 1u);
  EXPECT_FALSE(anna_.believe("ACK", changed, proven->seal, 0));
  auto boot = *proven->seal;
  ++boot.boot;
  EXPECT_FALSE(anna_.believe("ACK", proven->message_bytes, boot, 0));
}

TEST_F(Seal, AControllerKnowsItsOwnKey) {
  ControllerSeal twin(keys_), other(keys_with("anna", secret_));
  const pmg_msgs::ack_t ack{};
  const auto ours = [&](ControllerSeal& sender) {
    const auto proven = decode_sealed<pmg_msgs::ack_t, pmg_msgs::proof_t>(sender.prove("ACK", ack));
    return keyed_.ours("ACK", proven->message_bytes, proven->seal);
  };
  EXPECT_TRUE(ours(twin));
  EXPECT_FALSE(ours(other));
}

TEST_F(Seal, FlippedBytesEndNothing) {
  const Bytestring good = sealed_command(keyed_, anna_, kSecond_ns);
  std::mt19937 random(31);
  std::uniform_int_distribution<std::size_t> position(8, good.size() - 1);
  std::uniform_int_distribution<std::size_t> pick(0, 4), size(0, good.size());
  for (int k = 0; k < 20'000; ++k) {
    Bytestring bytes = good;
    for (int flips = 0; flips < 3; ++flips) {
      bytes[position(random)] = std::array<std::uint8_t, 5>{0, 1, 0x7f, 0x80, 0xff}[pick(random)];
    }
    if (k % 4 == 0) bytes.resize(size(random));
    judge(keyed_, bytes, kSecond_ns);
  }
}

/// RFC 4231, test case 2's scheme with a key of 32 bytes; computed with Python's hmac.
TEST(Authentication, CodesAreHmacSha256) {
  Secret secret{};
  for (std::size_t i = 0; i < secret.size(); ++i) secret[i] = static_cast<std::uint8_t>(i);
  const std::string text = "what do ya want for nothing?";
  const Code code = code_of(secret, Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  EXPECT_EQ(code[0], 0x9);
  EXPECT_EQ(code[31], 0x6a);
}

/// FIPS 180-4's example of one block.
TEST(Authentication, DigestsAreSha256) {
  const std::string text = "abc";
  const Digest digest = digest_of(Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  EXPECT_EQ(digest[0], 0xba);
  EXPECT_EQ(digest[31], 0xad);
}

/// RFC 8032, section 7.1, test 1.
TEST(Authentication, SignaturesAreEd25519) {
  constexpr PrivateKey kKey = {0x9d, 0x61, 0xb1, 0x9d, 0xef, 0xfd, 0x5a, 0x60, 0xba, 0x84, 0x4a,
                               0xf4, 0x92, 0xec, 0x2c, 0xc4, 0x44, 0x49, 0xc5, 0x69, 0x7b, 0x32,
                               0x69, 0x19, 0x70, 0x3b, 0xac, 0x03, 0x1c, 0xae, 0x7f, 0x60};
  const Signer signer(kKey);
  EXPECT_EQ(signer.public_key()[0], 0xd7);
  EXPECT_EQ(signer.public_key()[31], 0x1a);
  const Signature signature = signer.sign({});
  EXPECT_EQ(signature[0], 0xe5);
  EXPECT_EQ(signature[63], 0x0b);
  EXPECT_TRUE(verified(signer.public_key(), {}, signature));
}

}  // namespace
}  // namespace pmg::seal
