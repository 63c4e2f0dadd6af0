#include "diagnosis_page/residual_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/fit_results.hpp"
#include "diagnosis/residual.hpp"

namespace pmg::diagnosis_page {

namespace {

using diagnosis::Dependence;
using diagnosis::dependences;
using diagnosis::Diagnosis;
using diagnosis::residual_samples;
using diagnosis::residual_spectrum;
using diagnosis::ResidualBin;
using diagnosis::ResidualSpectrum;

/// Bins as a plot's columns [mrad, mm].
struct Columns {
  std::vector<double> at, mean;
  std::vector<pages::Interval> intervals;
};

Columns columns(const Dependence& dependence) {
  Columns found;
  for (const ResidualBin& bin : dependence.bins) {
    found.at.push_back(bin.at);
    found.mean.push_back(1e3 * bin.mean_rad.value);
    found.intervals.push_back({1e3 * bin.mean_rad.low, 1e3 * bin.mean_rad.high});
  }
  return found;
}

void show_dependence(pages::Page& page, const std::string& unit, const Dependence& before, const Dependence& after) {
  const Columns b = columns(before), a = columns(after);
  const auto percent = [](const Dependence& d) { return 100.0 * std::max(0.0, d.explained_share.value); };
  page.plot({.title = fmt::format("residual against {} [{}]; {} explains {:.0f} % of it before, {:.0f} % after",
                                  before.name, unit, before.name, percent(before), percent(after)),
             .x_name = fmt::format("{} [{}]", before.name, before.unit),
             .lines = {{.name = "before",
                        .x = b.at,
                        .y = b.mean,
                        .colour = pages::colour::kOrange,
                        .intervals = b.intervals,
                        .dashed = true,
                        .points = true},
                       {.name = "after",
                        .x = a.at,
                        .y = a.mean,
                        .colour = pages::colour::kBlue,
                        .intervals = a.intervals,
                        .points = true}},
             .show_zero = true});
}

std::vector<double> amplitude(const std::vector<double>& density_rad2_per_Hz) {
  std::vector<double> values;
  for (const double density : density_rad2_per_Hz) values.push_back(1e3 * std::sqrt(density));
  return values;
}

void show_spectrum(pages::Page& page, const std::string& unit, const ResidualSpectrum& before,
                   const ResidualSpectrum& after) {
  if (before.windows == 0) return;
  const std::vector<double> command = amplitude(before.command_rad2_per_Hz);
  const std::vector<double> b = amplitude(before.residual_rad2_per_Hz), a = amplitude(after.residual_rad2_per_Hz);
  const std::vector<double>& f = before.frequency_Hz;
  page.plot({.title = fmt::format("residual over frequency [{} per root Hz]", unit),
             .x_name = "frequency [Hz]",
             .lines = {{.name = "command", .x = f, .y = command, .colour = pages::colour::kGrey},
                       {.name = "residual before", .x = f, .y = b, .colour = pages::colour::kOrange, .dashed = true},
                       {.name = "residual after", .x = f, .y = a, .colour = pages::colour::kBlue}},
             .logarithmic_x = true,
             .logarithmic_y = true});
  page.plot(
      {.title = "share of the residual that is linear in the command (coherence)",
       .x_name = "frequency [Hz]",
       .lines = {{.name = "before", .x = f, .y = before.coherence, .colour = pages::colour::kOrange, .dashed = true},
                 {.name = "after", .x = f, .y = after.coherence, .colour = pages::colour::kBlue}},
       .logarithmic_x = true,
       .show_zero = true});
}

}  // namespace

void show_residuals(pages::Page& page, const bench::Bench& bench, const Diagnosis& diagnosis,
                    const std::vector<calib::SingleJoint>& runs, unsigned threads) {
  const std::vector<Dependence> before = dependences(residual_samples(bench, runs, diagnosis.before, threads));
  const std::vector<Dependence> after = dependences(residual_samples(bench, runs, diagnosis.after, threads));
  const std::string unit = calib::position_unit(bench, true);
  page.heading("What the residual depends on");
  page.paragraph(
      "The residual is simulated minus measured position. Each point is its mean over one range of the quantity, with "
      "its 95 % interval. A flat line at zero means that nothing of the residual comes with this quantity. The share "
      "in the title says how well the means of one half of the recordings predict the other half.");
  page.columns([&] {
    for (const Dependence& dependence : before) {
      const auto same = std::find_if(after.begin(), after.end(),
                                     [&](const Dependence& other) { return other.name == dependence.name; });
      if (same != after.end()) show_dependence(page, unit, dependence, *same);
    }
    show_spectrum(page, unit, residual_spectrum(runs, diagnosis.before), residual_spectrum(runs, diagnosis.after));
  });
}

}  // namespace pmg::diagnosis_page
