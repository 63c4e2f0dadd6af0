#include "imu/mti_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

namespace pmg::imu {
namespace {

using testing::ElementsAre;

MtiSample sample() {
  MtiSample made;
  made.orientation_WI = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  made.gyro_rad_s = {0.1, -0.2, 3.0};
  made.acceleration_m_s2 = {0.5, -9.0, 2.0};
  made.counter = 65535;
  return made;
}

std::vector<std::uint8_t> message(const MtiSample& of = sample()) {
  return mti_message(MtiId::kData, encode_mti_sample(of));
}

/// Everything that the framer finds in these bytes, handed over in pieces of this size.
std::vector<MtiSample> found(const std::vector<std::uint8_t>& bytes, MtiFramer& framer, std::size_t piece = 64) {
  std::vector<MtiSample> samples;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    framer.hear(Bytes(bytes).subspan(at, std::min(piece, bytes.size() - at)));
    while (const auto heard = framer.next()) {
      if (const auto decoded = decode_mti_sample(heard->data)) samples.push_back(*decoded);
    }
  }
  return samples;
}

TEST(MtiMessage, IsThatOfTheManual) {
  EXPECT_THAT(mti_message(MtiId::kGoToConfig), ElementsAre(0xFA, 0xFF, 0x30, 0x00, 0xD1));
  EXPECT_THAT(mti_message(MtiId{0xD0}), ElementsAre(0xFA, 0xFF, 0xD0, 0x00, 0x31)) << "the manual's own example";
}

TEST(MtiMessage, ASampleComesThroughInAnyPieces) {
  for (std::size_t piece = 1; piece < 80; ++piece) {
    MtiFramer framer;
    const std::vector<MtiSample> samples = found(message(), framer, piece);
    ASSERT_EQ(samples.size(), 1u) << piece;
    EXPECT_NEAR(samples[0].orientation_WI.angularDistance(sample().orientation_WI), 0.0, 1e-6);
    EXPECT_TRUE(samples[0].gyro_rad_s.isApprox(sample().gyro_rad_s, 1e-6)) << "32-bit floats";
    EXPECT_TRUE(samples[0].acceleration_m_s2.isApprox(sample().acceleration_m_s2, 1e-6));
    EXPECT_EQ(samples[0].counter, 65535);
    EXPECT_TRUE(samples[0].certain);
    EXPECT_EQ(framer.skipped_bytes() + framer.checksum_errors(), 0u);
  }
}

TEST(MtiMessage, EveryChangedBitOfTheSumIsACountedChecksumError) {
  const std::vector<std::uint8_t> whole = message();
  for (std::size_t at = 4; at < whole.size(); ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      std::vector<std::uint8_t> damaged = whole;
      damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 1U << bit);
      MtiFramer framer;
      EXPECT_TRUE(found(damaged, framer).empty()) << at;
      EXPECT_GE(framer.checksum_errors(), 1u);
    }
  }
}

TEST(MtiMessage, AfterGarbageTheFirstWholeMessageIsTaken) {
  std::mt19937 random(3);
  for (int round = 0; round < 500; ++round) {
    std::vector<std::uint8_t> bytes(random() % 300);
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(random() % 4 == 0 ? 0xFA : random() % 4 == 0 ? 0xFF : random());
    const std::vector<std::uint8_t> whole = message();
    // A false head may claim 254 bytes: so many more make it decided.
    for (int k = 0; k < 8; ++k) bytes.insert(bytes.end(), whole.begin(), whole.end());
    MtiFramer framer;
    EXPECT_GE(found(bytes, framer).size(), 4u) << round;
  }
}

TEST(MtiMessage, AHeadWithinAMessageThatWasCutHidesNoLaterOne) {
  std::vector<std::uint8_t> bytes = message();
  bytes.resize(bytes.size() / 2);
  const std::vector<std::uint8_t> whole = message();
  bytes.insert(bytes.end(), whole.begin(), whole.end());
  MtiFramer framer;
  EXPECT_EQ(found(bytes, framer).size(), 1u);
  EXPECT_EQ(framer.checksum_errors(), 1u);
  EXPECT_EQ(framer.skipped_bytes(), whole.size() / 2);
}

TEST(MtiMessage, ValuesThatCantBeAreNotBelieved) {
  const auto believed = [](const MtiSample& of) { return decode_mti_sample(encode_mti_sample(of)).has_value(); };
  EXPECT_TRUE(believed(sample()));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  for (const double wrong : {kNan, kInfinite, 2000.0}) {
    MtiSample spoilt = sample();
    spoilt.gyro_rad_s.y() = wrong;
    EXPECT_FALSE(believed(spoilt)) << wrong;
    spoilt = sample();
    spoilt.acceleration_m_s2.x() = wrong;
    EXPECT_FALSE(believed(spoilt)) << wrong;
    spoilt = sample();
    spoilt.orientation_WI.x() = wrong;
    EXPECT_FALSE(believed(spoilt)) << wrong;
  }
  MtiSample short_q = sample();
  short_q.orientation_WI.coeffs() *= 0.98;
  EXPECT_FALSE(believed(short_q));
  std::vector<std::uint8_t> data = encode_mti_sample(sample());
  for (std::size_t size = 0; size < data.size() - 7; ++size)  // without the status word it is whole
    EXPECT_FALSE(decode_mti_sample(Bytes(data).first(size))) << size;
}

TEST(MtiMessage, TheDevicesDoubtIsRead) {
  MtiSample doubtful = sample();
  doubtful.certain = false;
  EXPECT_FALSE(decode_mti_sample(encode_mti_sample(doubtful))->certain);
  std::vector<std::uint8_t> data = encode_mti_sample(sample());
  data[data.size() - 2] = 1;  // bit 8: the accelerometer clips
  EXPECT_FALSE(decode_mti_sample(data)->certain);
}

// Seeded; under AddressSanitizer every byte read beyond the end is seen, as each input has an allocation of its own
// size.
TEST(MtiMessage, AnyBytesAreTakenWithoutHarmAndNothingWrongIsBelieved) {
  std::mt19937 random(11);
  for (int round = 0; round < 20'000; ++round) {
    std::vector<std::uint8_t> bytes = round % 2 == 0 ? message() : encode_mti_sample(sample());
    for (unsigned k = 0; k < 1 + random() % 6; ++k)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes.resize(random() % (bytes.size() + 1));
    const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[bytes.size()]);
    std::ranges::copy(bytes, exact.get());
    const Bytes input(exact.get(), bytes.size());
    if (const auto decoded = decode_mti_sample(input)) {
      EXPECT_NEAR(decoded->orientation_WI.norm(), 1.0, 1e-9);
      EXPECT_LE(decoded->gyro_rad_s.norm(), 100.0);
      EXPECT_LE(decoded->acceleration_m_s2.norm(), 1000.0);
    }
    MtiFramer framer;
    framer.hear(input);
    while (framer.next()) {
    }
    const std::vector<std::uint8_t> whole = message();
    std::size_t after = 0;
    for (int k = 0; k < 6; ++k) after += found(whole, framer).size();
    EXPECT_GE(after, 1u) << "it finds its way back";
  }
}

}  // namespace
}  // namespace pmg::imu
