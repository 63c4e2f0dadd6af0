#include "operator/transit.hpp"

#include <gtest/gtest.h>

namespace pmg::ops {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(TransitTest, AMessageIsAsLateAsItIsBehindTheFastest) {
  Transit transit;
  EXPECT_EQ(transit.take(1000 * kMs, 90 * kMs), 0);
  EXPECT_NEAR(static_cast<double>(transit.take(1010 * kMs, 130 * kMs)), 30.0 * kMs, 0.1 * kMs);
  EXPECT_EQ(transit.take(1020 * kMs, 105 * kMs), 0) << "a faster one is the new measure";
  EXPECT_NEAR(static_cast<double>(transit.take(1030 * kMs, 135 * kMs)), 20.0 * kMs, 0.1 * kMs);
}

TEST(TransitTest, ClocksThatDriftApartMakeNothingLate) {
  Transit transit;
  for (std::int64_t k = 0; k < 3600 * 30; ++k) {  // an hour
    const std::int64_t now_ns = k * 33 * kMs;
    EXPECT_LT(transit.take(now_ns - now_ns / 2000, now_ns), kMs) << "half a millisecond a second";
  }
}

}  // namespace
}  // namespace pmg::ops
