// Frames of the bus cycle: what comes back is taken only if it is the answer to what went out.
#include "ethercat/datagrams.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace pmg::ethercat {
namespace {

std::vector<std::uint8_t> two_datagrams(std::uint8_t index) {
  FrameWriter frame(index);
  const std::array<std::uint8_t, 5> data = {1, 2, 3, 4, 5};
  EXPECT_TRUE(frame.add(Command::kLogicalRead, 0x12345678, data));
  EXPECT_TRUE(frame.add(Command::kBroadcastRead, std::uint32_t{kAlStatus} << 16U, std::span(data).first(2)));
  return {frame.bytes().begin(), frame.bytes().end()};
}

TEST(Datagrams, LieInTheFrameAsETG1000Says) {
  const std::vector<std::uint8_t> frame = two_datagrams(7);
  ASSERT_EQ(frame.size(), 14u + 2 + 12 + 5 + 12 + 2);
  EXPECT_EQ(frame[12], 0x88);
  EXPECT_EQ(frame[13], 0xA4);
  EXPECT_EQ(frame[14] | frame[15] << 8, 0x1000 | (12 + 5 + 12 + 2)) << "length, type 1";
  EXPECT_EQ(frame[16], 10);
  EXPECT_EQ(frame[17], 7);
  EXPECT_EQ(frame[18] | frame[19] << 8 | frame[20] << 16 | frame[21] << 24, 0x12345678);
  EXPECT_EQ(frame[22] | frame[23] << 8, 5 | 0x8000) << "another datagram follows";
  EXPECT_EQ(frame[33], 7);
  EXPECT_EQ(frame[33 + 6] | frame[33 + 7] << 8, 2) << "the last";
}

TEST(Datagrams, AFrameWithoutRoomTakesNoMore) {
  FrameWriter frame(1);
  const std::vector<std::uint8_t> most(kMostFrame - 16 - 12, 1);
  EXPECT_FALSE(frame.add(Command::kLogicalWrite, 0, std::vector<std::uint8_t>(most.size() + 1, 1)));
  EXPECT_TRUE(frame.add(Command::kLogicalWrite, 0, most));
  EXPECT_FALSE(frame.add(Command::kLogicalWrite, 0, {}));
}

TEST(Datagrams, OnlyTheAnswerToWhatWasSentIsRead) {
  const std::vector<std::uint8_t> sent = two_datagrams(7);
  std::vector<std::uint8_t> back = sent;
  back[16 + 10] = 99;
  back[16 + 15] = 3;  // working counter
  back.resize(60);    // a network card's fill
  FrameReader reader(back, sent);
  Datagram datagram;
  ASSERT_TRUE(reader.next(datagram));
  EXPECT_EQ(datagram.data[0], 99);
  EXPECT_EQ(datagram.working_counter, 3);
  EXPECT_TRUE(reader.next(datagram));
  EXPECT_FALSE(reader.next(datagram));
  EXPECT_FALSE(FrameReader(two_datagrams(6), sent).valid()) << "an older frame";
  for (const std::size_t at : {12UL, 14UL, 16UL, 17UL, 22UL, 23UL}) {
    std::vector<std::uint8_t> other = sent;
    other[at] ^= 0x01U;
    EXPECT_FALSE(FrameReader(other, sent).valid()) << at;
  }
  EXPECT_FALSE(FrameReader(std::span(sent).first(sent.size() - 1), sent).valid());
}

TEST(Datagrams, NoBytesLeadReadingOutOfTheFrame) {
  std::mt19937_64 random(1);
  const std::vector<std::uint8_t> sent = two_datagrams(7);
  for (int run = 0; run < 20'000; ++run) {
    std::vector<std::uint8_t> back = sent;
    back.resize(random() % 80);
    for (int k = static_cast<int>(random() % 4); k > 0 && !back.empty(); --k)
      back[random() % back.size()] = static_cast<std::uint8_t>(random());
    FrameReader reader(back, sent);
    Datagram datagram;
    for (int count = 0; reader.next(datagram); ++count) {
      ASSERT_LT(count, 2);
      ASSERT_GE(datagram.data.data(), back.data());
      ASSERT_LE(datagram.data.data() + datagram.data.size(), back.data() + back.size());
    }
  }
}

}  // namespace
}  // namespace pmg::ethercat
