#include "pages/line_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

namespace pmg::pages {
namespace {

using testing::Each;
using testing::Le;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<double> times(std::size_t count, double step_s = 0.01) {
  std::vector<double> x(count);
  for (std::size_t i = 0; i < count; ++i) x[i] = step_s * static_cast<double>(i);
  return x;
}

std::vector<double> decode(const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  std::vector<double> values;
  double steps = 0.0;
  for (const auto& delta : json["v"]) {
    if (!delta.is_null()) steps += delta.get<double>();
    values.push_back(delta.is_null() ? kNan : json["o"].get<double>() + json["s"].get<double>() * steps);
  }
  return values;
}

TEST(Decimate, KeepsEveryPeakOfEveryLine) {
  const std::uint32_t seed = 7;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise;
  const std::vector<double> x = times(20000);
  std::vector<double> a(x.size()), b(x.size());
  for (double& value : a) value = noise(random);
  b[12345] = 1000.0;  // one sample up, one down
  b[777] = -1000.0;
  constexpr std::size_t kColumns = 100;
  const LineData data = decimate(x, {a, b}, kColumns, kNever);
  EXPECT_LE(data.x.size(), 2 * kColumns);
  EXPECT_TRUE(std::ranges::is_sorted(data.x));
  EXPECT_EQ(std::ranges::max(data.y[1]), 1000.0);
  EXPECT_EQ(std::ranges::min(data.y[1]), -1000.0);
  // Column by column, 200 samples each: the noisy line's extremes are among its two points.
  for (std::size_t column = 0; column < kColumns; ++column) {
    const auto from = a.begin() + static_cast<std::ptrdiff_t>(200 * column);
    const auto [low, high] = std::minmax_element(from, from + 190);  // the border may lie in the neighbour
    EXPECT_LE(std::min(data.y[0][2 * column], data.y[0][2 * column + 1]), *low) << column;
    EXPECT_GE(std::max(data.y[0][2 * column], data.y[0][2 * column + 1]), *high) << column;
  }
}

TEST(Decimate, KeepsTheOrderInWhichExtremesCame) {
  std::vector<double> rising = times(1000), falling = rising;
  std::ranges::reverse(falling);
  const LineData data = decimate(times(1000), {rising, falling}, 10, kNever);
  EXPECT_TRUE(std::ranges::is_sorted(data.y[0]));
  EXPECT_TRUE(std::ranges::is_sorted(data.y[1], std::greater{}));
}

TEST(Decimate, LeavesAShortRecordingAsItIs) {
  const std::vector<double> x = times(50), y = {x.rbegin(), x.rend()};
  const LineData data = decimate(x, {y}, 100, kNever);
  EXPECT_EQ(data.x, x);
  EXPECT_EQ(data.y[0], y);
}

TEST(Decimate, DrawsNoLineOverAGap) {
  for (const std::size_t columns : {2U, 1000U}) {
    const std::vector<double> x = {0.0, 0.01, 0.02, 5.0, 5.01}, y(5, 1.0);
    const LineData data = decimate(x, {y}, columns, 0.1);
    EXPECT_EQ(std::ranges::count_if(data.y[0], [](double value) { return std::isnan(value); }), 1) << columns;
  }
}

TEST(Decimate, SurvivesWhatIsNoNumberAndNoRecordingAtAll) {
  const std::vector<double> x = times(1000), y(1000, kNan);
  EXPECT_TRUE(std::isnan(decimate(x, {y}, 10, kNever).y[0].front()));
  EXPECT_TRUE(decimate({}, {{}}, 10, kNever).x.empty());
  const std::vector<double> still(1000, 3.0);
  EXPECT_EQ(decimate(still, {x}, 10, kNever).x.size(), 2U) << "x stands still: one column";
}

TEST(Decimate, RefusesXThatDecreases) {
  const std::vector<double> x = {0.0, 2.0, 1.0};
  EXPECT_THROW(decimate(x, {x}, 10, kNever), std::invalid_argument);
  EXPECT_THROW(decimate(x, {{}}, 10, kNever), std::invalid_argument);
}

TEST(DeltaJson, KeepsValuesToTheStepAndGapsAsGaps) {
  const std::vector<double> values = {1e6 + 0.1, 1e6 - 0.3, kNan, 1e6 + 0.7, 1e6};
  const std::vector<double> back = decode(delta_json(values, 1000.0));
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      EXPECT_TRUE(std::isnan(back[i]));
    } else {
      EXPECT_NEAR(back[i], values[i], 0.5 * 1.0 / 1000.0 + 1e-9);  // half a step, and a double's last bits at 1e6
    }
  }
}

TEST(DeltaJson, IsValidForEveryKindOfDouble) {
  const double large = std::numeric_limits<double>::max();
  for (const std::vector<double>& values :
       std::vector<std::vector<double>>{{},
                                        {kNan},
                                        {large, -large, 1.0},
                                        {-kNever, kNever},
                                        {std::numeric_limits<double>::denorm_min(), 0.0},
                                        {5.0, 5.0},
                                        {1e299, -1e299},
                                        {1e15, std::nextafter(1e15, 2e15)}}) {
    EXPECT_EQ(decode(delta_json(values, 1000.0)).size(), values.size());
  }
}

}  // namespace
}  // namespace pmg::pages
