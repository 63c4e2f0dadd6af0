// The page of the tracking table.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "evaluation/table1.hpp"
#include "pages/text.hpp"

namespace pmg::evaluation {

namespace {

constexpr std::array<const char*, 6> kColours = {pages::colour::kBlue,   pages::colour::kVermillion,
                                                 pages::colour::kGreen,  pages::colour::kOrange,
                                                 pages::colour::kPurple, pages::colour::kSky};

/// No bars beside ours: what can't be compared in size must not look as if it could.
constexpr const char* kAboutThePaper =
    "The paper's figures are of its own robot in Isaac Gym, and its commands are unknown: larger commands make larger "
    "errors. So compare the order of the policies, not the sizes.";

bool has_published(const Table1& table) {
  return std::ranges::any_of(table.cases, [](const Case& one) { return published_errors(one.name).has_value(); });
}

std::vector<std::string> case_names(const Table1& table) {
  std::vector<std::string> names;
  for (const Case& c : table.cases) names.push_back(c.name);
  return names;
}

std::string titled(std::size_t error) { return fmt::format("{} error [{}]", kErrorNames[error], kErrorUnits[error]); }

pages::Bars overall_bars(const Table1& table, std::size_t error) {
  pages::Bars bars{.title = titled(error), .unit = kErrorUnits[error], .names = case_names(table), .sets = {}};
  pages::Bars::Set measured{.name = "measured", .values = {}};
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    const Estimate& estimate = table.summaries[c].errors[error];
    measured.values.push_back(estimate.mean);
    measured.intervals.push_back({estimate.lower, estimate.upper});
  }
  bars.sets = {measured};
  const Yardstick& between = table.yardsticks[table.judged];
  bars.marks = {{between.nothing.errors[error], "doing nothing"}, {between.follower.errors[error], "perfect follower"}};
  if (table.gentle()) bars.marks.push_back({kErrorLimits[error], fmt::format("limit {}", kErrorLimits[error])});
  return bars;
}

pages::Bars step_bars(const Table1& table, std::size_t error) {
  pages::Bars bars{.title = titled(error), .unit = kErrorUnits[error], .names = {}, .sets = {}};
  for (const sil::ScenarioStep& step : table.scenario.steps) bars.names.push_back(step.text);
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    pages::Bars::Set set{.name = table.cases[c].name, .values = {}, .colour = kColours[c % kColours.size()]};
    for (const Errors& errors : table.summaries[c].step_errors) set.values.push_back(errors[error]);
    bars.sets.push_back(set);
  }
  if (table.gentle()) {
    bars.marks = {{kErrorLimits[error], fmt::format("limit of the mean {}", kErrorLimits[error])}};
  }
  return bars;
}

void add_verdicts(const Table1& table, pages::Page& page) {
  const CaseSummary& judged = table.summaries[table.judged];
  page.worth(worth_of(table));
  page.verdict({},
               fmt::format("{}: fell in {} of {} runs", table.cases[table.judged].name, judged.falls, judged.trials));
  if (worth_of(table).usable())
    page.verdict({}, fmt::format("{}: every error is within its limit", table.cases[table.judged].name));
  for (const Comparison& comparison : table.comparisons) {
    std::string better, open, worse;
    for (std::size_t e = 0; e < kErrors; ++e) {
      const Estimate& d = comparison.difference[e];
      std::string& list = d.upper < 0.0 ? better : d.lower > 0.0 ? worse : open;
      list += std::string(list.empty() ? "" : ", ") + kErrorNames[e];
    }
    std::string text = fmt::format("{} against {}: better in {}", comparison.policy, comparison.other,
                                   better.empty() ? "nothing" : better);
    if (!worse.empty()) text += "; worse in " + worse;
    if (!open.empty()) text += "; undecided in " + open;
    page.note(text);
  }
}

pages::Table errors_table(const Table1& table) {
  pages::Table out{.header = error_columns("mean absolute error"), .rows = {}};
  out.header.emplace_back("falls");
  const auto add = [&out](const std::string& name, const auto& cell, const std::string& falls) {
    std::vector<std::string> row = {name};
    for (std::size_t e = 0; e < kErrors; ++e) row.push_back(cell(e));
    row.push_back(falls);
    out.rows.push_back(row);
  };
  const auto figures = [&add](const std::string& name, const Errors& values, const std::string& falls) {
    add(
        name, [&](std::size_t e) { return fmt::format("{:.4f}", values[e]); }, falls);
  };
  const auto estimates = [&add](const std::string& name, const auto& of, const std::string& falls) {
    add(
        name, [&](std::size_t e) { return interval_text(of[e]); }, falls);
  };
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    const std::string& name = table.cases[c].name;
    const CaseSummary& summary = table.summaries[c];
    estimates(name, summary.errors, fmt::format("{} of {}", summary.falls, summary.trials));
    estimates(name + ", raw: tick by tick", summary.errors_raw, "");
    if (table.yardsticks[c].nothing.complete) {
      figures(name + ", doing nothing", table.yardsticks[c].nothing.errors, "");
      figures(name + ", perfect follower", table.yardsticks[c].follower.errors, "");
      const Errors shares = table.shares(c);
      add(
          name + ", share left",
          [&](std::size_t e) { return std::isnan(shares[e]) ? "nothing asked" : fmt::format("{:.4f}", shares[e]); },
          "");
    }
    if (std::isfinite(summary.errors_beyond_reach[0].mean))
      estimates(name + ", beyond the clips' reach", summary.errors_beyond_reach, "");
    if (const auto published = published_errors(name))
      figures(name + ", paper (other commands, other robot)", *published, "not told");
  }
  add(
      fmt::format("{}{}, limit", table.cases[table.judged].name, table.gentle() ? "" : ", share left"),
      [&](std::size_t e) {
        return fmt::format("{:.4f} {}", table.limit(e),
                           !table.measured()  ? "not measured"
                           : table.reached(e) ? "ok"
                                              : "MISSED");
      },
      table.summaries[table.judged].falls == 0 ? "0 ok" : "0 MISSED");
  return out;
}

/// Lines point to the courses' data.
pages::Chart course_chart(const Table1& table, Channel channel) {
  constexpr std::array kTitles = {"forward [m/s]",        "to the left [m/s]", "turning left [rad/s]",
                                  "pitch, forward [rad]", "roll, right [rad]", "height [m]"};
  static_assert(kTitles.size() == kChannels);
  pages::Chart chart{.title = kTitles[channel], .lines = {}, .height_px = 190};
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    const Course& course = table.campaign.courses[c];
    if (course.time_s.empty()) continue;
    if (chart.lines.empty()) {
      chart.lines.push_back({.name = "asked",
                             .x = course.time_s,
                             .y = course.asked[channel],
                             .colour = pages::colour::kInk,
                             .dashed = true,
                             .stepped = true});
    }
    chart.lines.push_back({.name = table.cases[c].name,
                           .x = course.time_s,
                           .y = course.did[channel],
                           .colour = kColours[c % kColours.size()]});
  }
  return chart;
}

pages::Table differences_table(const Table1& table) {
  pages::Table out{.header = error_columns("difference, by seed"), .rows = {}};
  out.header.emplace_back("pairs");
  for (const Comparison& comparison : table.comparisons) {
    std::vector<std::string> row = {comparison.policy + " - " + comparison.other};
    for (const Estimate& d : comparison.difference) {
      row.push_back(fmt::format("{} {}", interval_text(d), d.upper < 0.0 ? "better" : d.lower > 0.0 ? "worse" : "?"));
    }
    row.push_back(std::to_string(comparison.pairs));
    out.rows.push_back(row);
  }
  return out;
}

pages::Table runs_table(const Table1& table) {
  pages::Table out{.header = error_columns("policy"), .rows = {}};
  out.header.insert(out.header.begin() + 1, {"seed", "end"});
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    for (std::size_t seed = 0; seed < table.campaign.runs[c].size(); ++seed) {
      const TrialResult& run = table.campaign.runs[c][seed];
      if (!run.complete) continue;
      std::string end = run.fell ? fmt::format("fell at {:.1f} s", run.fell_at_s) : "stood";
      if (!run.faults.empty()) end += ", " + run.faults.front();
      std::vector<std::string> row = {table.cases[c].name, std::to_string(seed + 1), end};
      for (const double error : run.errors) row.push_back(pages::number(error));
      out.rows.push_back(row);
    }
  }
  return out;
}

}  // namespace

std::vector<pages::Table> tables_of(const Table1& table) {
  std::vector<pages::Table> tables = {errors_table(table)};
  if (!table.comparisons.empty()) tables.push_back(differences_table(table));
  return tables;
}

pages::Page page_of(const Table1& table) {
  pages::Page page("Command tracking: " + table.robot);
  add_verdicts(table, page);
  page.heading("Errors against the user's command");
  page.paragraph("Means over seeds, with their 95 % intervals.");
  page.columns([&] {
    for (std::size_t e = 0; e < kErrors; ++e) page.bars(overall_bars(table, e));
  });
  if (has_published(table)) page.paragraph(kAboutThePaper);
  for (const pages::Table& one : tables_of(table)) page.table(one);
  page.heading("Over time, seed 1");
  page.columns([&] {
    for (const Channel channel : {kVx, kVy, kOmega, kPitch, kRoll, kHeight}) page.chart(course_chart(table, channel));
  });
  page.heading("By command");
  page.columns([&] {
    for (std::size_t e = 0; e < kErrors; ++e) page.bars(step_bars(table, e));
  });
  page.heading("How it was measured");
  page.paragraph(fmt::format(
      "{} runs a policy of {:.1f} s ({}), the same commands, simulated robots and sensor noise for every policy ({}). "
      "Every "
      "tick from the first standing counts, transitions included; errors are averaged over one gait period, in the "
      "heading frame (raw: without averaging); after a fall velocity and height count as zero and attitude as "
      "measured, to the end. Intervals "
      "are Student's, over seeds. Doing nothing is standing upright whatever is asked; a perfect follower does at once "
      "what "
      "ranges and rates let through; both pass through the same averaging. The share left is (error - follower) / "
      "(nothing - follower). Steps beyond the clips' reach are counted apart, against the user's command. The runs "
      "take "
      "{} phases of the gait in turn in which the commands change: walks begun from rest last up to a second longer, "
      "which isn't judged.",
      table.seeds, table.scenario.duration_s(), table.scenario_file,
      table.ranges_file.empty() ? "as the model says" : table.ranges_file, kPhases));
  if (!table.films.empty()) {
    std::string names;
    for (const std::string& film : table.films) names += (names.empty() ? "" : ", ") + film;
    page.paragraph("Films of seed 1 lie beside this page: " + names + ".");
  }
  page.folded("Every run", [&] { page.table(runs_table(table)); });
  return page;
}

}  // namespace pmg::evaluation
