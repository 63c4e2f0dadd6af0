// LcmAssembler: whole messages of wanted channels, and no datagram that reads or writes outside its bounds.
#include "io/lcm_assembler.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "generator_core/allocation_count.hpp"

namespace pmg::io {
namespace {

using Datagram = std::vector<std::uint8_t>;

void put(Datagram& bytes, std::uint32_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}
void put(Datagram& bytes, const std::string& text) { bytes.insert(bytes.end(), text.begin(), text.end()); }

Datagram short_message(const std::string& channel, const std::string& payload) {
  Datagram bytes;
  put(bytes, 0x4c433032, 4);
  put(bytes, 1, 4);
  put(bytes, channel + '\0' + payload);
  return bytes;
}

struct Fragment {
  std::uint32_t number = 7, size = 6, offset = 0;
  std::uint32_t index = 0, count = 2;
  std::string rest;  ///< channel and payload, or payload
};
Datagram fragment(const Fragment& parts) {
  Datagram bytes;
  put(bytes, 0x4c433033, 4);
  put(bytes, parts.number, 4);
  put(bytes, parts.size, 4);
  put(bytes, parts.offset, 4);
  put(bytes, parts.index, 2);
  put(bytes, parts.count, 2);
  put(bytes, parts.rest);
  return bytes;
}
const std::string kChannel = std::string("STATUS") + '\0';

class Assembler : public testing::Test {
 protected:
  Assembler() { assembler_.want("STATUS"); }
  /// The payload of the message that this datagram completes; "-": none. The datagram lies at the end of a heap block,
  /// so that the address sanitizer sees a read behind it.
  std::string take(const Datagram& datagram, std::uint64_t sender = 1) {
    const Datagram exact(datagram);
    const auto message = assembler_.take(sender, exact);
    if (!message) return "-";
    return {message->payload.begin(), message->payload.end()};
  }
  LcmAssembler assembler_;
};

TEST_F(Assembler, TakesShortMessagesOfWantedChannels) {
  EXPECT_EQ(assembler_.want("ACK"), 1u);
  EXPECT_EQ(take(short_message("STATUS", "abc")), "abc");
  EXPECT_EQ(take(short_message("STATUS", "")), "");
  EXPECT_EQ(assembler_.take(1, short_message("ACK", "x"))->channel, 1u);
  EXPECT_EQ(take(short_message("STATE", "abc")), "-");
  EXPECT_EQ(take(short_message("STATU", "abc")), "-");
  EXPECT_EQ(take(short_message("STATUSES", "abc")), "-");
  EXPECT_EQ(assembler_.counts().messages, 3);
  EXPECT_EQ(assembler_.counts().unwanted, 3);
}

TEST_F(Assembler, JoinsTheFragmentsOfSeveralSenders) {
  EXPECT_EQ(take(fragment({.rest = kChannel + "abcd"}), 1), "-");
  EXPECT_EQ(take(fragment({.rest = kChannel + "ABC"}), 2), "-");
  EXPECT_EQ(take(fragment({.offset = 4, .index = 1, .rest = "ef"}), 1), "abcdef");
  EXPECT_EQ(take(fragment({.offset = 3, .index = 1, .rest = "DEF"}), 2), "ABCDEF");
  EXPECT_EQ(assembler_.counts().messages, 2);
  EXPECT_EQ(assembler_.counts().incomplete, 0);
}

TEST_F(Assembler, TheTwoDatagramsThatEndedLiblcmAreMalformed) {
  take(fragment({.size = 1000, .count = 3, .rest = kChannel + "abcd"}));
  EXPECT_EQ(take(fragment({.size = 1000, .offset = 0xFFFFFF00, .index = 1, .count = 3, .rest = std::string(300, 'x')})),
            "-");
  EXPECT_EQ(assembler_.counts().malformed, 1);
  EXPECT_EQ(take(fragment({.size = 100, .rest = std::string(10, 'A')})), "-") << "a channel without its zero byte";
  EXPECT_EQ(take(fragment({.size = 100, .rest = std::string(100, 'A') + '\0'})), "-") << "a channel that is too long";
  EXPECT_EQ(take(fragment({.size = 100, .rest = ""})), "-");
  EXPECT_EQ(assembler_.counts().malformed, 4);
}

TEST_F(Assembler, AMessageWhoseNumbersContradictEachOtherIsDropped) {
  const Fragment good{.offset = 4, .index = 1, .rest = "ef"};
  const auto dropped = [&](Fragment second) {
    take(fragment({.rest = kChannel + "abcd"}));
    EXPECT_EQ(take(fragment(second)), "-");
    EXPECT_EQ(take(fragment(good)), "-") << "it may not come back";
  };
  Fragment wrong = good;
  dropped((wrong.offset = 3, wrong));
  wrong = good;
  dropped((wrong.offset = 5, wrong));
  wrong = good;
  dropped((wrong.size = 7, wrong));
  wrong = good;
  dropped((wrong.size = 5, wrong));
  wrong = good;
  dropped((wrong.count = 3, wrong));
  wrong = good;
  dropped((wrong.rest = "efg", wrong));
  wrong = good;
  dropped((wrong.rest = "e", wrong));
  EXPECT_EQ(assembler_.counts().malformed, 6) << "all but the last, which is only too short";
  EXPECT_EQ(assembler_.counts().incomplete, 7);
  EXPECT_EQ(assembler_.counts().messages, 0);
}

TEST_F(Assembler, AFragmentThatReachesBehindTheMessagesMemoryIsMalformed) {
  const std::string part(60'000, 'x');
  const auto size = static_cast<std::uint32_t>(LcmAssembler::kLargestMessage);
  for (std::uint32_t k = 0; k < 5; ++k) {  // 4 x 60,000 bytes fit, the fifth part does not
    const std::string rest = k == 0 ? kChannel + part : part;
    EXPECT_EQ(take(fragment({.size = size, .offset = 60'000 * k, .index = k, .count = 6, .rest = rest})), "-");
  }
  EXPECT_EQ(assembler_.counts().malformed, 1);
}

TEST_F(Assembler, AFragmentThatTheNetworkDuplicatesLosesNothing) {
  const std::vector<Datagram> parts = {fragment({.size = 9, .count = 3, .rest = kChannel + "abc"}),
                                       fragment({.size = 9, .offset = 3, .index = 1, .count = 3, .rest = "def"}),
                                       fragment({.size = 9, .offset = 6, .index = 2, .count = 3, .rest = "ghi"})};
  for (const auto& order : {std::vector{0, 0, 1, 0, 1, 2}, std::vector{0, 1, 1, 0, 2}}) {
    std::string got = "-";
    for (const int part : order) got = take(parts[static_cast<std::size_t>(part)]);
    EXPECT_EQ(got, "abcdefghi");
    EXPECT_EQ(take(parts[2]), "-") << "once";
  }
  EXPECT_EQ(assembler_.counts().messages, 2);
  EXPECT_EQ(assembler_.counts().malformed, 0);
}

TEST_F(Assembler, AFragmentThatContradictsAnEarlierOneOrLacksItsBeginningCompletesNothing) {
  EXPECT_EQ(take(fragment({.offset = 4, .index = 1, .rest = "ef"})), "-");
  take(fragment({.size = 9, .count = 3, .rest = kChannel + "abc"}));
  take(fragment({.size = 9, .offset = 3, .index = 1, .count = 3, .rest = "def"}));
  EXPECT_EQ(take(fragment({.size = 9, .offset = 3, .index = 1, .count = 3, .rest = "dEf"})), "-");
  EXPECT_EQ(take(fragment({.size = 9, .offset = 6, .index = 2, .count = 3, .rest = "ghi"})), "-");
  EXPECT_EQ(take(fragment({.index = 2, .count = 2, .rest = "ghi"})), "-");
  EXPECT_EQ(take(fragment({.count = 0, .rest = kChannel + "abcdef"})), "-");
}

TEST_F(Assembler, ASendersNextMessageReplacesItsUnfinishedOne) {
  take(fragment({.number = 1, .rest = kChannel + "abcd"}));
  take(fragment({.number = 2, .rest = kChannel + "ABCD"}));
  EXPECT_EQ(take(fragment({.number = 1, .offset = 4, .index = 1, .rest = "ef"})), "-");
  EXPECT_EQ(take(fragment({.number = 2, .offset = 4, .index = 1, .rest = "EF"})), "ABCDEF");
}

TEST_F(Assembler, ThousandsOfUnfinishedMessagesTakeNoMoreMemoryThanFour) {
  static_assert(LcmAssembler::kPlaces == 4 && LcmAssembler::kLargestMessage == 256 * 1024, "docs/reference/network.md");
  const Datagram begin = fragment({.size = LcmAssembler::kLargestMessage, .count = 9, .rest = kChannel + "abcd"});
  const long allocations = test::allocation_count();
  for (std::uint64_t sender = 0; sender < 10'000; ++sender) assembler_.take(sender, begin);
  EXPECT_EQ(test::allocation_count(), allocations) << "a datagram allocates nothing";
  for (std::uint64_t sender = 0; sender < 10'000; ++sender) {
    EXPECT_EQ(take(fragment({.size = LcmAssembler::kLargestMessage, .count = 9, .rest = kChannel + "abcd"}), sender),
              "-");
  }
  EXPECT_EQ(assembler_.counts().incomplete, 20'000 - static_cast<std::int64_t>(LcmAssembler::kPlaces));
  EXPECT_EQ(take(fragment({.size = LcmAssembler::kLargestMessage + 1, .rest = kChannel})), "-");
  EXPECT_EQ(take(fragment({.size = 0xFFFFFFFF, .rest = kChannel})), "-");
  EXPECT_EQ(take(fragment({.rest = kChannel + "abcd"}), 1), "-");
  EXPECT_EQ(take(fragment({.offset = 4, .index = 1, .rest = "ef"}), 1), "abcdef")
      << "and honest ones still get a place";
}

TEST_F(Assembler, LargestMessageArrivesWhole) {
  std::string payload(LcmAssembler::kLargestMessage, 'x');
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<char>(i % 251);
  constexpr std::size_t kPart = 60'000;
  const std::size_t count = (payload.size() + kPart - 1) / kPart;
  std::string got = "-";
  for (std::size_t k = 0; k < count; ++k) {
    const std::string part = payload.substr(k * kPart, kPart);
    got = take(fragment({.size = static_cast<std::uint32_t>(payload.size()),
                         .offset = static_cast<std::uint32_t>(k * kPart),
                         .index = static_cast<std::uint32_t>(k),
                         .count = static_cast<std::uint32_t>(count),
                         .rest = k == 0 ? kChannel + part : part}));
  }
  EXPECT_EQ(got, payload);
}

/// Mutations of good datagrams: what a message holds must come from its datagrams.
TEST_F(Assembler, MutatedDatagramsEndNothing) {
  const std::vector<Datagram> corpus = {
      short_message("STATUS", "abc"), fragment({.rest = kChannel + "abcd"}),
      fragment({.offset = 4, .index = 1, .rest = "ef"}),
      fragment({.size = 70'000, .count = 2, .rest = kChannel + std::string(60'000, 'x')}),
      fragment({.size = 70'000, .offset = 60'000, .index = 1, .count = 2, .rest = std::string(10'000, 'y')})};
  SCOPED_TRACE("seed 21");
  std::mt19937 random(21);
  const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
  constexpr std::array<std::uint8_t, 6> kBytes = {0, 1, 0x7f, 0x80, 0xfe, 0xff};
  std::int64_t datagrams = 0;
  for (; datagrams < 200'000; ++datagrams) {
    Datagram datagram = corpus[below(10) < 9 ? below(3) : below(corpus.size())];
    for (std::size_t flips = below(4); flips > 0 && !datagram.empty(); --flips) {
      datagram[below(std::min<std::size_t>(datagram.size(), 40))] = kBytes[below(kBytes.size())];
    }
    if (below(4) == 0) datagram.resize(below(datagram.size() + 1));
    const auto message = assembler_.take(below(6), datagram);
    if (message) {
      ASSERT_EQ(message->channel, 0u);
      ASSERT_LE(message->payload.size(), LcmAssembler::kLargestMessage);
    }
  }
  const LcmAssembler::Counts& counts = assembler_.counts();
  EXPECT_GT(counts.messages, 1000);
  EXPECT_GT(counts.malformed, 1000);
  EXPECT_GT(counts.incomplete, 1000);
}

}  // namespace
}  // namespace pmg::io
