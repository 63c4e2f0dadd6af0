// The page of the push test.
#include <fmt/format.h>

#include "evaluation/push.hpp"

namespace pmg::evaluation {

namespace {

struct Curve {
  std::vector<double> share, lower, upper;
  void add(const Estimate& estimate) {
    share.push_back(100.0 * estimate.mean);
    lower.push_back(100.0 * estimate.lower);
    upper.push_back(100.0 * estimate.upper);
  }
};

void add_curves(const PushTest& test, pages::Page& page) {
  std::vector<double> impulse, asked;
  Curve all, standing, walking;
  for (const PushTrials& at : test.strengths) {
    impulse.push_back(at.impulse_N_s);
    asked.push_back(100.0 * kPushSurvival);
    all.add(test.survival(at));
    standing.add(test.survival(at, [](const PushPlan& plan) { return !plan.walking; }));
    walking.add(test.survival(at, [](const PushPlan& plan) { return plan.walking; }));
  }
  using namespace pages;
  const auto curve = [&](const std::string& title, const Curve& of, const char* colour) {
    page.chart({.title = title,
                .x_name = "impulse",
                .x_unit = "N s",
                .lines = {{.name = "survived", .x = impulse, .y = of.share, .colour = colour, .width_px = 2.4},
                          {.name = "95 % from", .x = impulse, .y = of.lower, .colour = colour, .dashed = true},
                          {.name = "to", .x = impulse, .y = of.upper, .colour = colour, .dashed = true},
                          {.name = "asked", .x = impulse, .y = asked, .colour = colour::kGrey}},
                .marks = {{kJudgedPush_N_s, fmt::format("asked {:.0f} %", 100.0 * kPushSurvival)}}});
  };
  curve("survived, all [%]", all, colour::kBlue);
  page.columns([&] {
    curve("survived, standing [%]", standing, colour::kGreen);
    curve("survived, walking at 0.5 m/s [%]", walking, colour::kVermillion);
  });
}

void add_directions(const PushTest& test, pages::Page& page) {
  page.columns([&] {
    for (const PushTrials& at : test.strengths) {
      pages::Bars bars{.title = fmt::format("{:.0f} N s: survived by direction [%]", at.impulse_N_s),
                       .unit = "%",
                       .names = {kPushDirectionNames.begin(), kPushDirectionNames.end()},
                       .sets = {}};
      pages::Bars::Set set{.name = "survived", .values = {}};
      for (int d = 0; d < kPushDirections; ++d) {
        const Estimate share = test.survival(at, [d](const PushPlan& plan) { return plan.direction == d; });
        set.values.push_back(100.0 * share.mean);
        set.intervals.push_back({100.0 * share.lower, 100.0 * share.upper});
      }
      bars.sets = {set};
      page.bars(bars);
    }
  });
}

}  // namespace

std::vector<pages::Table> tables_of(const PushTest& test) {
  pages::Table table{.header = {"impulse [N s]", "survived [%]", "standing [%]", "walking [%]"}, .rows = {}},
      directions{.header = {"impulse [N s]"}, .rows = {}};
  for (const char* name : kPushDirectionNames) directions.header.push_back(fmt::format("{} [%]", name));
  for (const PushTrials& at : test.strengths) {
    const std::string impulse = fmt::format("{:.0f}", at.impulse_N_s);
    table.rows.push_back({impulse, percent_with_interval(test.survival(at)),
                          percent_with_interval(test.survival(at, [](const PushPlan& plan) { return !plan.walking; })),
                          percent_with_interval(test.survival(at, [](const PushPlan& plan) { return plan.walking; }))});
    std::vector<std::string> row = {impulse};
    for (int d = 0; d < kPushDirections; ++d)
      row.push_back(
          percent_with_interval(test.survival(at, [d](const PushPlan& plan) { return plan.direction == d; })));
    directions.rows.push_back(row);
  }
  return {table, directions};
}

pages::Page page_of(const PushTest& test) {
  pages::Page page(fmt::format("Pushes: {} on {}", test.evaluated.name, test.robot));
  page.worth(worth_of(test));
  if (const auto reached = test.reached()) {
    for (const PushTrials& at : test.strengths) {
      if (at.impulse_N_s != kJudgedPush_N_s) continue;
      page.verdict(*reached ? work::Worth() : work::Worth(work::Grade::kMissed, "too many trials fell or faulted"),
                   fmt::format("{:.0f} N s: survived {} % of trials; asked {:.0f} %", at.impulse_N_s,
                               percent_with_interval(test.survival(at)), 100.0 * kPushSurvival));
    }
  }
  page.heading("Survival");
  add_curves(test, page);
  page.heading("By direction");
  add_directions(test, page);
  for (const pages::Table& table : tables_of(test)) page.table(table);
  page.heading("How it was measured");
  page.paragraph(fmt::format(
      "{} trials a strength. A constant force on the torso's centre of mass for {} s, in eight directions about the "
      "pelvis' heading, at a random moment of the gait cycle, half of them standing, half walking forward at 0.5 m/s; "
      "a trial is "
      "survived when the robot neither falls nor faults within 4 s. Every strength meets the same robots, moments and "
      "directions ({}). Intervals are Wilson's, 95 %.",
      test.trials, kPush_s, test.ranges_file.empty() ? "as the model says" : test.ranges_file));
  return page;
}

}  // namespace pmg::evaluation
