// The section about drives and computer: limits, temperatures, times.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pages/histogram.hpp"
#include "pages/text.hpp"
#include "report/sections.hpp"

namespace pmg::report {

namespace {

/// Of what limited a target, in every picture of this section.
constexpr const char *kByRange = pages::colour::kSky, *kBySpeed = pages::colour::kOrange,
                     *kByTorque = pages::colour::kVermillion;
constexpr std::size_t kHottest = 4;  // joints whose temperatures are drawn

/// Ticks with a limit of any kind; a tick with two kinds counts twice.
std::int64_t limited_ticks(const RunSeries& run) {
  return run.status.position_ticks + run.status.rate_ticks + run.status.torque_ticks;
}

double hottest(const std::vector<float>& temperatures) {
  double most = -1e9;
  for (const float t : temperatures) most = std::max(most, std::isfinite(t) ? static_cast<double>(t) : most);
  return most;
}

void limit_table(pages::Page& page, const Runs& runs) {
  pages::Table table{.header = {"ticks with"}, .rows = {}};
  for (std::size_t i = 0; i < runs.size(); ++i) table.header.push_back(runs[i].name + suffix(runs, i));
  const auto row = [&](const char* name, auto count) {
    std::vector<std::string> cells = {name};
    for (const RunSeries& run : runs) {
      const std::int64_t ticks = count(run);
      const double share =
          static_cast<double>(ticks) / static_cast<double>(std::max<std::int64_t>(run.status.ticks, 1));
      cells.push_back(ticks > 0 ? fmt::format("{} ({:.2f} %)", ticks, 100.0 * share) : "0");
    }
    table.rows.push_back(std::move(cells));
  };
  row("a target limited by its range", [](const RunSeries& run) { return run.status.position_ticks; });
  row("a target limited by its speed", [](const RunSeries& run) { return run.status.rate_ticks; });
  row("a target limited by its torque", [](const RunSeries& run) { return run.status.torque_ticks; });
  row("a command outside the admissible set", [](const RunSeries& run) { return run.reference.command_limited; });
  row("a reference clamped to a joint's range", [](const RunSeries& run) { return run.reference.joint_clamped; });
  row("no convergence of the ground-aware optimisation",
      [](const RunSeries& run) { return run.reference.not_converged; });
  page.table(table);
}

constexpr std::size_t kLimitedShown = 8;  // joints: more than in any healthy run

/// Each limited joint with times and reasons; the worst ones as lanes over time.
void limited_joints(pages::Page& page, const Runs& runs) {
  pages::Table table{.header = {"joint", "limited by", "first at [s]", "longest [s]"}, .rows = {}};
  pages::Lanes lanes{.title = "Joints whose target was limited: by range (blue), speed (orange), torque (red)",
                     .lanes = {}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (const LimitedJoint& one : runs[i].limited) {
      const std::string name = runs[i].joint_names[one.joint] + suffix(runs, i);
      table.rows.push_back({name, one.reasons(), fmt::format("{:.2f}", one.stretches.front().from_s),
                            fmt::format("{:.2f}", one.longest_s)});
    }
    for (std::size_t k = 0; k < std::min(kLimitedShown, runs[i].limited.size()); ++k) {
      const LimitedJoint& one = runs[i].limited[k];
      pages::Lanes::Lane lane{.name = runs[i].joint_names[one.joint] + suffix(runs, i), .stretches = {}};
      for (const LimitedJoint::Stretch& s : one.stretches) {
        const char* colour = s.by[2] ? kByTorque : s.by[1] ? kBySpeed : kByRange;
        lane.stretches.push_back({s.from_s, s.to_s, "", colour});
      }
      lanes.lanes.push_back(std::move(lane));
    }
    if (runs[i].limited.empty() && limited_ticks(runs[i]) > 0) {
      page.paragraph(
          fmt::format("Which joints were limited{} is not in the log: an older version wrote it.", suffix(runs, i)));
    }
  }
  if (table.rows.empty()) return;
  page.lanes(lanes);
  page.table(table);
}

void temperature_chart(pages::Page& page, const Runs& runs) {
  static constexpr std::array<const char*, kHottest> kColours = {pages::colour::kVermillion, pages::colour::kOrange,
                                                                 pages::colour::kPurple, pages::colour::kBlue};
  const auto lines_of = [&](std::size_t i) {
    const auto& temperatures = runs[i].state.temperature_degC;
    std::vector<std::size_t> order(temperatures.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t joint) { return hottest(temperatures[joint]); });
    std::vector<RunLine> lines;
    for (std::size_t k = 0; k < std::min(kHottest, order.size()); ++k) {
      const std::vector<float>& values = temperatures[order[k]];
      lines.push_back({.name = runs[i].joint_names[order[k]],
                       .x = runs[i].state.t_s,
                       .y = {values.begin(), values.end()},
                       .colour = kColours[k],
                       .dashed = i > 0});
    }
    return lines;
  };
  chart_of_runs(page, runs, fmt::format("Temperatures of the {} hottest drives [degC]", kHottest), lines_of);
}

/// How many joints were limited in each tick.
void limit_chart(pages::Page& page, const Runs& runs) {
  chart_of_runs(
      page, runs, "How many joints' targets were limited, and by what", [&](std::size_t i) -> std::vector<RunLine> {
        const auto& status = runs[i].status;
        if (limited_ticks(runs[i]) == 0) return {};
        const auto line = [&](const char* name, const std::vector<double>& counts, const char* colour) {
          return RunLine{
              .name = name, .x = status.t_s, .y = counts, .colour = colour, .dashed = i > 0, .stepped = true};
        };
        return {line("range", status.limited_position, kByRange), line("speed", status.limited_rate, kBySpeed),
                line("torque", status.limited_torque, kByTorque)};
      });
}

void times(pages::Page& page, const Runs& runs, const char* title, Sampled RunTiming::*which) {
  pages::Histogram histogram{.title = title, .unit = "us", .sets = {}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Sampled& sampled = runs[i].timing.*which;
    if (sampled.values().empty()) continue;
    histogram.sets.push_back({.name = runs[i].name + suffix(runs, i),
                              .values = sampled.values(),
                              .colour = palette(i).measured,
                              .each = sampled.each(),
                              .largest = sampled.largest()});
  }
  if (!histogram.sets.empty()) page.histogram(histogram);
}

void delays(pages::Page& page, const Runs& runs) {
  pages::Table table{.header = {"time [s]", "late [us]", "thread"}, .rows = {}};
  std::int64_t count = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunTiming& timing = runs[i].timing;
    count += timing.delay_count;
    for (const RunTiming::Delay& delay : timing.delays)
      table.rows.push_back(
          {fmt::format("{:.2f}{}", delay.t_s, suffix(runs, i)), pages::number(delay.late_us), delay.thread});
    if (timing.missed_ticks + timing.bus_missed_cycles + timing.dropped_records > 0) {
      page.paragraph(fmt::format("Skipped{}: {} ticks, {} bus cycles; {} records dropped from the log's queue.",
                                 suffix(runs, i), timing.missed_ticks, timing.bus_missed_cycles,
                                 timing.dropped_records));
    }
  }
  if (count == 0) return;
  const bool all = count == static_cast<std::int64_t>(table.rows.size());
  page.folded(fmt::format("{} cycle{} woke more than 2 ms late{}", count, count == 1 ? "" : "s",
                          all ? "" : ", the first of them"),
              [&] { page.table(table); });
}

}  // namespace

void limits_and_temperatures(pages::Page& page, const Runs& runs) {
  page.heading("Limits and temperatures");
  limit_table(page, runs);
  limited_joints(page, runs);
  page.columns([&] {
    limit_chart(page, runs);
    temperature_chart(page, runs);
  });
}

void timing(pages::Page& page, const Runs& runs) {
  page.heading("Timing");
  if (std::ranges::all_of(runs, [](const RunSeries& run) { return run.timing.ticks == 0; })) {
    return page.paragraph("No wall-clock times: the log has no TIMING, and there is no timing.csv beside it.");
  }
  page.paragraph(
      "Counts are on a logarithmic axis; words give the few longest. On a computer that is shared with "
      "others, single long times mean little.");
  page.columns([&] {
    times(page, runs, "Whole tick", &RunTiming::tick_us);
    times(page, runs, "Control thread's wake-up, behind its plan", &RunTiming::wake_us);
    times(page, runs, "Bus thread's wake-up, the worst of each tick", &RunTiming::bus_wake_us);
    times(page, runs, "Bus exchange, the longest of each tick", &RunTiming::bus_exchange_us);
    times(page, runs, "State's age at the tick's start, the oldest motor's", &RunTiming::state_age_us);
    times(page, runs, "Generator", &RunTiming::generator_us);
    times(page, runs, "Ground-aware optimisation", &RunTiming::gco_us);
    times(page, runs, "Policy", &RunTiming::policy_us);
  });
  delays(page, runs);
}

}  // namespace pmg::report
