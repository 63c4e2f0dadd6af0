#include "gco/slip_statistics.hpp"

#include <gtest/gtest.h>

#include "generator_core/allocation_count.hpp"

namespace pmg::gco {
namespace {

Reference supported_by(bool left, bool right) {
  Reference reference;
  reference.contact = {left, right};
  reference.gain = 0.5;
  return reference;
}

FootSlip slip(double before_m_s, double after_m_s, double height_m) {
  return {.before_m_s = before_m_s, .after_m_s = after_m_s, .yaw_rate_after_rad_s = 0.0, .height_m = height_m};
}

TEST(SlipStatistics, OfNothingAreZero) {
  const SlipSummary summary = SlipStatistics().summary();
  EXPECT_EQ(summary.before_mean_m_s, 0.0);
  EXPECT_EQ(summary.double_support_p95_m_s, 0.0);
}

TEST(SlipStatistics, SplitTheSupportPhases) {
  SlipStatistics statistics;
  Result result;
  result.foot = {slip(0.3, 1e-6, 1e-5), slip(9.0, 9.0, 9.0)};  // the swing foot counts nowhere
  statistics.add(supported_by(true, false), result);
  result.foot = {slip(9.0, 9.0, 9.0), slip(0.1, 3e-6, -2e-5)};
  statistics.add(supported_by(false, true), result);
  result.foot = {slip(0.2, 0.010, 4e-4), slip(0.4, 0.030, 5e-3)};
  statistics.add(supported_by(true, true), result);
  result.foot = {slip(9.0, 9.0, 9.0), slip(9.0, 9.0, 9.0)};
  statistics.add(supported_by(false, false), result);
  const SlipSummary summary = statistics.summary();
  EXPECT_NEAR(summary.before_mean_m_s, (0.3 + 0.1 + 0.2 + 0.4) / 4, 1e-15);
  EXPECT_NEAR(summary.after_mean_m_s, (1e-6 + 3e-6 + 0.010 + 0.030) / 4, 1e-15);
  EXPECT_EQ(summary.single_support_max_m_s, 3e-6);
  EXPECT_NEAR(summary.double_support_mean_m_s, 0.020, 1e-15);
  EXPECT_EQ(summary.double_support_p95_m_s, 0.030);
  EXPECT_EQ(summary.lower_foot_height_max_m, 4e-4);
  EXPECT_EQ(summary.other_foot_height_max_m, 5e-3);
  EXPECT_EQ(summary.single_support_ticks, 2);
  EXPECT_EQ(summary.double_support_ticks, 1);
}

TEST(SlipStatistics, AreNotDilutedByStanding) {
  SlipStatistics statistics;
  Result result;
  result.foot = {slip(0.4, 0.02, 2e-4), slip(0.4, 0.02, 3e-3)};
  statistics.add(supported_by(true, true), result);
  Reference standing = supported_by(true, true);
  standing.gain = 0.0;
  result.foot = {slip(0.0, 0.0, 5e-4), slip(0.0, 0.0, 6e-3)};
  for (int i = 0; i < 99; ++i) statistics.add(standing, result);
  const SlipSummary summary = statistics.summary();
  EXPECT_NEAR(summary.double_support_mean_m_s, 0.02, 1e-15);
  EXPECT_NEAR(summary.before_mean_m_s, 0.4, 1e-15);
  EXPECT_EQ(summary.lower_foot_height_max_m, 5e-4) << "heights count in every tick";
  EXPECT_EQ(summary.other_foot_height_max_m, 6e-3);
}

TEST(SlipStatistics, FindTheLowerFootWhicheverItIs) {
  SlipStatistics statistics;
  Result result;
  result.foot = {slip(0.0, 0.0, 7e-3), slip(0.0, 0.0, -6e-4)};
  statistics.add(supported_by(true, true), result);
  EXPECT_EQ(statistics.summary().lower_foot_height_max_m, 6e-4);
  EXPECT_EQ(statistics.summary().other_foot_height_max_m, 7e-3);
}

TEST(SlipStatistics, PercentileIsTheNearestRankToATenthOfAMillimetreASecond) {
  SlipStatistics statistics;
  Result result;
  for (int i = 1; i <= 100; ++i) {  // 200 samples, 1 .. 100 mm/s, each twice: the 190th is 95 mm/s
    result.foot = {slip(0.0, 1e-3 * i - 5e-5, 0.0), slip(0.0, 1e-3 * i - 5e-5, 0.0)};
    statistics.add(supported_by(true, true), result);
  }
  EXPECT_NEAR(statistics.summary().double_support_p95_m_s, 0.095, 1.01e-4);
  SlipStatistics fast;
  result.foot = {slip(0.0, 5.0, 0.0), slip(0.0, 7.0, 0.0)};
  fast.add(supported_by(true, true), result);
  EXPECT_EQ(fast.summary().double_support_p95_m_s, 7.0);  // beyond the histogram: the largest seen
}

TEST(SlipStatistics, LeaveOutTicksThatDidNotConverge) {
  SlipStatistics statistics;
  Result result;
  result.status = Status::kNotConverged;
  result.foot = {slip(9.0, 9.0, 9.0), slip(9.0, 9.0, 9.0)};
  statistics.add(supported_by(true, true), result);
  EXPECT_EQ(statistics.summary().before_mean_m_s, 0.0);
  EXPECT_EQ(statistics.summary().double_support_ticks, 0);
  EXPECT_EQ(statistics.summary().not_converged_ticks, 1);
}

TEST(SlipStatistics, AddTakesNothingFromTheHeap) {
  SlipStatistics statistics;
  Result result;
  const Reference reference = supported_by(true, true);
  const long before = test::allocation_count();
  for (int i = 0; i < 1000; ++i) {
    result.foot[kLeft].after_m_s = 0.01 * i;
    statistics.add(reference, result);
  }
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace pmg::gco
