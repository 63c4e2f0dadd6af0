// A page in a browser as narrow as a phone.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "browser.hpp"

namespace pmg::pages {
namespace {

/// What runs out at the right, but for tables, which can be scrolled; and words of cells that stand in two lines.
const std::string kLook = R"js(
  document.body.style.width = '390px';
  const right = document.body.getBoundingClientRect().right + 1;
  const out = [...document.body.querySelectorAll('*')].filter((one) => !one.closest('.scroll table') && one.getBoundingClientRect().right > right);
  const words = [...document.querySelectorAll('table.data td')].filter((cell) => !/\s/.test(cell.textContent.trim())).filter((cell) => {
    const text = document.createRange();
    text.selectNodeContents(cell);
    return new Set([...text.getClientRects()].map(({top}) => Math.round(top))).size > 1;
  });
  const found = document.createElement('pre');
  found.id = 'found';
  found.textContent = JSON.stringify({out: out.map((one) => one.tagName + '.' + one.className), words: words.map((cell) => cell.textContent)});
  document.body.append(found);
)js";

TEST(NarrowPage, NothingRunsOutAtTheRightAndNoWordOfATableIsBroken) {
  const auto browser = find_browser();
  if (!browser) GTEST_SKIP() << kNoBrowser;
  Page page("A page with pictures side by side, and tables");
  page.columns([&] {
    for (const char* title : {"one", "other"})
      page.bars(
          {.title = title, .unit = "m", .names = {"left", "right"}, .sets = {{.name = "moved", .values = {0.7, 0.4}}}});
  });
  page.table({.header = {"trial", "end", "moved [m]", "after [s]", "what the operator did", "what it was told"},
              .rows = {{"1000", "interrupted", "0.785", "180", "walk to the higher table", "velocity is zero"},
                       {"1001", "palm_not_on_the_towel", "1.002", "84", "wipe", "stands; squeeze a grip"}}});
  const nlohmann::json found = found_in_browser(*browser, page.html(), "", kLook);
  EXPECT_EQ(found["out"], nlohmann::json::array());
  EXPECT_EQ(found["words"], nlohmann::json::array());
}

}  // namespace
}  // namespace pmg::pages
