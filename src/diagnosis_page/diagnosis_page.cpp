#include "diagnosis_page/diagnosis_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "assembly/parameters.hpp"
#include "calib/fit_results.hpp"
#include "data_faults/data_faults_report.hpp"
#include "diagnosis_page/assemblies.hpp"
#include "diagnosis_page/effect_tables.hpp"
#include "diagnosis_page/first_paragraph.hpp"
#include "diagnosis_page/residual_pictures.hpp"
#include "diagnosis_page/run_pictures.hpp"
#include "effects/catalogue.hpp"
#include "evidence/thresholds.hpp"
#include "residual_torque/extension_report.hpp"

namespace pmg::diagnosis_page {

namespace {

using diagnosis::Cause;
using diagnosis::DiagnosedRuns;
using diagnosis::Diagnosis;
using diagnosis::ExpectedPair;
using diagnosis::NextExcitation;
using diagnosis::NextRun;

const std::vector<calib::SingleJoint>& judged_runs(const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  return diagnosis.held_out && !runs.scored.empty() ? runs.scored : runs.fitted;
}

std::string thousandths(double value_rad) { return fmt::format("{:.3g}", 1e3 * value_rad); }

std::string thousandths(const evidence::Interval& interval) {
  return fmt::format("{} ({} to {})", thousandths(interval.value), thousandths(interval.low),
                     thousandths(interval.high));
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
    bars.names.push_back("without " + effects::title(cause.effect));
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
    page.paragraph(fmt::format(
        "The simulation's step is {:.3g} ms ({}). With the model before, which misses the readings by {} {} "
        "on average, the integrator's error is {} {} rms; with the causes it was not measured.",
        1e3 * diagnosis.step.error.step_s, name(diagnosis.step.limit), thousandths(diagnosis.held_out_before.value),
        calib::position_unit(bench, true), thousandths(diagnosis.step.error.rms_rad),
        calib::position_unit(bench, true)));
  }
  diagnosis::JointDiagnosisOptions joint = diagnosis.options;
  data_faults::DataFaultOptions data = diagnosis.data.options;
  if (const auto set = evidence::set_by_hand(diagnosis::rows(joint, data)); !set.empty())
    page.paragraph(fmt::format("Thresholds set by hand: {}.", fmt::join(set, ", ")));
}

std::string parameter_lines(const Cause& cause) {
  std::string text;
  for (const evidence::ParameterEstimate& p : cause.parameters) {
    text += fmt::format("{}{} = {}", text.empty() ? "" : "; ", p.name, evidence::text_of(p.estimate, p.unit, 4));
  }
  return text;
}

std::string other_names(const Cause& cause) {
  std::vector<std::string> names;
  for (const std::string& other : cause.or_instead) names.push_back(effects::title(other));
  for (const std::string& other : cause.same_here) names.push_back("on this rig the same: " + effects::title(other));
  return fmt::format("{}", fmt::join(names, "; "));
}

void show_causes(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis) {
  const std::string unit = calib::position_unit(bench, true);
  page.heading("Causes");
  if (diagnosis.causes.empty()) page.paragraph("No effect of the catalogue is named.");
  pages::Table table{.header = {"effect", "parameters, with 95 % intervals", "error without it [" + unit + "]",
                                "error with it [" + unit + "]", "could also be"},
                     .rows = {}};
  for (const Cause& cause : diagnosis.causes) {
    table.rows.push_back({effects::described(cause.effect, cause.form, cause.form_or_instead), parameter_lines(cause),
                          thousandths(cause.held_out_error_before), thousandths(cause.held_out_error_after),
                          other_names(cause)});
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
  pages::Table table{.header = {"two effects", "expected difference [standard deviations]"}, .rows = {}};
  for (const ExpectedPair& pair : next.pairs) {
    table.rows.push_back({fmt::format("{}, {}", effects::title(pair.first), effects::title(pair.second)),
                          fmt::format("{:.1f}", pair.deviations)});
  }
  page.table(table);
}

/// The causes, and what differs from assembly to assembly, in words.
struct NamedCauses {
  std::vector<std::string> open;  ///< which of two names it is the recordings don't tell
  std::vector<std::string> told;
  std::vector<std::string> all() const {
    std::vector<std::string> both = open;
    both.insert(both.end(), told.begin(), told.end());
    return both;
  }
};

NamedCauses named_causes(const Diagnosis& diagnosis, const std::string& unit) {
  NamedCauses found;
  for (const Cause& cause : diagnosis.causes) {
    std::string text = effects::described(cause.effect, cause.form, cause.form_or_instead);
    for (const std::string& other : cause.same_here) text += " (on this rig the same as " + effects::title(other) + ")";
    for (const std::string& other : cause.or_instead) text += " or " + effects::title(other);
    text += fmt::format(" ({} {} without it)", thousandths(cause.held_out_error_before), unit);
    (cause.or_instead.empty() ? found.told : found.open).push_back(text);
  }
  for (const assembly::Variation& one : diagnosis.assemblies.varies)
    found.told.push_back(
        fmt::format("{} by column {}", assembly::title(one.parameter), assembly::columns_text(one.columns)));
  return found;
}

}  // namespace

std::string verdict_text(const bench::Bench& bench, const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  const std::string unit = calib::position_unit(bench, true);
  const NamedCauses causes = named_causes(diagnosis, unit);
  std::string text;
  switch (diagnosis.verdict) {
    case evidence::Verdict::kFound:
      text = fmt::format("Found: {}", fmt::join(causes.all(), ", "));
      break;
    case evidence::Verdict::kAmbiguous:
      if (!causes.told.empty()) text = fmt::format("Found: {}. ", fmt::join(causes.told, ", "));
      text += fmt::format("Open, as these recordings don't tell which: {}", fmt::join(causes.open, "; "));
      break;
    case evidence::Verdict::kNone:
      text = "Nothing beyond noise";
      break;
    case evidence::Verdict::kUnexplained:
      text = fmt::format("Something real that no effect of the catalogue explains{}{}",
                         diagnosis.depends_on.empty() ? "" : "; it depends on ", fmt::join(diagnosis.depends_on, ", "));
      if (!causes.all().empty()) text += fmt::format("; besides: {}", fmt::join(causes.all(), ", "));
      break;
    case evidence::Verdict::kInterrupted:
      text = fmt::format("Interrupted: nothing is settled{}{}",
                         causes.all().empty() ? "" : "; suspected until then: ", fmt::join(causes.all(), ", "));
      break;
  }
  text += fmt::format(". Mean absolute error {} {} before, {} {} after, on {} {} runs",
                      thousandths(diagnosis.held_out_before), unit, thousandths(diagnosis.held_out_after), unit,
                      judged_runs(diagnosis, runs).size(), diagnosis.held_out ? "held-out" : "fitted (over folds)");
  if (diagnosis.noise_floor.mean_absolute_rad > 0.0 && diagnosis.verdict != evidence::Verdict::kNone &&
      diagnosis.verdict != evidence::Verdict::kInterrupted) {
    text += fmt::format(": {:.0f} % of the way to the noise floor",
                        100.0 * std::clamp(diagnosis.share_of_way_to_floor, 0.0, 1.0));
  }
  return text;
}

pages::Page page_of(const bench::Bench& bench, const Diagnosis& diagnosis, const DiagnosedRuns& runs,
                    unsigned threads) {
  const std::vector<calib::SingleJoint>& judged = judged_runs(diagnosis, runs);
  pages::Page page(fmt::format("{}: the joint and its simulation", bench.folder.filename().string()));
  page.worth(worth_of(diagnosis));
  data_faults::show_faults(page, diagnosis.data);
  page.verdict({}, first_paragraph(bench, diagnosis));
  page.paragraph(verdict_text(bench, diagnosis, runs) + ".");
  if (const std::string odd = calib::odd_runs_text(diagnosis.noise_floor.odd_runs); !odd.empty())
    page.paragraph(odd + ".");
  show_what_to_check(page, diagnosis);
  show_causes(page, bench, diagnosis);
  if (diagnosis.residual_extension)
    residual_torque::show_extension(page, *diagnosis.residual_extension, calib::position_unit(bench, true));
  show_assemblies(page, diagnosis);
  if (diagnosis.next_excitation) show_next(page, *diagnosis.next_excitation);
  show_runs(page, bench, diagnosis, runs, threads);
  if (!judged.empty()) show_residuals(page, bench, diagnosis, judged, threads);
  show_no_causes(page, diagnosis, runs);
  show_checks(page, diagnosis, runs);
  return page;
}

}  // namespace pmg::diagnosis_page
