// The page of a fit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "calib/fit_results.hpp"
#include "pages/plot_picture.hpp"

namespace pmg::calib {

namespace {

/// Samples of one run as the page's chart needs them; a dropout is a gap.
void show_run(pages::Page& page, const FitResults& results, const SingleJoint& joint, double error_rad,
              const char* which) {
  const bench::Recording& r = joint.run().recording;
  const std::vector<double> simulated = joint.rollout(results.fit.model);
  std::vector<double> measured = r.q_rad;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    if (!r.valid[k]) measured[k] = std::nan("");
  }
  const std::string unit = position_unit(*results.bench, false);
  page.chart(
      {.title = fmt::format("{}: {}, {:.4g} {} mean absolute error, position [{}]", which, joint.run().file,
                            1e3 * error_rad, position_unit(*results.bench, true), unit),
       .lines = {{.name = "command", .x = r.t_s, .y = r.q_cmd_rad, .colour = pages::colour::kGrey, .stepped = true},
                 {.name = "measured", .x = r.t_s, .y = measured, .colour = pages::colour::kInk},
                 {.name = "simulated", .x = r.t_s, .y = simulated, .colour = pages::colour::kVermillion}},
       .axis = joint.run().file});
  std::vector<double> miss(measured.size());
  for (std::size_t k = 0; k < miss.size(); ++k) miss[k] = 1e3 * (simulated[k] - measured[k]);
  page.chart({.title = fmt::format("simulated minus measured [{}]", position_unit(*results.bench, true)),
              .lines = {{.name = "error", .x = r.t_s, .y = miss, .colour = pages::colour::kBlue}},
              .height_px = 130,
              .axis = joint.run().file});
}

void show_runs(pages::Page& page, const FitResults& results, const Assessment& assessment) {
  std::vector<std::size_t> order(assessment.runs->size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return assessment.after[a].mean_absolute_rad() < assessment.after[b].mean_absolute_rad();
  });
  const auto show = [&](std::size_t rank, const char* which) {
    const std::size_t i = order[rank];
    show_run(page, results, (*assessment.runs)[i], assessment.after[i].mean_absolute_rad(), which);
  };
  show(order.size() / 2, "the usual run");
  if (order.size() > 1) show(order.size() - 1, "the worst run");
  if (order.size() > 2) show(0, "the best run");
}

/// Mean absolute error by the columns of runs.csv.
void show_groups(pages::Page& page, const FitResults& results, const Assessment& assessment, const std::string& title) {
  const auto name = [](const bench::BenchRun& run) { return run.trajectory.empty() ? run.file : run.trajectory; };
  std::map<std::string, std::pair<RolloutError, RolloutError>> groups;
  const auto add = [](RolloutError& sum, const RolloutError& error) { sum = total({sum, error}); };
  for (std::size_t i = 0; i < assessment.runs->size(); ++i) {
    const bench::BenchRun& run = (*assessment.runs)[i].run();
    for (const std::string& group : {name(run), fmt::format("kp {:g}", run.kp)}) {
      add(groups[group].first, assessment.before[i]);
      add(groups[group].second, assessment.after[i]);
    }
  }
  pages::Bars bars{.title = title,
                   .unit = position_unit(*results.bench, true),
                   .names = {},
                   .sets = {{.name = "before", .values = {}, .colour = pages::colour::kGrey},
                            {.name = "after", .values = {}, .colour = pages::colour::kBlue}}};
  for (const auto& [group, sums] : groups) {
    bars.names.push_back(group);
    bars.sets[0].values.push_back(1e3 * sums.first.mean_absolute_rad());
    bars.sets[1].values.push_back(1e3 * sums.second.mean_absolute_rad());
  }
  page.bars(bars);
}

void show_parameters(pages::Page& page, const FitResults& results) {
  pages::Table table{.header = {"parameter", "value", "one standard deviation", "unit", "range of the search", ""},
                     .rows = {}};
  for (std::size_t i = 0; i < results.confidence.size(); ++i) {
    const Unknown& p = results.problem->parameters()[i];
    const double x = value(results.fit.model, p.name);
    table.rows.push_back({p.name, fmt::format("{:.5g}", x), deviation_text(results.confidence[i]),
                          unit_on_rig(p.unit(), *results.bench), fmt::format("{:g} to {:g}", p.lower, p.upper),
                          reservation(p, x, results.confidence[i])});
  }
  page.table(table);
}

void show_inverse(pages::Page& page, const InverseDynamics& found, bool taken) {
  const auto row = [](const char* name, const InverseDynamics::Estimate& e) {
    return std::vector<std::string>{name, fmt::format("{:.5g}", e.value), fmt::format("{:.2g}", e.deviation)};
  };
  // A negative estimate within its uncertainty counts as 0.
  const auto at_least_0 = [](InverseDynamics::Estimate e) {
    e.value = std::max(0.0, e.value);
    return e;
  };
  page.heading("Inverse dynamics");
  if (!possible(found)) {
    page.paragraph(meaning_of_negative(found));
    return;
  }
  if (taken) page.paragraph("The model has these values; the rollouts found what they leave open.");
  page.paragraph(fmt::format(
      "Least squares of the recorded drive output, without simulation, over {} windows: residual {:.3g} Nm (N "
      "on a linear axis). Where it disagrees with the fit, friction isn't Coulomb and viscous alone, or the drive's "
      "timing isn't as modelled.",
      found.windows, found.residual_Nm));
  page.paragraph(fmt::format("Dry friction {:.4g} Nm forwards, {:.4g} Nm backwards (N on a linear axis).",
                             std::max(0.0, found.coulomb_forward_Nm()), std::max(0.0, found.coulomb_backward_Nm())));
  if (const std::string meaning = meaning_of_negative(found); !meaning.empty()) page.paragraph(meaning);
  page.table(
      {.header = {"parameter", "value", "one standard deviation"},
       .rows = {row("transmission.armature_kg_m2", at_least_0(found.armature_kg_m2)),
                row("friction.viscous_Nm_s_per_rad", at_least_0(found.viscous_Nm_s_per_rad)),
                row("friction.coulomb_Nm", at_least_0(found.coulomb_Nm)), row("ripple.offset_Nm", found.offset_Nm)}});
}

}  // namespace

std::string fit_picture(const FitResults& results, const JointModel& before) {
  const Assessment& shown = results.scored ? *results.scored : results.fitted;
  std::vector<std::size_t> order(shown.runs->size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return shown.after[a].mean_absolute_rad() < shown.after[b].mean_absolute_rad();
  });
  const SingleJoint& joint = (*shown.runs)[order[order.size() / 2]];
  const bench::Recording& r = joint.run().recording;
  const std::vector<double> old = joint.rollout(before), simulated = joint.rollout(results.fit.model);
  std::vector<double> old_miss(old.size()), miss(old.size());
  for (std::size_t k = 0; k < miss.size(); ++k) {
    old_miss[k] = 1e3 * (old[k] - r.q_rad[k]);
    miss[k] = 1e3 * (simulated[k] - r.q_rad[k]);
  }
  const std::string unit = position_unit(*results.bench, false);
  const auto line = [&](const char* name, const std::vector<double>& y, const char* colour) {
    return pages::PlotLine{.name = name, .x = r.t_s, .y = y, .colour = colour};
  };
  return pages::svg_file(
      {{.title = fmt::format("{}: position [{}]", joint.run().file, unit),
        .x_name = "time [s]",
        .lines = {line("command", r.q_cmd_rad, pages::colour::kGrey), line("measured", r.q_rad, pages::colour::kInk),
                  line("simulated", simulated, pages::colour::kVermillion)}},
       {.title = fmt::format("simulated minus measured [{}]", position_unit(*results.bench, true)),
        .x_name = "time [s]",
        .lines = {line("before", old_miss, pages::colour::kGrey), line("after", miss, pages::colour::kBlue)},
        .show_zero = true}});
}

pages::Page fit_report(const FitResults& results) {
  const Assessment& shown = results.scored ? *results.scored : results.fitted;
  const std::string unit = position_unit(*results.bench, true);
  pages::Page page(fmt::format("{}: motor calibration", results.joint));
  const double before = total(shown.before).mean_absolute_rad(), after = total(shown.after).mean_absolute_rad();
  page.worth(worth_of(results));
  page.verdict(
      {},
      fmt::format("Mean absolute error {:.4g} {} before, {:.4g} {} after, on {} runs {}{}", 1e3 * before, unit,
                  1e3 * after, unit, shown.runs->size(), results.scored ? "that were not fitted" : "that were fitted",
                  results.noise_floor.pairs.empty()
                      ? ""
                      : fmt::format(": {:.2g} noise floors", after / results.noise_floor.mean_absolute_rad)));
  page.heading("What the model makes of the runs");
  show_runs(page, results, shown);
  page.heading("Parameters");
  show_parameters(page, results);
  if (results.inverse) show_inverse(page, *results.inverse, results.inverse_taken);
  page.heading("Where the error is");
  page.columns([&] {
    show_groups(page, results, results.fitted, "fitted runs");
    if (results.scored) show_groups(page, results, *results.scored, "runs that were not fitted");
  });
  if (!results.noise_floor.pairs.empty()) {
    const bench::NoiseFloor& floor = results.noise_floor;
    page.paragraph(
        fmt::format("The noise floor: {} pairs of repeats stray by {:.3g} {} about what they have in common "
                    "({:.3g} to {:.3g}), and differ from each other by {:.3g}. No model explains that.",
                    floor.pairs.size(), 1e3 * floor.mean_absolute_rad, unit, 1e3 * floor.mean_absolute_low_rad,
                    1e3 * floor.mean_absolute_high_rad, 1e3 * floor.difference_mean_absolute_rad));
  }
  page.heading("The search");
  std::vector<double> at(results.fit.history.size()), rms(results.fit.history.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    at[k] = static_cast<double>(k + 1);
    rms[k] = 1e3 * std::sqrt(results.fit.history[k]);
  }
  if (at.size() > 1) {
    page.chart({.title = fmt::format("lowest rms error so far, polish on all runs [{}]", unit),
                .x_name = "evaluation",
                .x_unit = "",
                .lines = {{.name = "rms", .x = at, .y = rms}},
                .height_px = 160});
  }
  page.paragraph(fmt::format("{}: {} evaluations, {:.0f} s of joint time, in {:.1f} s on {} threads.", results.method,
                             results.fit.evaluations, results.fit.simulated_s, results.wall_s, results.threads));
  return page;
}

}  // namespace pmg::calib
