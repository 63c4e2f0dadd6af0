#include "io/mailbox.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace pmg {
namespace {

TEST(Mailbox, EmptyGivesNothingAndLeavesTheValueAlone) {
  io::Mailbox<int> mailbox;
  int value = 7;
  EXPECT_FALSE(mailbox.take(value));
  EXPECT_EQ(value, 7);
}

TEST(Mailbox, ReaderGetsTheNewestOnce) {
  io::Mailbox<int> mailbox;
  mailbox.put(1);
  mailbox.put(2);
  mailbox.put(3);
  int value = 0;
  EXPECT_TRUE(mailbox.take(value));
  EXPECT_EQ(value, 3);
  EXPECT_FALSE(mailbox.take(value));
  mailbox.put(4);
  EXPECT_TRUE(mailbox.take(value));
  EXPECT_EQ(value, 4);
}

// Larger than a cache line, so that a half-written value would show.
struct Wide {
  std::array<std::uint64_t, 64> words{};
};

TEST(Mailbox, ValuesAreWholeAndNeverOlderThanTheLast) {
  constexpr std::uint64_t kLast = 200'000;
  io::Mailbox<Wide> mailbox;
  std::thread writer([&] {
    Wide wide;
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      wide.words.fill(i);
      mailbox.put(wide);
    }
  });
  std::uint64_t torn = 0, backwards = 0, last = 0;
  Wide wide;
  while (last < kLast) {
    if (!mailbox.take(wide)) continue;
    for (const std::uint64_t word : wide.words) torn += word != wide.words[0] ? 1u : 0u;
    backwards += wide.words[0] <= last ? 1u : 0u;
    last = wide.words[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
}

}  // namespace
}  // namespace pmg
