// The keys in a terminal's bytes; above all, which bytes are Escape.
#include "keyboard/terminal_keys.hpp"

#include <gtest/gtest.h>

#include <random>

namespace pmg::ops {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
using Keys = std::vector<TerminalKey>;

const TerminalKey kEscape{.name = "escape"};

TEST(TerminalKeys, LettersAndTheirCapitals) {
  TerminalKeys keys;
  EXPECT_EQ(keys.take("wW \r\x7f#1\x03", 0), (Keys{{"w"}, {"w", true}, {"space"}, {"enter"}, {"backspace"}}));
}

TEST(TerminalKeys, ArrowsInBothOfTheirWaysAndWithShift) {
  TerminalKeys keys;
  EXPECT_EQ(keys.take("\x1b[A\x1bOB\x1b[1;2D\x1b[C", 0), (Keys{{"up"}, {"down"}, {"left", true}, {"right"}}));
  EXPECT_TRUE(keys.wait(1000 * kMillisecond_ns).empty());
}

TEST(TerminalKeys, AnEscapeIsToldAfterItsTimeAndOnce) {
  TerminalKeys keys;
  EXPECT_TRUE(keys.take("\x1b", 0).empty());
  EXPECT_TRUE(keys.wait(TerminalKeys::kEscape_ns - 1).empty());
  EXPECT_EQ(keys.wait(TerminalKeys::kEscape_ns), Keys{kEscape});
  EXPECT_TRUE(keys.wait(10'000 * kMillisecond_ns).empty());
}

TEST(TerminalKeys, WhateverFollowsAnEscapeItIsNotLost) {
  TerminalKeys keys;
  EXPECT_EQ(keys.take("\x1bw", 0), (Keys{kEscape, {"w"}})) << "typed at once, or Alt and w";
  EXPECT_EQ(keys.take("\x1b\x1b", 1), Keys{kEscape});
  EXPECT_EQ(keys.wait(100 * kMillisecond_ns), Keys{kEscape}) << "the second one";
  EXPECT_EQ(keys.take("\x1b\x1b[A", 200 * kMillisecond_ns), (Keys{kEscape, {"up"}}));
  keys.take("\x1b", 300 * kMillisecond_ns);
  EXPECT_EQ(keys.take("[A", 400 * kMillisecond_ns).front(), kEscape) << "too late for an arrow";
}

TEST(TerminalKeys, AnArrowThatComesInPiecesIsNoEscape) {
  TerminalKeys keys;
  EXPECT_TRUE(keys.take("\x1b", 0).empty());
  EXPECT_TRUE(keys.take("[", 20 * kMillisecond_ns).empty());
  EXPECT_TRUE(keys.wait(200 * kMillisecond_ns).empty());
  EXPECT_EQ(keys.take("A", 300 * kMillisecond_ns), Keys{{"up"}});
}

TEST(TerminalKeys, SequencesOfOtherKeysAreDroppedWhole) {
  TerminalKeys keys;
  EXPECT_EQ(keys.take("\x1b[15~\x1b[200~\x1b[I\x1bOPw", 0), Keys{{"w"}});
  EXPECT_TRUE(keys.take("\x1b[9999", 1).empty());
  EXPECT_EQ(keys.take("w", 1000 * kMillisecond_ns), Keys{{"w"}}) << "one that never ends is forgotten";
}

/// Random bytes in random pieces: an Escape alone, in a pause, is always recognised.
TEST(TerminalKeys, NoGarbageSwallowsAnEscape) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  TerminalKeys keys;
  std::int64_t now_ns = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string garbage;
    for (auto k = random() % 12; k > 0; --k) garbage += static_cast<char>(random() % 4 == 0 ? '\x1b' : random() % 256);
    keys.take(garbage, now_ns);
    now_ns += static_cast<std::int64_t>(random() % 60) * kMillisecond_ns;
    keys.take("\x1b", now_ns);
    now_ns += TerminalKeys::kEscape_ns;
    EXPECT_EQ(keys.wait(now_ns), Keys{kEscape}) << "seed " << seed << ", round " << round;
  }
}

}  // namespace
}  // namespace pmg::ops
