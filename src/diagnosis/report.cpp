#include "diagnosis/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib/fit_results.hpp"
#include "data_faults/data_faults_report.hpp"
#include "diagnosis/residual_pictures.hpp"
#include "effects/catalogue.hpp"
#include "pages/text.hpp"

namespace pmg::diagnosis {

namespace {

const std::vector<calib::SingleJoint>& shown_runs(const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  return diagnosis.held_out && !runs.scored.empty() ? runs.scored : runs.fitted;
}

pages::Tone tone(evidence::Verdict verdict) {
  switch (verdict) {
    case evidence::Verdict::kFound:
    case evidence::Verdict::kNone:
      return pages::Tone::kGood;
    case evidence::Verdict::kAmbiguous:
      return pages::Tone::kNeutral;
    case evidence::Verdict::kUnexplained:
      break;
  }
  return pages::Tone::kBad;
}

std::string thousandths(double value_rad) { return fmt::format("{:.3g}", 1e3 * value_rad); }

std::string thousandths(const evidence::Interval& interval) {
  return fmt::format("{} ({} to {})", thousandths(interval.value), thousandths(interval.low),
                     thousandths(interval.high));
}

/// Where the drive was off.
std::vector<pages::Band> switched_off(const bench::Recording& r) {
  std::vector<pages::Band> bands;
  for (std::size_t k = 0; k < r.enabled.size(); ++k) {
    if (r.enabled[k]) continue;
    if (k == 0 || r.enabled[k - 1]) bands.push_back({r.t_s[k], r.t_s[k], "#eef2f6"});
    bands.back().to = r.t_s[k];
  }
  return bands;
}

void show_run(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis, const calib::SingleJoint& joint,
              const std::string& which) {
  const bench::Recording& r = joint.run().recording;
  const std::vector<double> before = joint.rollout(diagnosis.before), after = joint.rollout(diagnosis.after);
  std::vector<double> measured = r.q_rad;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    if (!r.valid[k]) measured[k] = std::nan("");
  }
  page.chart(
      {.title = fmt::format("{}: {}, position [{}]{}", which, joint.run().file, calib::position_unit(bench, false),
                            switched_off(r).empty() ? "" : "; shaded: the drive is off"),
       .lines = {{.name = "command", .x = r.t_s, .y = r.q_cmd_rad, .colour = pages::colour::kGrey, .stepped = true},
                 {.name = "simulated before", .x = r.t_s, .y = before, .colour = pages::colour::kOrange},
                 {.name = "simulated after", .x = r.t_s, .y = after, .colour = pages::colour::kBlue},
                 {.name = "measured", .x = r.t_s, .y = measured, .colour = pages::colour::kInk}},
       .bands = switched_off(r),
       .axis = joint.run().file});
  std::vector<double> missed_before(measured.size()), missed_after(measured.size());
  for (std::size_t k = 0; k < measured.size(); ++k) {
    missed_before[k] = 1e3 * (before[k] - measured[k]);
    missed_after[k] = 1e3 * (after[k] - measured[k]);
  }
  page.chart({.title = fmt::format("simulated minus measured [{}]", calib::position_unit(bench, true)),
              .lines = {{.name = "before", .x = r.t_s, .y = missed_before, .colour = pages::colour::kOrange},
                        {.name = "after", .x = r.t_s, .y = missed_after, .colour = pages::colour::kBlue}},
              .height_px = 150,
              .axis = joint.run().file});
}

void show_runs(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis,
               const std::vector<calib::SingleJoint>& runs, unsigned threads) {
  const std::vector<calib::RolloutError> errors = calib::errors(diagnosis.before, runs, threads);
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return errors[a].mean_absolute_rad() < errors[b].mean_absolute_rad();
  });
  show_run(page, bench, diagnosis, runs[order[order.size() / 2]], "the usual run");
  if (order.size() > 1) {
    show_run(page, bench, diagnosis, runs[order.back()], "the run that was missed by most before");
  }
}

void show_gain(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis) {
  pages::Bars bars{.title = fmt::format("mean absolute error{}, with 95 % intervals",
                                        diagnosis.held_out ? " on held-out runs" : " over folds"),
                   .unit = calib::position_unit(bench, true),
                   .names = {"before", "after"},
                   .sets = {{.name = "",
                             .values = {1e3 * diagnosis.held_out_before.value, 1e3 * diagnosis.held_out_after.value},
                             .intervals = {{1e3 * diagnosis.held_out_before.low, 1e3 * diagnosis.held_out_before.high},
                                           {1e3 * diagnosis.held_out_after.low, 1e3 * diagnosis.held_out_after.high}}}},
                   .marks = {}};
  for (const Cause& cause : diagnosis.causes) {
    bars.names.push_back("all but " + cause.effect);
    bars.sets[0].values.push_back(1e3 * cause.held_out_error_before);
    bars.sets[0].intervals.push_back({std::nan(""), std::nan("")});
  }
  if (diagnosis.noise_floor.mean_absolute_rad > 0.0) {
    bars.marks.push_back({1e3 * diagnosis.noise_floor.mean_absolute_rad, "noise floor"});
  }
  page.bars(bars);
  if (!diagnosis.noise_floor.how.empty()) {
    page.paragraph(fmt::format("Noise floor: mean absolute {} {}, rms {}; {}.",
                               thousandths(diagnosis.noise_floor.mean_absolute_rad), calib::position_unit(bench, true),
                               thousandths(diagnosis.noise_floor.rms_rad), diagnosis.noise_floor.how));
    page.paragraph(
        fmt::format("The simulation's step is {:.3g} ms ({}); its integrator's error is {} {} rms with the "
                    "base model.",
                    1e3 * diagnosis.step.error.step_s, name(diagnosis.step.limit),
                    thousandths(diagnosis.step.error.rms_rad), calib::position_unit(bench, true)));
  }
}

std::string parameter_lines(const Cause& cause) {
  std::string text;
  for (const evidence::ParameterEstimate& p : cause.parameters) {
    text += fmt::format("{}{} = {:.4g} ({:.4g} to {:.4g}) {}", text.empty() ? "" : "; ", p.name, p.estimate.value,
                        p.estimate.low, p.estimate.high, p.unit);
  }
  return text;
}

void show_causes(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis) {
  const std::string unit = calib::position_unit(bench, true);
  page.heading("Causes");
  if (diagnosis.causes.empty()) page.paragraph("No effect of the catalogue is named.");
  pages::Table table{.header = {"effect", "parameters, with 95 % intervals", "error without it [" + unit + "]",
                                "error with it [" + unit + "]", "could also be"},
                     .rows = {}};
  for (const Cause& cause : diagnosis.causes) {
    table.rows.push_back({effects::title(cause.effect), parameter_lines(cause),
                          thousandths(cause.held_out_error_before), thousandths(cause.held_out_error_after),
                          fmt::format("{}", fmt::join(cause.or_instead, ", "))});
  }
  if (!table.rows.empty()) page.table(table);
  show_gain(page, bench, diagnosis);
  for (const Cause& cause : diagnosis.causes) {
    if (cause.evidence.empty()) continue;
    page.paragraph(fmt::format("{}: {}", effects::title(cause.effect), fmt::join(cause.evidence, "; ")));
  }
}

void show_next(pages::Page& page, const NextExcitation& next) {
  page.heading("What to record next");
  page.paragraph(next.text);
  for (const NextRun& run : next.runs) {
    const std::string load = run.load_mass_kg > 0.0 ? fmt::format(", load {:.4g} kg", run.load_mass_kg) : "";
    page.plot({.title = fmt::format("{}, {} times: {}, kp {:.4g}{}", run.name, run.times, run.shape, run.kp, load),
               .x_name = "time [s]",
               .lines = {{.name = "", .x = run.t_s, .y = run.q_cmd_rad, .stepped = true}}});
  }
  if (next.pairs.empty()) return;
  pages::Table table{.header = {"two effects", "expected to part by [deviations]"}, .rows = {}};
  for (const ExpectedPair& pair : next.pairs) {
    table.rows.push_back({fmt::format("{}, {}", effects::title(pair.first), effects::title(pair.second)),
                          fmt::format("{:.1f}", pair.deviations)});
  }
  page.table(table);
}

void show_rejected(pages::Page& page, const std::vector<Rejected>& rejected) {
  if (rejected.empty()) return;
  page.heading("What it is not");
  pages::Table table{.header = {"effect", "why not"}, .rows = {}};
  for (const Rejected& one : rejected) table.rows.push_back({effects::title(one.effect), one.why});
  page.table(table);
}

void show_checks(pages::Page& page, const std::vector<evidence::Signature>& checks) {
  if (checks.empty()) return;
  page.heading("Checks without a model");
  page.paragraph("What the recordings alone say, before any simulation; value with its 95 % interval.");
  pages::Table table{.header = {"effect", "the recordings", "looked at", "value", ""}, .rows = {}};
  for (const evidence::Signature& check : checks) {
    const evidence::Interval& v = check.value;
    table.rows.push_back(
        {effects::title(check.effect),
         check.agreement == evidence::Agreement::kAgrees      ? "show it"
         : check.agreement == evidence::Agreement::kDisagrees ? "would show it, and don't"
                                                              : "can't tell",
         check.check,
         std::isfinite(v.value) ? fmt::format("{:.3g} ({:.3g} to {:.3g}) {}", v.value, v.low, v.high, check.unit) : "",
         check.sentence});
  }
  page.table(table);
}

}  // namespace

std::string verdict_text(const bench::Bench& bench, const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  std::vector<std::string> causes;
  for (const Cause& cause : diagnosis.causes) {
    std::string text = effects::title(cause.effect);
    for (const std::string& other : cause.same_here) text += " (on this rig the same as " + effects::title(other) + ")";
    for (const std::string& other : cause.or_instead) text += " or " + effects::title(other);
    causes.push_back(text);
  }
  std::string text;
  switch (diagnosis.verdict) {
    case evidence::Verdict::kFound:
      text = fmt::format("Found: {}", fmt::join(causes, ", "));
      break;
    case evidence::Verdict::kAmbiguous:
      text = fmt::format("Can't be told apart with these recordings: {}", fmt::join(causes, ", "));
      break;
    case evidence::Verdict::kNone:
      text = "Nothing beyond noise";
      break;
    case evidence::Verdict::kUnexplained:
      text = fmt::format("Something real that no effect of the catalogue explains{}{}",
                         diagnosis.depends_on.empty() ? "" : "; it depends on ", fmt::join(diagnosis.depends_on, ", "));
      if (!causes.empty()) text += fmt::format("; besides: {}", fmt::join(causes, ", "));
      break;
  }
  const std::string unit = calib::position_unit(bench, true);
  text += fmt::format(". Mean absolute error {} {} before, {} {} after, on {} {} runs",
                      thousandths(diagnosis.held_out_before), unit, thousandths(diagnosis.held_out_after), unit,
                      shown_runs(diagnosis, runs).size(), diagnosis.held_out ? "held-out" : "fitted (over folds)");
  if (diagnosis.noise_floor.mean_absolute_rad > 0.0 && diagnosis.verdict != evidence::Verdict::kNone) {
    text += fmt::format(": {:.0f} % of the way to the noise floor", 100.0 * diagnosis.share_of_way_to_floor);
  }
  return text;
}

pages::Page diagnosis_report(const bench::Bench& bench, const Diagnosis& diagnosis, const DiagnosedRuns& runs,
                             unsigned threads) {
  const std::vector<calib::SingleJoint>& shown = shown_runs(diagnosis, runs);
  pages::Page page(fmt::format("{}: what the simulation gets wrong", bench.folder.filename().string()));
  data_faults::show_faults(page, diagnosis.data);
  page.verdict(tone(diagnosis.verdict), verdict_text(bench, diagnosis, runs));
  if (const std::string odd = calib::odd_runs_text(diagnosis.noise_floor.odd_runs); !odd.empty())
    page.paragraph(odd + ".");
  if (!shown.empty()) {
    page.heading("What the simulation makes of the runs");
    show_runs(page, bench, diagnosis, shown, threads);
    show_residuals(page, bench, diagnosis, shown, threads);
  }
  show_causes(page, bench, diagnosis);
  if (diagnosis.next_excitation) show_next(page, *diagnosis.next_excitation);
  show_rejected(page, diagnosis.rejected);
  show_checks(page, runs.checks);
  return page;
}

}  // namespace pmg::diagnosis
