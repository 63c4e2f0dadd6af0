#include "io/transit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>

namespace pmg::io {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(TransitTest, AMessageIsAsLateAsItIsBehindTheFastest) {
  Transit transit;
  EXPECT_EQ(transit.take(1000 * kMs, 90 * kMs), 0);
  EXPECT_NEAR(static_cast<double>(transit.take(1010 * kMs, 130 * kMs)), 30.0 * kMs, 0.1 * kMs);
  EXPECT_EQ(transit.take(1020 * kMs, 105 * kMs), 0) << "a faster one is the new measure";
  EXPECT_NEAR(static_cast<double>(transit.take(1030 * kMs, 135 * kMs)), 20.0 * kMs, 0.1 * kMs);
}

TEST(TransitTest, ALookChangesNothing) {
  Transit transit;
  EXPECT_EQ(transit.look(0, 50 * kMs), 0) << "nothing to compare it with";
  transit.take(0, 50 * kMs);
  EXPECT_EQ(transit.look(1000 * kMs, 0), 0) << "a refused one that claims to be fast";
  EXPECT_EQ(transit.take(10 * kMs, 60 * kMs), 0);
  EXPECT_NEAR(static_cast<double>(transit.look(10 * kMs, 90 * kMs)), 30.0 * kMs, 0.1 * kMs);
  EXPECT_EQ(transit.take(20 * kMs, 70 * kMs), 0);
}

TEST(TransitTest, ClocksThatDriftApartMakeNothingLate) {
  Transit transit;
  for (std::int64_t k = 0; k < 3600 * 30; ++k) {  // an hour
    const std::int64_t now_ns = k * 33 * kMs;
    EXPECT_LT(transit.take(now_ns - now_ns / 2000, now_ns), kMs) << "half a millisecond a second";
  }
}

TEST(TransitTest, AMillisecondASecondIsForgottenAndNoMore) {
  Transit transit;
  transit.take(0, 0);
  EXPECT_EQ(transit.look(0, 1000 * kMs), 999 * kMs);
  EXPECT_EQ(transit.look(100'000 * kMs, 100'200 * kMs), 200 * kMs - 100'200 * kMs / 1000);
}

TEST(TransitTest, OneReceivedBeforeAnotherTurnsNoTimeBack) {
  Transit transit;
  transit.take(1000 * kMs, 1000 * kMs);
  EXPECT_EQ(transit.take(900 * kMs, 910 * kMs), 10 * kMs);
  EXPECT_EQ(transit.look(1000 * kMs, 1010 * kMs), 10 * kMs - 10 * kMs / 1000);
}

TEST(TransitTest, StampsMayBeAnything) {
  constexpr std::array kEnds = {std::numeric_limits<std::int64_t>::min(), std::int64_t{0},
                                std::numeric_limits<std::int64_t>::max()};
  for (const std::int64_t first : kEnds)
    for (const std::int64_t second : kEnds) {
      Transit transit;
      EXPECT_EQ(transit.take(first, 0), 0);
      EXPECT_EQ(transit.look(second, 0) > 0, second < first) << first << " " << second;
      EXPECT_GE(transit.take(second, kMs), 0);
      EXPECT_GE(transit.look(first, 2 * kMs), 0);
    }
}

}  // namespace
}  // namespace pmg::io
