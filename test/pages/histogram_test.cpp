#include "pages/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace pmg::pages {
namespace {

TEST(Histogram, CountsAddUpToTheNumberOfValues) {
  const std::uint32_t seed = 3;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(10.0, 5.0);
  std::vector<double> values(5000);
  for (double& value : values) value = normal(random);
  values.insert(values.end(), {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, -1e300, 0.0, 20.0});
  const Bins bins = count(values, 0.0, 20.0, 40);
  EXPECT_EQ(bins.total(), static_cast<std::int64_t>(values.size()));
  EXPECT_EQ(bins.not_finite, 2);
  EXPECT_GT(bins.below, 50);
  EXPECT_GT(bins.above, 50);
  const auto inside = std::ranges::count_if(values, [](double v) { return v >= 0.0 && v <= 20.0; });
  EXPECT_EQ(std::accumulate(bins.counts.begin(), bins.counts.end(), std::int64_t{0}), inside);
}

TEST(Histogram, PutsAValueIntoItsBin) {
  const std::vector<double> values = {0.0, 0.5, 1.0, 1.5, 2.0};
  const Bins bins = count(values, 0.0, 2.0, 2);
  EXPECT_EQ(bins.counts, (std::vector<std::int64_t>{2, 3})) << "the last bin holds its upper edge";
}

TEST(Histogram, HoldsOneValueAndNone) {
  EXPECT_EQ(count(std::vector<double>{4.0}, 4.0, 4.0, 10).total(), 1);
  EXPECT_EQ(count({}, 0.0, 1.0, 10).total(), 0);
}

TEST(Percentile, IsANearestRank) {
  std::vector<double> values(100);
  std::iota(values.rbegin(), values.rend(), 1.0);
  EXPECT_EQ(percentile(values, 0.5), 50.0);
  EXPECT_EQ(percentile(values, 0.99), 99.0);
  EXPECT_EQ(percentile(values, 1.0), 100.0);
  EXPECT_EQ(percentile({}, 0.5), 0.0);
}

}  // namespace
}  // namespace pmg::pages
