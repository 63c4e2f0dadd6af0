// The statistics of a thread's punctuality are correct.
#include "runtime/cycle_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pmg::runtime {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(TimeHistogram, PercentilesAreAtMostOneBucketAboveTheTrueOnes) {
  std::mt19937_64 random(11);
  std::lognormal_distribution<double> times_ns(11.0, 2.0);  // median 60 us, from below 1 us to seconds
  TimeHistogram histogram;
  std::vector<std::int64_t> all;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(static_cast<std::int64_t>(times_ns(random)));
    histogram.add(all.back());
  }
  std::ranges::sort(all);
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(all.size())));
    const double exact_us = static_cast<double>(all[rank - 1]) * 1e-3;
    EXPECT_GE(histogram.percentile_us(share), exact_us) << share;
    EXPECT_LE(histogram.percentile_us(share), exact_us * (1.0 + 1.0 / 16.0) + 0.001) << share;  // a bucket's width
  }
  EXPECT_DOUBLE_EQ(histogram.percentile_us(1.0), static_cast<double>(all.back()) * 1e-3);
}

TEST(TimeHistogram, TakesWhateverAClockCanSay) {
  TimeHistogram histogram;
  EXPECT_EQ(histogram.percentile_us(0.5), 0.0);
  for (const std::int64_t time_ns : {std::int64_t{-5}, std::int64_t{0}, std::int64_t{1} << 62}) histogram.add(time_ns);
  EXPECT_EQ(histogram.count(), 3);
  EXPECT_EQ(histogram.percentile_us(0.5), 0.0);
}

TEST(CycleStatistics, ALateHostIsListedApartFromALateController) {
  CycleStatistics statistics(10 * kMs);
  statistics.add({.planned_ns = 0, .woke_ns = 50'000, .done_ns = 1 * kMs, .missed = 0});
  statistics.add({.planned_ns = 10 * kMs, .woke_ns = 13 * kMs, .done_ns = 14 * kMs, .missed = 0});  // late by the host
  statistics.add({.planned_ns = 20 * kMs, .woke_ns = 20 * kMs, .done_ns = 33 * kMs, .missed = 0});  // overran, so
  statistics.add({.planned_ns = 30 * kMs, .woke_ns = 33 * kMs, .done_ns = 34 * kMs, .missed = 0});  // it waited
  EXPECT_EQ(statistics.cycles(), 4);
  EXPECT_EQ(statistics.overruns(), 1);
  ASSERT_EQ(statistics.delayed().size(), 1u);
  EXPECT_EQ(statistics.delayed()[0].planned_ns, 10 * kMs);
  EXPECT_EQ(statistics.delayed()[0].late_ns, 3 * kMs);
}

TEST(CycleStatistics, CountsDelaysThatItNoLongerLists) {
  CycleStatistics statistics(kMs);
  const std::int64_t many = static_cast<std::int64_t>(CycleStatistics::kDelayedKept) + 10;
  for (std::int64_t k = 0; k < many; ++k) {
    statistics.add({.planned_ns = 10 * k * kMs, .woke_ns = (10 * k + 5) * kMs, .done_ns = (10 * k + 6) * kMs});
  }
  EXPECT_EQ(statistics.delayed_count(), many);
  EXPECT_EQ(statistics.delayed().size(), CycleStatistics::kDelayedKept);
}

}  // namespace
}  // namespace pmg::runtime
