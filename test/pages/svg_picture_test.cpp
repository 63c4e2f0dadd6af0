// Bars, plots and histograms are read back from the SVG by its own ticks: the picture shows the given values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "drawn_svg.hpp"
#include "pages/axis.hpp"
#include "pages/bar_picture.hpp"
#include "pages/histogram_picture.hpp"
#include "pages/plot_picture.hpp"
#include "picture_data.hpp"

namespace pmg::pages {
namespace {

constexpr double kDigit = 0.11;     // coordinates have one decimal: half of it at a tick and half at the read value
constexpr double kCharacter = 6.9;  // largest mean width among browsers' fonts at 12 px
constexpr double kPictureWidth = 640.0;  // of every picture, in its own units

using testing::SizeIs;

std::vector<double> shown_values(const std::vector<double>& values) {
  std::vector<double> shown;
  std::ranges::copy_if(values, std::back_inserter(shown), can_be_shown);
  return shown;
}

/// Texts of one row of labels must not run into each other.
void expect_apart(const DrawnAxis& axis) {
  for (std::size_t i = 1; i < axis.at.size(); ++i) {
    const double room = axis.at[i] - axis.at[i - 1];
    EXPECT_GT(room, 0.5 * kCharacter * static_cast<double>(axis.labels[i].size() + axis.labels[i - 1].size()))
        << axis.labels[i - 1] << " runs into " << axis.labels[i];
  }
}

DrawnAxis x_axis(const std::vector<DrawnElement>& elements) {
  DrawnAxis axis;
  for (const DrawnElement& e : elements) {
    if (e.tag == "text" && e.is("tick")) axis.add(e.number("x"), e.text);
  }
  return axis;
}

/// The labels beside the grid lines: their baselines are four units lower.
DrawnAxis y_axis(const std::vector<DrawnElement>& elements) {
  DrawnAxis axis;
  for (const DrawnElement& e : elements) {
    if (e.tag != "text" || !e.is("name") || !label_value(e.text)) continue;
    axis.add(e.number("y") - 4.0, e.text);
    EXPECT_GE(e.number("x") - kCharacter * static_cast<double>(e.text.size()), 0.0) << e.text << " is cut off";
  }
  return axis;
}

class PicturesOf : public testing::TestWithParam<PictureData> {};

TEST_P(PicturesOf, BarsReachTheirValuesFromZero) {
  const std::vector<double>& values = GetParam().values;
  Bars bars{.title = "bars", .unit = "rad", .names = {}, .sets = {{"set", values}}};
  for (std::size_t i = 0; i < values.size(); ++i) bars.names.push_back("row" + std::to_string(i));
  const auto elements = drawn_elements(svg(bars));
  const DrawnAxis axis = x_axis(elements);
  axis.expect_sound(kDigit);
  expect_apart(axis);
  const double unit = std::abs(axis.per_unit());
  std::vector<double> read;
  for (const DrawnElement& e : elements) {
    if (e.tag != "rect" || !e.is("bar")) continue;
    const double left = axis(e.number("x")), right = axis(e.number("x") + e.number("width"));
    EXPECT_NEAR(std::abs(left) < std::abs(right) ? left : right, 0.0, 3.0 * kDigit * unit) << "bars begin at zero";
    EXPECT_GE(e.number("x"), 0.0);
    EXPECT_LE(e.number("x") + e.number("width"), kPictureWidth);
    read.push_back(std::abs(left) < std::abs(right) ? right : left);
  }
  const std::vector<double> shown = shown_values(values);
  ASSERT_THAT(read, SizeIs(shown.size())) << "one bar a value";
  for (std::size_t i = 0; i < shown.size(); ++i) EXPECT_NEAR(read[i], shown[i], 3.0 * kDigit * unit);
}

TEST_P(PicturesOf, BarsTellTheirValuesBesideThem) {
  const std::vector<double>& values = GetParam().values;
  Bars bars{.title = "bars",
            .unit = "rad",
            .names = std::vector<std::string>(values.size(), "row"),
            .sets = {{"set", values}}};
  std::vector<double> told;
  for (const DrawnElement& e : drawn_elements(svg(bars))) {
    if (e.tag != "text" || !e.is("value")) continue;
    told.push_back(*label_value(e.text));
    const double width = kCharacter * static_cast<double>(e.text.size());
    EXPECT_GE(e.number("x") - (e.is("name") ? width : 0.0), 0.0) << e.text << " is cut off";
    EXPECT_LE(e.number("x") + (e.is("name") ? 0.0 : width), kPictureWidth) << e.text << " is cut off";
  }
  const std::vector<double> shown = shown_values(values);
  ASSERT_THAT(told, SizeIs(shown.size()));
  for (std::size_t i = 0; i < shown.size(); ++i)  // four significant digits
    EXPECT_NEAR(told[i], shown[i], 5.1e-4 * std::abs(shown[i]));
}

TEST_P(PicturesOf, WhiskersReachTheirEnds) {
  const std::vector<double>& values = GetParam().values;
  Bars bars{
      .title = "bars", .unit = "", .names = std::vector<std::string>(values.size(), "row"), .sets = {{"set", values}}};
  for (const double value : values) bars.sets[0].intervals.push_back({value - 0.5 * std::abs(value), 1.5 * value});
  const auto elements = drawn_elements(svg(bars));
  const DrawnAxis axis = x_axis(elements);
  std::vector<std::pair<double, double>> read;
  for (const DrawnElement& e : elements) {
    if (!e.is("whisker")) continue;
    const auto line = pen_stops(e.attributes.at("d")).front();
    read.emplace_back(axis(line.front().first), axis(line.back().first));
  }
  std::size_t k = 0;
  for (const Interval& interval : bars.sets[0].intervals) {
    if (!can_be_shown(interval.lower) || !can_be_shown(interval.upper)) continue;
    ASSERT_LT(k, read.size());
    EXPECT_NEAR(read[k].first, interval.lower, 3.0 * kDigit * std::abs(axis.per_unit()));
    EXPECT_NEAR(read[k++].second, interval.upper, 3.0 * kDigit * std::abs(axis.per_unit()));
  }
  EXPECT_EQ(k, read.size());
}

/// A line's points in the picture: stretches between gaps, and dots for single points.
void expect_plot_shows(const std::vector<double>& x_values, const std::vector<double>& values, bool zero) {
  Plot plot{.title = "plot", .x_name = "x", .lines = {{.name = "line", .x = x_values, .y = values}}, .show_zero = zero};
  const auto elements = drawn_elements(svg(plot));
  const DrawnAxis x = x_axis(elements), y = y_axis(elements);
  x.expect_sound(kDigit);
  y.expect_sound(kDigit);
  expect_apart(x);
  std::vector<std::pair<double, double>> read;
  for (const DrawnElement& e : elements) {
    if (e.tag == "circle") read.emplace_back(x(e.number("cx")), y(e.number("cy")));
    if (!e.is("line")) continue;
    for (const auto& stretch : pen_stops(e.attributes.at("d"))) {
      if (stretch.size() < 2) continue;  // invisible: must be a dot
      for (const auto& [px, py] : stretch) read.emplace_back(x(px), y(py));
    }
  }
  std::ranges::sort(read);
  std::size_t k = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!can_be_shown(values[i]) || !can_be_shown(x_values[i])) continue;
    ASSERT_LT(k, read.size()) << "a point is missing";
    EXPECT_NEAR(read[k].first, x_values[i], 3.0 * kDigit * std::abs(x.per_unit()));
    EXPECT_NEAR(read[k++].second, values[i], 3.0 * kDigit * std::abs(y.per_unit()));
  }
  EXPECT_EQ(k, read.size()) << "more is drawn than was given";
}

TEST_P(PicturesOf, PlotsShowTheirPointsByTheirAxes) {
  const std::vector<double>& values = GetParam().values;
  std::vector<double> x(values.size());
  std::iota(x.begin(), x.end(), 0.0);
  expect_plot_shows(x, values, false);
  expect_plot_shows(x, values, true);
  std::vector<double> along = values;  // the same along x, where NaN is not allowed
  std::ranges::sort(along, [](double a, double b) { return a < b; });
  if (std::ranges::all_of(values, can_be_shown)) {
    along.erase(std::unique(along.begin(), along.end()), along.end());
    expect_plot_shows(along, std::vector<double>(along.begin(), along.end()), false);
  }
}

TEST_P(PicturesOf, HistogramsCountWhereTheValuesAre) {
  const std::vector<double>& values = GetParam().values;
  const std::string drawn = svg(Histogram{.title = "histogram", .unit = "us", .sets = {{"set", values}}});
  const auto elements = drawn_elements(drawn);
  const DrawnAxis x = x_axis(elements), y = y_axis(elements);
  x.expect_sound(kDigit);
  expect_apart(x);
  // The extent and height of each bin in the picture.
  for (const DrawnElement& e : elements) {
    if (!e.is("bins")) continue;
    const auto outline = pen_stops(e.attributes.at("d")).front();
    const double bottom = outline.front().second;
    std::vector<std::pair<double, double>> occupied;
    for (std::size_t k = 1; k < outline.size(); ++k) {
      if (outline[k].second < bottom - 1.0 && outline[k].first > outline[k - 1].first)
        occupied.emplace_back(x(outline[k - 1].first), x(outline[k].first));
    }
    const double slack = 3.0 * kDigit * std::abs(x.per_unit());
    const std::vector<double> shown = shown_values(values);
    for (const double value : shown) {
      EXPECT_TRUE(std::ranges::any_of(
          occupied, [&](const auto& bin) { return value >= bin.first - slack && value <= bin.second + slack; }))
          << value << " has no bin";
    }
    for (const auto& [from, to] : occupied) {
      EXPECT_TRUE(
          std::ranges::any_of(shown, [&](double value) { return value >= from - slack && value <= to + slack; }))
          << "a bin from " << from << " to " << to << " holds nothing";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, PicturesOf, testing::ValuesIn(picture_data()), [](const auto& data) {
  std::string name = data.param.name;
  std::erase(name, ' ');
  return name;
});

TEST(SvgPictures, KeepLabelsApartThatThreeDigitsWouldMerge) {
  for (const auto& [from, to] : std::vector<std::pair<double, double>>{
           {1.068, 1.072}, {-1.0001, -0.9999}, {99.96, 100.04}, {1e-7, 1.003e-7}, {123456.0, 123457.0}}) {
    const auto ticks = axis_ticks({from, to}, 6);
    ASSERT_GE(ticks.size(), 3U);
    for (const AxisTick& tick : ticks) EXPECT_NEAR(*label_value(tick.label), tick.value, 1e-9 * std::abs(to));
  }
}

TEST(SvgPictures, LogarithmicAxesHaveTicksOverAnyRange) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {1e-9, 1e9}, {0.5, 200.0}, {2.0, 3.0}, {4.0, 4.0}, {3e-12, 8e-12}, {1e-200, 1e200}}) {
    const std::vector<double> values = {low, high}, x = {0.0, 1.0};
    const auto elements = drawn_elements(
        svg(Plot{.title = "", .x_name = "", .lines = {{.name = "", .x = x, .y = values}}, .logarithmic_y = true}));
    const DrawnAxis y = y_axis(elements);
    ASSERT_GE(y.at.size(), 2U) << low << " to " << high;
    for (const std::string& label : y.labels) EXPECT_EQ(std::ranges::count(y.labels, label), 1) << label;
    // Places are linear in the logarithm.
    const double per_decade = (y.at.back() - y.at.front()) / std::log10(y.value.back() / y.value.front());
    for (std::size_t i = 0; i < y.at.size(); ++i) {
      const double expected = y.at.front() + per_decade * std::log10(y.value[i] / y.value.front());
      EXPECT_NEAR(y.at[i], expected, 3.0 * kDigit) << y.labels[i];
    }
  }
}

TEST(SvgPictures, LegendsAndNamesStayInside) {
  Plot plot{.title = "", .x_name = "", .lines = {}};
  Bars bars{.title = "", .unit = "", .names = {std::string(80, 'n')}, .sets = {}};
  const std::vector<double> x = {0.0, 1.0};
  for (int i = 0; i < 9; ++i) {
    plot.lines.push_back({.name = "a line with a long name", .x = x, .y = x});
    bars.sets.push_back({.name = "a set with a long name", .values = {1.0}});
  }
  for (const std::string& picture : {svg(plot), svg(bars)}) {
    std::vector<std::pair<double, double>> taken;  // by row: the extents of its texts
    for (const DrawnElement& e : drawn_elements(picture)) {
      if (!e.is("entry")) continue;
      const double width = kCharacter * static_cast<double>(e.text.size());
      EXPECT_LE(e.number("x") + width, kPictureWidth);
      for (const auto& [row, end] : taken) EXPECT_TRUE(row != e.number("y") || end < e.number("x")) << "overlap";
      taken.emplace_back(e.number("y"), e.number("x") + width);
    }
    EXPECT_THAT(taken, SizeIs(9));
  }
}

TEST(SvgPictures, MarksStandAtTheirValues) {
  const std::vector<double> x = {0.0, 10.0};
  const auto elements = drawn_elements(svg(
      Plot{.title = "", .x_name = "", .lines = {{.name = "", .x = x, .y = x}}, .marks = {{12.5, "beyond the data"}}}));
  const DrawnAxis axis = x_axis(elements);
  const auto words = std::ranges::find(elements, "beyond the data", &DrawnElement::text);
  ASSERT_NE(words, elements.end());
  const auto line = pen_stops(std::prev(words)->attributes.at("d")).front();
  EXPECT_NEAR(axis(line.front().first), 12.5, 3.0 * kDigit * std::abs(axis.per_unit()));
  EXPECT_LE(words->number("x"), kPictureWidth);
}

TEST(SvgPictures, WordsOfCloseMarksStandAboveEachOther) {
  const Bars bars{.title = "",
                  .unit = "m",
                  .names = {"row"},
                  .sets = {{"set", {0.4}}},
                  .marks = {{0.03, "limit 0.03"}, {0.028, "perfect follower"}, {0.035, "doing nothing"}}};
  const auto elements = drawn_elements(svg(bars));
  const DrawnAxis axis = x_axis(elements);
  std::vector<const DrawnElement*> words;
  for (const DrawnElement& e : elements) {
    if (e.is("mark")) words.push_back(&e);
  }
  ASSERT_THAT(words, SizeIs(3));
  const std::vector<double> in_order = {0.028, 0.03, 0.035};
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto line = pen_stops((words[i] - 1)->attributes.at("d")).front();
    EXPECT_NEAR(axis(line.front().first), in_order[i], 3.0 * kDigit * std::abs(axis.per_unit()));
    for (std::size_t k = 0; k < i; ++k) {
      const double room = std::abs(words[i]->number("x") - words[k]->number("x"));
      const double needed = 0.5 * kCharacter * static_cast<double>(words[i]->text.size() + words[k]->text.size());
      EXPECT_TRUE(words[i]->number("y") != words[k]->number("y") || room > needed)
          << words[i]->text << " covers " << words[k]->text;
    }
  }
}

}  // namespace
}  // namespace pmg::pages
