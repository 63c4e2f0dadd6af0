#include "pages/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pages/assets.hpp"
#include "pages/text.hpp"

namespace pmg::pages {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<double> kX = {0.0, 1.0, 2.0}, kY = {3.0, 1.0, 2.0};
constexpr const char* kHostile = "</script><img src=x onerror=alert(1)> \"&' \xff";

/// A page with one element of every kind, all with this name.
Page full_page(const std::string& name) {
  Page page(name);
  page.worth({work::Grade::kMissed, name});
  page.verdict({}, name);
  page.note(name);
  page.heading(name);
  page.heading("second");
  page.paragraph(name);
  page.table({.header = {name}, .rows = {{name}}});
  page.columns([&] {
    page.chart({.title = name, .x_unit = name, .lines = {{.name = name, .x = kX, .y = kY}}, .marks = {{1.0, name}}});
    page.lanes(
        {.title = name, .x_unit = name, .lanes = {{name, {{0.0, 1.0, name, colour::kSky}}}}, .marks = {{1.0, name}}});
  });
  page.folded(name, [&] {
    page.bars({.title = name, .unit = name, .names = {name}, .sets = {{name, {1.0}}, {name, {2.0}}}});
    page.histogram({.title = name, .unit = name, .sets = {{name, kY}}});
    page.plot({.title = name, .x_name = name, .lines = {{.name = name, .x = kX, .y = kY}}, .marks = {{1.0, name}}});
  });
  return page;
}

std::string without_assets(std::string html) {
  for (const char* asset : {kUplotScript, kUplotStyle, kPageScript, kPageStyle}) {
    const std::size_t at = html.find(asset);
    if (at == std::string::npos)
      ADD_FAILURE() << "an asset is missing";
    else
      html.erase(at, std::string(asset).size());
  }
  return html;
}

std::vector<nlohmann::json> chart_specs(const std::string& html) {
  std::vector<nlohmann::json> specs;
  const std::string open = "<script type=\"application/json\">";
  for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at + 1)) {
    const std::size_t begin = at + open.size();
    specs.push_back(nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin)));
  }
  return specs;
}

TEST(Page, LoadsNothingFromAnywhere) {
  const std::string html = without_assets(full_page("name").html()) + kPageScript + kPageStyle + kUplotStyle;
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("https://")));
  EXPECT_THAT(html, Not(testing::ContainsRegex("(src|href)=\"[^#]")));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  std::istringstream uplot(kUplotScript);
  for (std::string line; std::getline(uplot, line);) {  // its licence and comments contain addresses
    if (line.find("://") == std::string::npos) continue;
    EXPECT_THAT(line, testing::ContainsRegex("(//|\\*).*https?://"));
  }
}

TEST(Page, AFolderThatIsMissingIsNamed) {
  const auto file = std::filesystem::path(testing::TempDir()) / "no_such_folder" / "report.html";
  try {
    Page("a page").write(file);
    FAIL() << "it was written";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("there is no folder " + file.parent_path().string()), std::string::npos);
  }
}

TEST(Page, NamesNeverBecomeMarkup) {
  const std::string html = without_assets(full_page(kHostile).html());
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, Not(HasSubstr("onerror=alert(1)> \"")));
  EXPECT_THAT(html, HasSubstr("&lt;img src=x onerror=alert(1)&gt; &quot;&amp;&#39;"));
  EXPECT_EQ(chart_specs(html).size(), 2U) << "no name ends a script";
}

TEST(Page, ChartsCarryTheirLinesOnce) {
  Page page("charts");
  const std::vector<double> other_x = {0.5, 1.5};
  page.chart({.title = "three lines",
              .lines = {{.name = "a", .x = kX, .y = kY},
                        {.name = "b", .x = other_x, .y = other_x},
                        {.name = "c", .x = kX, .y = kX}}});
  const auto specs = chart_specs(page.html());
  ASSERT_EQ(specs.size(), 1U);
  ASSERT_EQ(specs[0]["tracks"].size(), 2U) << "a and c share their x";
  EXPECT_EQ(specs[0]["tracks"][0]["y"].size(), 2U);
  EXPECT_EQ(specs[0]["lines"][1]["name"], "c") << "lines are in the order of the tracks";
  EXPECT_EQ(specs[0]["lines"][2]["name"], "b");
}

TEST(Page, ChartsOfOneAxisShareItsRangeAndNoOthers) {
  Page page("range");
  const std::vector<double> eight = {0.0, 8.0}, evaluations = {1.0, 190.0};
  page.chart({.title = "a", .lines = {{.name = "a", .x = kX, .y = kY}}});
  page.lanes({.title = "b", .lanes = {{"lane", {{-1.0, 7.5, "long", colour::kSky}}}}});
  page.chart({.title = "a run", .lines = {{.name = "a", .x = eight, .y = eight}}, .axis = "run 3"});
  page.chart(
      {.title = "search", .x_name = "evaluation", .x_unit = "", .lines = {{.name = "", .x = evaluations, .y = eight}}});
  const std::string html = page.html();
  EXPECT_THAT(html, HasSubstr("&quot;time [s]&quot;:[-1.0,7.5]"));
  EXPECT_THAT(html, HasSubstr("&quot;run 3&quot;:[0.0,8.0]"));
  EXPECT_THAT(html, HasSubstr("&quot;evaluation []&quot;:[1.0,190.0]"));
  std::vector<std::string> axes;
  for (const nlohmann::json& spec : chart_specs(html)) axes.push_back(spec["axis"]);
  EXPECT_THAT(axes, testing::ElementsAre("time [s]", "time [s]", "run 3", "evaluation []"));
}

TEST(Page, EmptyPicturesAreNoError) {
  Page page("empty");
  const std::vector<double> none, nans(3, std::nan(""));
  page.chart({.title = "no line", .lines = {}});
  page.chart({.title = "empty line", .lines = {{.name = "a", .x = none, .y = none}}});
  page.chart({.title = "nothing finite", .lines = {{.name = "a", .x = kX, .y = nans}}});
  page.lanes({.title = "no lane", .lanes = {}});
  page.bars({.title = "no bar", .unit = "", .names = {"a"}, .sets = {{"set", {}}}});
  page.bars({.title = "no number", .unit = "", .names = {"a"}, .sets = {{"set", nans}}});
  page.histogram({.title = "no value", .unit = "", .sets = {{"set", none}}});
  EXPECT_EQ(chart_specs(page.html()).size(), 4U);
}

TEST(Page, TablesBarsAndHistogramsNeedNoScript) {
  Page page("plain");
  page.table({.header = {"h"}, .rows = {{"cell"}}});
  page.bars({.title = "bars", .unit = "rad", .names = {"left_knee"}, .sets = {{"run", {0.25}}}});
  page.histogram({.title = "times", .unit = "us", .sets = {{"tick", kY}}});
  const std::string html = without_assets(page.html());
  EXPECT_THAT(html, HasSubstr("<td>cell</td>"));
  EXPECT_THAT(html, testing::ContainsRegex("<svg.*left_knee.*0\\.25.*</svg>"));
  EXPECT_THAT(html, HasSubstr("tick: 3 values, p50 2, p99 3 us"));
}

TEST(Page, SaysSoWhenItCantBeWritten) {
  EXPECT_THROW(Page("x").write("/no such folder/x.html"), std::runtime_error);
  EXPECT_THROW(Page("x").write("/dev/full"), std::runtime_error);
}

TEST(Number, IsShortAndReadable) {
  EXPECT_EQ(number(0.0), "0");
  EXPECT_EQ(number(-0.0001), "-0.0001");
  EXPECT_EQ(number(0.12345), "0.1235");
  EXPECT_EQ(number(0.0123), "0.0123");
  EXPECT_EQ(number(-0.0), "0");
  EXPECT_EQ(number(12.3), "12.3");
  EXPECT_EQ(number(99.999), "100");
  EXPECT_EQ(number(123456.7), "123457");
  EXPECT_EQ(number(-4.25e-7), "-4.25e-7");
  EXPECT_EQ(number(3e300), "3e300") << "no number takes three hundred digits";
  EXPECT_EQ(number(std::nan("")), "-");
}

/// Classes of the highlighted lines, in their order.
std::vector<std::string> colours(const Page& page) {
  std::vector<std::string> found;
  const std::string html = without_assets(page.html()), open = "<div class=\"verdict ";
  for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at + 1)) {
    const std::size_t begin = at + open.size();
    found.push_back(html.substr(begin, html.find('"', begin) - begin));
  }
  return found;
}

TEST(Page, NoLineIsGreenUnlessPageAndLineHold) {
  using work::Grade;
  for (const Grade grade : {Grade::kHolds, Grade::kOpen, Grade::kPartial, Grade::kMissed, Grade::kNoBetter,
                            Grade::kOffItsData, Grade::kInterrupted}) {
    Page of_line("line"), of_page("page");
    of_line.verdict({grade, "the reservation"}, "the judgement");
    of_page.worth({grade, "the reservation"});
    of_page.verdict({}, "the judgement");
    SCOPED_TRACE(name(grade));
    EXPECT_EQ(colours(of_line).front() == "good", grade == Grade::kHolds);
    EXPECT_EQ(colours(of_page).back() == "good", grade == Grade::kHolds);
    EXPECT_THAT(of_page.html(), HasSubstr(std::string("data-worth=\"") + name(grade) + "\""));
    if (grade == Grade::kHolds) continue;
    EXPECT_EQ(colours(of_page).size(), 2U) << "the reservation is the first line";
    EXPECT_LT(of_page.html().find("the reservation"), of_page.html().find("the judgement"));
    EXPECT_LT(of_line.html().find("the reservation"), of_line.html().find("the judgement"));
  }
}

}  // namespace
}  // namespace pmg::pages
