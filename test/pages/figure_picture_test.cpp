// Stick figures are read back from the SVG: one scale for all of them, and their feet on one line.
#include "pages/figure_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <regex>
#include <stdexcept>

#include "drawn_svg.hpp"
#include "pages/page.hpp"

namespace pmg::pages {
namespace {

using testing::HasSubstr;
using testing::Not;

StickFigure post(double x, double height) { return {{{x, 0.0, x, height, colour::kBlue}}}; }

/// "M10.0 20.0L10.0 5.0"
struct Stroke {
  double from_x, from_y, to_x, to_y;
};
std::vector<Stroke> bones(const std::string& svg) {
  static const std::regex kLine(R"(M([-\d.]+) ([-\d.]+)L([-\d.]+) ([-\d.]+))");
  std::vector<Stroke> strokes;
  for (const DrawnElement& e : drawn_elements(svg)) {
    std::smatch m;
    const std::string d = e.tag == "path" && e.is("bone") ? e.attributes.at("d") : "";
    if (std::regex_match(d, m, kLine))
      strokes.push_back({std::stod(m[1]), std::stod(m[2]), std::stod(m[3]), std::stod(m[4])});
  }
  return strokes;
}

TEST(FiguresPicture, HasOneScaleForAllOfThemAndEachRowsFeetOnOneLine) {
  const std::vector<Stroke> drawn =
      bones(svg(Figures{.title = "two rows",
                        .columns = {"0 %", "50 %"},
                        .rows = {{"tall", {post(0.0, 2.0), post(0.5, 1.0)}}, {"short", {post(-0.5, 0.5)}}}}));
  ASSERT_EQ(drawn.size(), 3U);
  const double per_unit = (drawn[0].from_y - drawn[0].to_y) / 2.0;
  EXPECT_NEAR(drawn[1].from_y - drawn[1].to_y, per_unit, 0.11);
  EXPECT_NEAR(drawn[2].from_y - drawn[2].to_y, 0.5 * per_unit, 0.11);
  EXPECT_EQ(drawn[0].from_y, drawn[1].from_y);
  EXPECT_GT(drawn[2].to_y, drawn[0].from_y) << "the second row is below the first";
  for (const Stroke& bone : drawn) {
    EXPECT_GE(std::min(bone.from_x, bone.to_x), 0.0);
    EXPECT_LE(std::max(bone.from_x, bone.to_x), 640.0);
  }
}

TEST(FiguresPicture, LeavesOutWhatIsNoNumberAndEscapesNames) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string text =
      svg(Figures{.title = "<t>", .columns = {"<c>"}, .rows = {{"<r>", {post(nan, 1.0), post(0.0, 1.0)}}}});
  EXPECT_EQ(bones(text).size(), 1U);
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  for (const char* name : {"<t>", "<c>", "<r>"}) EXPECT_THAT(text, Not(HasSubstr(name)));
}

TEST(MovingFiguresPicture, GoesThroughEveryFigureAndBackToTheFirst) {
  const std::string text = svg(MovingFigures{
      .title = "walk", .rows = {{"one", {post(0.0, 1.0), post(0.1, 1.0), post(0.2, 1.0)}}}, .period_s = 1.25});
  EXPECT_THAT(text, HasSubstr(R"(dur="1.250s")"));
  std::smatch m;
  ASSERT_TRUE(std::regex_search(text, m, std::regex(R"re(attributeName="x1"[^>]*values="([^"]*)")re")));
  const std::string values = m[1];
  EXPECT_EQ(std::ranges::count(values, ';'), 3) << values;
  EXPECT_EQ(values.substr(0, values.find(';')), values.substr(values.rfind(';') + 1));
}

TEST(MovingFiguresPicture, RefusesFiguresOfDifferentBones) {
  EXPECT_THROW(svg(MovingFigures{.title = "", .rows = {{"one", {post(0.0, 1.0), StickFigure{}}}}}),
               std::invalid_argument);
  EXPECT_THROW(svg(MovingFigures{.title = "", .rows = {{"none", {}}}}), std::invalid_argument);
}

TEST(Judgements, SayTheirGradeInItsOwnColourAndOnlyWhatHoldsIsGreen) {
  Page page("judged");
  page.judgements({{"slide", "1 cm/s", "2 cm/s"},
                   {"seam", "0.1 rad", "0.02 rad", work::Grade::kMissed, "MISSED"},
                   {"hands", "no arms", "3 cm", work::Grade::kPartial, "not measured"}});
  const std::string html = page.html();
  EXPECT_THAT(html, HasSubstr(R"(<td class="word good">holds</td>)"));
  EXPECT_THAT(html, HasSubstr(R"(<td class="word bad">MISSED</td>)"));
  EXPECT_THAT(html, HasSubstr(R"(<td class="word unfinished">not measured</td>)"));
}

}  // namespace
}  // namespace pmg::pages
