// No recorded STATUS is news.
#include "seal/status_order.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pmg::seal {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// The controller's clock is 5 s behind ours.
class StatusOrderTest : public testing::Test {
 protected:
  bool hear(std::int64_t boot, std::int64_t said_ms, std::int64_t now_ms) {
    return order_.take(boot, said_ms * kMillisecond_ns, (now_ms + 5000) * kMillisecond_ns);
  }
  StatusOrder order_;
};

TEST_F(StatusOrderTest, EachIsNewsOnceAndAnOvertakenOneIsNone) {
  EXPECT_TRUE(hear(1, 20, 21));
  EXPECT_FALSE(hear(1, 20, 22));
  EXPECT_FALSE(hear(1, 10, 22));
  EXPECT_TRUE(hear(1, 30, 31));
}

TEST_F(StatusOrderTest, WhatWaitedForHalfASecondIsNone) {
  EXPECT_TRUE(hear(1, 0, 1));
  EXPECT_TRUE(hear(1, 100, 600)) << "slow";
  EXPECT_FALSE(hear(1, 110, 1000)) << "played back, slower and slower";
  EXPECT_FALSE(hear(1, 110, 9000)) << "although nothing else was heard";
  EXPECT_TRUE(hear(1, 9000, 9001));
}

TEST_F(StatusOrderTest, ClocksThatDriftApartMakeNoneLate) {
  for (int second = 0; second < 3600; ++second) {
    ASSERT_TRUE(order_.take(1, second * 1'000'000'000LL, second * 1'001'000'000LL)) << second;
  }
}

TEST_F(StatusOrderTest, AnotherStartIsHeardOnlyWhenThisOneIsSilent) {
  EXPECT_TRUE(hear(1, 1000, 1000));
  EXPECT_FALSE(hear(2, 5000, 1001));
  EXPECT_FALSE(hear(2, 5010, 1300));
  EXPECT_TRUE(hear(2, 10, 1301)) << "it was started anew, with a clock of its own";
  EXPECT_FALSE(hear(1, 2000, 1400));
  EXPECT_FALSE(hear(1, 1000, 9000)) << "what the first start said is over";
  EXPECT_FALSE(hear(1, 999, 9000));
}

TEST_F(StatusOrderTest, OneRecordingThatIsRepeatedHoldsNobodyOffForLongerThanItSpeaks) {
  EXPECT_TRUE(hear(7, 50'000, 0)) << "a recording, before anything else is heard";
  int heard = 0;
  for (int now_ms = 10; now_ms <= 1000; now_ms += 10) {
    EXPECT_FALSE(hear(7, 50'000, now_ms));
    heard += hear(8, now_ms, now_ms) ? 1 : 0;
  }
  EXPECT_EQ(heard, 70) << "from 0.3 s on";
}

TEST_F(StatusOrderTest, StampsMayBeAnything) {
  constexpr auto kLowest = std::numeric_limits<std::int64_t>::min(),
                 kHighest = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t stamp_ns : {kHighest, kLowest, std::int64_t{0}, kHighest}) {
    StatusOrder order;
    EXPECT_TRUE(order.take(1, stamp_ns, 0));
    order.take(1, kHighest, 1);
    order.take(2, kLowest, kMillisecond_ns * 1000);
  }
}

}  // namespace
}  // namespace pmg::seal
