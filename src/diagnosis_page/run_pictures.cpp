#include "diagnosis_page/run_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib/fit_problem.hpp"
#include "calib/fit_results.hpp"

namespace pmg::diagnosis_page {

namespace {

using calib::SingleJoint;
using diagnosis::Diagnosis;

constexpr std::size_t kListedRuns = 5;
constexpr const char* kOffColour = "#e3e8ee";

/// A group of runs with every run's mean absolute error.
struct Misses {
  const std::vector<SingleJoint>& runs;
  std::vector<double> before, after;
};

Misses misses(const Diagnosis& diagnosis, const std::vector<SingleJoint>& runs, unsigned threads) {
  Misses found{runs, {}, {}};
  for (const auto& error : calib::errors(diagnosis.before, runs, threads))
    found.before.push_back(error.mean_absolute_rad());
  for (const auto& error : calib::errors(diagnosis.after, runs, threads))
    found.after.push_back(error.mean_absolute_rad());
  return found;
}

/// Indices, the largest error first.
std::vector<std::size_t> largest_first(const std::vector<double>& errors) {
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  return order;
}

struct ShownRun {
  const SingleJoint* joint;
  std::string why;
};

/// A run that is chosen twice is shown once, with both reasons.
void add(std::vector<ShownRun>& shown, const SingleJoint& joint, const std::string& why) {
  const auto same = std::find_if(shown.begin(), shown.end(),
                                 [&](const ShownRun& one) { return one.joint->run().file == joint.run().file; });
  if (same == shown.end())
    shown.push_back({&joint, why});
  else
    same->why += ", " + why;
}

std::vector<ShownRun> chosen(const Misses& fitted, const Misses& held_out) {
  std::vector<ShownRun> shown;
  const Misses& judged = held_out.runs.empty() ? fitted : held_out;
  const std::vector<std::size_t> before = largest_first(judged.before);
  add(shown, judged.runs[before[before.size() / 2]], "a usual run");
  if (!fitted.runs.empty()) {
    add(shown, fitted.runs[largest_first(fitted.after).front()], "worst-fitted run of the fit");
  }
  if (!held_out.runs.empty())
    add(shown, held_out.runs[largest_first(held_out.after).front()], "worst-fitted run of those held out");
  add(shown, judged.runs[before.front()], "worst before the diagnosis");
  return shown;
}

/// Where the drive was off.
std::vector<pages::Band> switched_off(const bench::Recording& r) {
  std::vector<pages::Band> bands;
  for (std::size_t k = 0; k < r.enabled.size(); ++k) {
    if (r.enabled[k]) continue;
    if (k == 0 || r.enabled[k - 1]) bands.push_back({r.t_s[k], r.t_s[k], kOffColour, "drive off"});
    bands.back().to = r.t_s[k];
  }
  return bands;
}

/// A run's lines; owns their values.
struct RunLines {
  RunLines(const Diagnosis& diagnosis, const SingleJoint& joint)
      : before(joint.rollout(diagnosis.before)),
        after(joint.rollout(diagnosis.after)),
        measured(joint.run().recording.q_rad) {
    const bench::Recording& r = joint.run().recording;
    for (std::size_t k = 0; k < measured.size(); ++k) {
      if (!r.valid[k]) measured[k] = std::nan("");
      missed_before.push_back(1e3 * (before[k] - measured[k]));
      missed_after.push_back(1e3 * (after[k] - measured[k]));
    }
  }
  std::vector<double> before, after, measured, missed_before, missed_after;
};

std::string described(const bench::BenchRun& run) {
  return fmt::format("{}, kp {:.4g}, kd {:.4g}", run.file, run.kp, run.kd);
}

void show_picture(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis, const ShownRun& shown) {
  const bench::Recording& r = shown.joint->run().recording;
  const RunLines lines(diagnosis, *shown.joint);
  page.plot(
      {.title = fmt::format("{}: position [{}] ({})", shown.why, calib::position_unit(bench, false),
                            described(shown.joint->run())),
       .x_name = "time [s]",
       .lines = {{.name = "command", .x = r.t_s, .y = r.q_cmd_rad, .colour = pages::colour::kGrey, .stepped = true},
                 {.name = "measured", .x = r.t_s, .y = lines.measured, .colour = pages::colour::kInk, .width_px = 2.6},
                 {.name = "simulated before",
                  .x = r.t_s,
                  .y = lines.before,
                  .colour = pages::colour::kOrange,
                  .dashed = true},
                 {.name = "simulated after", .x = r.t_s, .y = lines.after, .colour = pages::colour::kSky}},
       .bands = switched_off(r)});
  page.plot(
      {.title = fmt::format("{}: simulated minus measured [{}]", shown.why, calib::position_unit(bench, true)),
       .x_name = "time [s]",
       .lines =
           {{.name = "before", .x = r.t_s, .y = lines.missed_before, .colour = pages::colour::kOrange, .dashed = true},
            {.name = "after", .x = r.t_s, .y = lines.missed_after, .colour = pages::colour::kBlue}},
       .bands = switched_off(r),
       .show_zero = true});
}

void show_chart(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis, const ShownRun& shown) {
  const bench::Recording& r = shown.joint->run().recording;
  const RunLines lines(diagnosis, *shown.joint);
  page.chart(
      {.title =
           fmt::format("{}: {}, position [{}]", shown.why, shown.joint->run().file, calib::position_unit(bench, false)),
       .lines = {{.name = "command", .x = r.t_s, .y = r.q_cmd_rad, .colour = pages::colour::kGrey, .stepped = true},
                 {.name = "simulated before", .x = r.t_s, .y = lines.before, .colour = pages::colour::kOrange},
                 {.name = "simulated after", .x = r.t_s, .y = lines.after, .colour = pages::colour::kBlue},
                 {.name = "measured", .x = r.t_s, .y = lines.measured, .colour = pages::colour::kInk}},
       .bands = switched_off(r),
       .axis = shown.joint->run().file});
}

void list_worst(pages::Page& page, const bench::Bench& bench, const Misses& fitted) {
  const std::string unit = calib::position_unit(bench, true);
  pages::Table table{.header = {"fitted runs, the worst first", "trajectory", "kp", "kd",
                                "mean error before [" + unit + "]", "mean error after [" + unit + "]"},
                     .rows = {}};
  for (const std::size_t i : largest_first(fitted.after)) {
    if (table.rows.size() == kListedRuns) break;
    const bench::BenchRun& run = fitted.runs[i].run();
    table.rows.push_back({run.file, run.trajectory, fmt::format("{:.4g}", run.kp), fmt::format("{:.4g}", run.kd),
                          fmt::format("{:.3g}", 1e3 * fitted.before[i]), fmt::format("{:.3g}", 1e3 * fitted.after[i])});
  }
  page.table(table);
}

}  // namespace

void show_runs(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis,
               const diagnosis::DiagnosedRuns& runs, unsigned threads) {
  const Misses fitted = misses(diagnosis, runs.fitted, threads), held_out = misses(diagnosis, runs.scored, threads);
  if (fitted.runs.empty() && held_out.runs.empty()) return;
  page.heading("Measured and simulated");
  const std::vector<ShownRun> shown = chosen(fitted, held_out);
  page.columns([&] {
    for (const ShownRun& one : shown) show_picture(page, bench, diagnosis, one);
  });
  if (!fitted.runs.empty()) list_worst(page, bench, fitted);
  page.folded("The same runs to zoom into (needs JavaScript)", [&] {
    for (const ShownRun& one : shown) show_chart(page, bench, diagnosis, one);
  });
}

}  // namespace pmg::diagnosis_page
