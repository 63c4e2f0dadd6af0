// Charts and lanes are read back from the canvas of a real browser: the pixels of a line, and the words of the axes at
// their places. The drawing library itself is not asked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "browser.hpp"
#include "drawn_svg.hpp"
#include "pages/axis.hpp"
#include "picture_data.hpp"

namespace pmg::pages {
namespace {

constexpr double kPixel = 4.0;  // pixels of the canvas per pixel of the page
/// Drawings are aligned to the canvas' pixels, and so are the ticks by which the test reads them.
constexpr double kAligned = 2.5;
constexpr std::size_t kRepeats = 12;  // of each value: makes a plateau wide enough to read

/// Shows every chart, and records every written word with its place on the canvas.
const std::string kBefore = R"js(
  window.IntersectionObserver = class {
    constructor(tell) { this.tell = tell; }
    observe(target) { setTimeout(() => this.tell([{target, isIntersecting: true}]), 0); }
    unobserve() {}
  };
  const write = CanvasRenderingContext2D.prototype.fillText, clear = CanvasRenderingContext2D.prototype.clearRect;
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
    const at = this.getTransform().transformPoint({x, y});
    (this.canvas.words ??= []).push({text, x: at.x, y: at.y, align: this.textAlign});
    return write.apply(this, arguments);
  };
  CanvasRenderingContext2D.prototype.clearRect = function () {
    this.canvas.words = [];
    return clear.apply(this, arguments);
  };
)js";

/// For each chart: its words, and the lowest and highest pixel of colour #0072b2 in every column.
const std::string kAfter = R"js(
  setTimeout(() => {
    const found = [];
    for (const place of document.querySelectorAll('.chart')) {
      const canvas = place.querySelector('canvas');
      if (!canvas) { found.push(null); continue; }
      const {width, height} = canvas, pixels = canvas.getContext('2d').getImageData(0, 0, width, height).data;
      const columns = [];
      for (let x = 0; x < width; ++x) {
        let top = null, bottom = null;
        for (let y = 0; y < height; ++y) {
          const i = 4 * (x + y * width);
          const apart = Math.abs(pixels[i]) + Math.abs(pixels[i + 1] - 0x72) + Math.abs(pixels[i + 2] - 0xb2);
          if (pixels[i + 3] < 128 || apart > 60) continue;
          top ??= y;
          bottom = y;
        }
        columns.push(top === null ? null : [top, bottom]);
      }
      found.push({words: canvas.words, columns, width, height});
    }
    const out = document.createElement('pre');
    out.id = 'found';
    out.textContent = JSON.stringify(found);
    document.body.append(out);
  }, 2000);
)js";

nlohmann::json drawn_charts(const Page& page, const std::string& browser) {
  return found_in_browser(browser, page.html(), kBefore, kAfter);
}

struct DrawnChart {
  DrawnAxis x, y;
  const nlohmann::json& columns;
};

/// Labels of y end beside the axis, those of x are centred below it; x has its unit.
DrawnChart read_axes(const nlohmann::json& chart, const std::string& x_unit) {
  DrawnChart drawn{{}, {}, chart["columns"]};
  for (const auto& word : chart["words"]) {
    std::string text = word["text"];
    if (word["align"] == "right") drawn.y.add(word["y"], text);
    if (word["align"] != "center") continue;
    if (text.ends_with(" " + x_unit)) text.resize(text.size() - x_unit.size() - 1);
    drawn.x.add(word["x"], text);
  }
  return drawn;
}

/// Each value becomes a plateau.
struct Plateaus {
  std::vector<double> x, y;
};
Plateaus plateaus(const std::vector<double>& values, double x_step) {
  Plateaus line;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < kRepeats; ++k) {
      line.x.push_back(x_step * static_cast<double>(i * kRepeats + k));
      line.y.push_back(values[i]);
    }
  }
  return line;
}

void expect_labels_apart(const DrawnAxis& axis, std::size_t unit_characters) {
  for (std::size_t i = 1; i < axis.at.size(); ++i) {
    const auto characters = axis.labels[i].size() + axis.labels[i - 1].size() + 2 * unit_characters;
    EXPECT_GT(axis.at[i] - axis.at[i - 1], kPixel * 0.5 * 6.9 * static_cast<double>(characters))
        << axis.labels[i - 1] << " runs into " << axis.labels[i];
  }
}

class ChartCanvas : public testing::Test {
 protected:
  void SetUp() override {
    const auto found = find_browser();
    if (!found) GTEST_SKIP() << kNoBrowser;
    browser_ = *found;
  }
  std::string browser_;
};

TEST_F(ChartCanvas, LinesStandWhereTheirAxesSay) {
  Page page("charts");
  const std::vector<PictureData> data = picture_data();
  std::vector<Plateaus> lines;
  for (std::size_t i = 0; i < data.size(); ++i) {
    // Runs of very different length on one page; each has its own axis.
    lines.push_back(plateaus(data[i].values, i % 3 == 0 ? 0.01 : i % 3 == 1 ? 5.0 : 1e-7));
    page.chart({.title = data[i].name,
                .lines = {{.name = "line", .x = lines.back().x, .y = lines.back().y, .stepped = i % 2 == 1}},
                .axis = data[i].name});
  }
  const nlohmann::json drawn = drawn_charts(page, browser_);
  ASSERT_EQ(drawn.size(), data.size());
  for (std::size_t i = 0; i < data.size(); ++i) {
    SCOPED_TRACE(data[i].name);
    ASSERT_FALSE(drawn[i].is_null()) << "no chart";
    const DrawnChart chart = read_axes(drawn[i], "s");
    chart.x.expect_sound(kAligned);
    chart.y.expect_sound(kAligned);
    if (testing::Test::HasFatalFailure()) return;
    expect_labels_apart(chart.x, 2);
    double shift = 0.0;
    int read = 0;
    for (std::size_t k = 0; k < data[i].values.size(); ++k) {
      // From the plateau's second point to its last but one, because its ends are edges.
      const double from = chart.x.place(lines[i].x[k * kRepeats + 1]);
      const double to = chart.x.place(lines[i].x[(k + 1) * kRepeats - 2]);
      const auto end = static_cast<std::size_t>(to - kAligned);
      for (auto column = static_cast<std::size_t>(std::ceil(from + kAligned)); column < end; column += 3) {
        const nlohmann::json& pixels = chart.columns.at(column);
        if (!can_be_shown(data[i].values[k])) {
          EXPECT_TRUE(pixels.is_null()) << "a gap is drawn over";
          continue;
        }
        ASSERT_FALSE(pixels.is_null()) << "no line at " << data[i].values[k];
        const double middle = 0.5 * (pixels[0].get<double>() + pixels[1].get<double>()) + 0.5;
        const double off = middle - chart.y.place(data[i].values[k]);
        EXPECT_LT(std::abs(off), kAligned + 0.5) << "at " << data[i].values[k];
        shift += off;
        ++read;
      }
    }
    EXPECT_EQ(read > 0, std::ranges::any_of(data[i].values, can_be_shown));
    EXPECT_LT(std::abs(shift), 0.5 * kPixel * std::max(read, 1)) << "all of it is shifted";
  }
}

TEST_F(ChartCanvas, PointsBetweenGapsAreDots) {
  const double kNone = std::nan("");
  const std::vector<double> x = {0.0, 1.0, 2.0, 3.0, 4.0}, y = {kNone, 1.0, kNone, 2.0, 2.0};
  std::vector<double> many_x, many_y(201, kNone);  // too many for one dot each
  for (int i = 0; i <= 200; ++i) many_x.push_back(i);
  many_y[50] = -7.0;
  Page page("dots");
  page.chart({.title = "few", .lines = {{.name = "a", .x = x, .y = y}}, .axis = "few"});
  page.chart({.title = "many", .lines = {{.name = "a", .x = many_x, .y = many_y}}, .axis = "many"});
  const nlohmann::json drawn = drawn_charts(page, browser_);
  for (const auto& [chart, at_x, at_y] : {std::tuple{0, 1.0, 1.0}, std::tuple{1, 50.0, -7.0}}) {
    const DrawnChart read = read_axes(drawn[static_cast<std::size_t>(chart)], "s");
    const nlohmann::json& pixels = read.columns.at(static_cast<std::size_t>(std::lround(read.x.place(at_x))));
    ASSERT_FALSE(pixels.is_null()) << chart;
    EXPECT_NEAR(0.5 * (pixels[0].get<double>() + pixels[1].get<double>()), read.y.place(at_y), kAligned);
  }
}

TEST_F(ChartCanvas, ChartsOfOneAxisLieUnderEachOther) {
  const std::vector<double> run = {0.0, 8.0}, longer = {2.0, 12.0}, search = {1.0, 190.0};
  Page page("axes");
  page.chart({.title = "a", .lines = {{.name = "a", .x = run, .y = run}}});
  page.chart({.title = "b", .lines = {{.name = "b", .x = longer, .y = run}}});
  page.chart({.title = "c", .x_name = "evaluation", .x_unit = "s", .lines = {{.name = "c", .x = search, .y = run}}});
  page.lanes({.title = "d", .lanes = {{"lane", {{3.0, 9.0, "", colour::kBlue}}}}});
  const nlohmann::json drawn = drawn_charts(page, browser_);
  const DrawnAxis a = read_axes(drawn[0], "s").x, b = read_axes(drawn[1], "s").x, c = read_axes(drawn[2], "s").x;
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.at, b.at);
  EXPECT_LE(a.value.back(), 12.0) << "the search is another axis";
  EXPECT_GT(c.value.back(), 100.0);
  const DrawnChart lane = read_axes(drawn[3], "s");
  std::size_t first = 0, last = 0;
  for (std::size_t k = 0; k < lane.columns.size(); ++k) {
    if (lane.columns[k].is_null()) continue;
    if (first == 0) first = k;
    last = k;
  }
  EXPECT_NEAR(static_cast<double>(first), lane.x.place(3.0), kAligned);
  EXPECT_NEAR(static_cast<double>(last + 1), lane.x.place(9.0), kAligned);
}

TEST_F(ChartCanvas, WordsOfNarrowStretchesAndCloseMarksStayReadable) {
  Page page("words");
  page.lanes({.title = "steps",
              .lanes = {{"step",
                         {{0.0, 60.0, "stand for a while", colour::kSky},
                          {60.0, 65.0, "7 walk forward slowly", colour::kGrey},
                          {65.0, 68.0, "8 stop", colour::kSky}}}},
              .marks = {{30.0, "first fault"}, {30.5, "second fault"}}});
  const nlohmann::json drawn = drawn_charts(page, browser_);
  std::vector<std::string> words;
  std::vector<std::pair<double, double>> marks;
  for (const auto& word : drawn[0]["words"]) {
    words.push_back(word["text"]);
    if (words.back().ends_with("fault")) marks.emplace_back(word["x"], word["y"]);
  }
  EXPECT_THAT(words, testing::Contains("stand for a while"));
  EXPECT_THAT(words, testing::Contains(testing::AllOf(testing::StartsWith("7 w"), testing::EndsWith("…"))));
  EXPECT_THAT(words, testing::Contains("8")) << "a number, and no letter of a word behind it";
  ASSERT_EQ(marks.size(), 2U);
  EXPECT_GT(std::abs(marks[0].second - marks[1].second), 12.0 * kPixel) << "one word over the other";
}

TEST_F(ChartCanvas, AValueFarBeyondIsToldAndFlattensNothing) {
  std::vector<double> x, asked, measured;
  for (int i = 0; i < 200; ++i) {
    x.push_back(i);
    asked.push_back(i == 100 ? 50.0 : i == 150 ? -40.0 : 0.8);
    measured.push_back(0.4 + 0.002 * i);
  }
  Page page("beyond");
  const Line bounded{.name = "asked", .x = x, .y = asked, .colour = "#1b1f24", .widens_from = -0.5, .widens_to = 1.2};
  page.chart({.title = "bounded", .lines = {bounded, {.name = "measured", .x = x, .y = measured}}});
  page.chart({.title = "not",
              .lines = {{.name = "asked", .x = x, .y = asked, .colour = "#1b1f24"},
                        {.name = "measured", .x = x, .y = measured}}});
  page.chart({.title = "measured beyond", .lines = {bounded, {.name = "measured", .x = x, .y = asked}}});
  const nlohmann::json drawn = drawn_charts(page, browser_);
  const auto height = [&](std::size_t chart) {  // of the measured line, as a share of the canvas
    double top = 1e9, bottom = 0.0;
    for (const auto& pixels : drawn[chart]["columns"]) {
      if (pixels.is_null()) continue;
      top = std::min(top, pixels[0].get<double>());
      bottom = std::max(bottom, pixels[1].get<double>());
    }
    return (bottom - top) / drawn[chart]["height"].get<double>();
  };
  const auto words = [&](std::size_t chart) {
    std::vector<std::string> found;
    for (const auto& word : drawn[chart]["words"]) found.push_back(word["text"]);
    return found;
  };
  EXPECT_GT(height(0), 0.15) << "of 1.7 m/s it goes through 0.4";
  EXPECT_LT(height(1), 0.05);
  EXPECT_THAT(words(0), testing::IsSupersetOf({"asked 50 ↑", "asked -40 ↓"}));
  EXPECT_THAT(words(1), testing::Not(testing::Contains(testing::EndsWith("↑")))) << "it is in the picture";
  EXPECT_GT(height(2), 0.5) << "a line without a bound is always in the picture whole";
}

/// Presses every button, and finds what it would save: name and text, for an SVG also what an XML reader makes of it.
const std::string kSave = R"js(
  const saved = [], texts = new Map();
  URL.createObjectURL = (blob) => { const key = 'saved:' + texts.size; texts.set(key, blob.text()); return key; };
  HTMLAnchorElement.prototype.click = function () { saved.push([this.download, texts.get(this.href)]); };
  document.querySelectorAll('h3 button').forEach((button) => button.click());
  Promise.all(saved.map(async ([name, text]) => {
    const xml = new DOMParser().parseFromString(await text, 'image/svg+xml');
    return {name, text: await text, element: xml.documentElement.nodeName, width: xml.documentElement.getAttribute('width')};
  })).then((found) => {
    const out = document.createElement('pre');
    out.id = 'found';
    out.textContent = JSON.stringify(found);
    document.body.append(out);
  });
)js";

TEST_F(ChartCanvas, EveryPictureIsSavedByAButton) {
  Page page("saved");
  const std::vector<double> x = {0.0, 0.5, 1.0, 1.5}, y = {1.0, 0.25, std::nan(""), -3.0};
  page.chart({.title = "left knee, torque [Nm]", .lines = {{.name = "measured, \"raw\"", .x = x, .y = y}}});
  page.lanes({.title = "steps", .lanes = {{"step", {{0.0, 1.5, "stand, then walk", colour::kSky}}}}});
  page.bars({.title = "errors", .unit = "m", .names = {"pmg"}, .sets = {{.name = "measured", .values = {0.5}}}});
  const nlohmann::json saved = found_in_browser(browser_, page.html(), "", kSave);
  ASSERT_EQ(saved.size(), 3U);
  EXPECT_EQ(saved[0]["name"], "left_knee_torque_Nm.csv");
  EXPECT_EQ(saved[0]["text"], "time [s],\"measured, \"\"raw\"\"\"\n0,1\n0.5,0.25\n1,\n1.5,-3\n");
  EXPECT_EQ(saved[1]["name"], "steps.csv");
  EXPECT_EQ(saved[1]["text"], "row,text,from [s],to [s]\nstep,\"stand, then walk\",0,1.5\n");
  EXPECT_EQ(saved[2]["name"], "errors.svg");
  EXPECT_EQ(saved[2]["element"], "svg") << saved[2]["text"];
  EXPECT_NE(saved[2]["width"], nullptr);
  EXPECT_THAT(saved[2]["text"].get<std::string>(), testing::HasSubstr("text-anchor: end"));
}

}  // namespace
}  // namespace pmg::pages
