#include "evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace pmg::evaluation {
namespace {

// For 1, 2, 3, 4: mean 2.5, standard deviation 1.290994, standard error 0.645497. Student's 97.5 % quantile for 3
// degrees of freedom is 3.182446, so the half width is 2.054260.
TEST(Statistics, MeanHasStudentsInterval) {
  const Estimate e = mean_interval(std::array{1.0, 2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(e.mean, 2.5);
  EXPECT_NEAR(e.lower, 2.5 - 2.054260, 1e-5);
  EXPECT_NEAR(e.upper, 2.5 + 2.054260, 1e-5);
  EXPECT_TRUE(e.excludes_zero());
}

TEST(Statistics, OneSampleHasNoIntervalAndNoneNoMean) {
  const Estimate one = mean_interval(std::array{3.0});
  EXPECT_EQ(one.mean, 3.0);
  EXPECT_TRUE(std::isnan(one.lower) && std::isnan(one.upper));
  EXPECT_FALSE(one.excludes_zero());
  EXPECT_TRUE(std::isnan(mean_interval({}).mean));
}

// Differences -1, -2, -3: mean -2, standard error 0.577350, quantile for 2 degrees of freedom 4.302653, half width
// 2.484138. The samples themselves scatter far more than their differences.
TEST(Statistics, PairsAreComparedOneByOne) {
  const Estimate e = paired_difference(std::array{10.0, 20.0, 30.0}, std::array{11.0, 22.0, 33.0});
  EXPECT_DOUBLE_EQ(e.mean, -2.0);
  EXPECT_NEAR(e.lower, -2.0 - 2.484138, 1e-5);
  EXPECT_NEAR(e.upper, -2.0 + 2.484138, 1e-5);
  EXPECT_FALSE(e.excludes_zero());
  EXPECT_THROW(paired_difference(std::array{1.0}, std::array{1.0, 2.0}), std::invalid_argument);
}

TEST(Statistics, EqualPairsDontExcludeZero) {
  const Estimate e = paired_difference(std::array{1.0, 2.0}, std::array{1.0, 2.0});
  EXPECT_EQ(e.mean, 0.0);
  EXPECT_FALSE(e.excludes_zero());
}

// Wilson's interval of 8 in 10, by hand: centre (0.8 + 3.841459 / 20) / 1.3841459 = 0.716740, half width
// 1.959964 sqrt(0.016 + 0.0096036) / 1.3841459 = 0.226574.
TEST(Statistics, SharesHaveWilsonsInterval) {
  const Estimate e = share_interval(8, 10);
  EXPECT_DOUBLE_EQ(e.mean, 0.8);
  EXPECT_NEAR(e.lower, 0.490162, 1e-5);
  EXPECT_NEAR(e.upper, 0.943318, 1e-5);
}

TEST(Statistics, SharesAtTheEndsKeepAnInterval) {
  const Estimate none = share_interval(0, 10), all = share_interval(200, 200);
  EXPECT_EQ(none.lower, 0.0);
  EXPECT_NEAR(none.upper, 0.277533, 1e-5);  // z^2 / (n + z^2)
  EXPECT_EQ(all.upper, 1.0);
  EXPECT_NEAR(all.lower, 200.0 / (200.0 + 3.841459), 1e-5);
  EXPECT_TRUE(std::isnan(share_interval(0, 0).mean));
}

TEST(Statistics, AMeanIsWrittenWithHalfOfItsIntervalAndAloneWithoutOne) {
  EXPECT_EQ(mean_with_interval({.mean = 0.064, .lower = 0.0589, .upper = 0.0691}), "0.0640 +-0.0051");
  EXPECT_EQ(mean_with_interval(mean_interval(std::array{0.5})), "0.5000");
}

TEST(Statistics, AShareIsWrittenWithItsIntervalAndWithoutTrialsAsADash) {
  EXPECT_EQ(percent_with_interval(share_interval(8, 10)), "80 [49, 94]");
  EXPECT_EQ(percent_with_interval(share_interval(0, 0)), "-");
}

}  // namespace
}  // namespace pmg::evaluation
