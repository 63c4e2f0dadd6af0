// The report's sections, one function each. A section says so when no run has what it needs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "logs/run_series.hpp"
#include "pages/page.hpp"

namespace pmg::logs::report {

using Runs = std::vector<RunSeries>;

inline constexpr double kLongestGap_s = 0.1;  ///< ten ticks: over more nothing is drawn

/// Colours of one run's lines.
struct Palette {
  const char *measured, *asked, *admissible, *optimised;
};
const Palette& palette(std::size_t run);

/// " B" behind a line's name when there are several runs.
std::string suffix(const Runs& runs, std::size_t run);

/// Whether the drives were in a fault, behind the lines.
std::vector<pages::Band> fault_bands(const Runs& runs);

/// values with NaN where the drives did not follow the reference: then it says nothing.
std::vector<double> followed(const RunSeries& run, std::span<const double> t_s, std::vector<double> values);

/// Adds the chart unless it has no line.
void add_chart(pages::Page& page, const Runs& runs, const std::string& title, std::vector<pages::Line> lines,
               int height_px = 200);

void verdicts(pages::Page& page, const Runs& runs);
void timeline(pages::Page& page, const Runs& runs);
void commands(pages::Page& page, const Runs& runs);
void contact_and_slip(pages::Page& page, const Runs& runs);
void joints(pages::Page& page, const Runs& runs);
void limits_and_temperatures(pages::Page& page, const Runs& runs);
void timing(pages::Page& page, const Runs& runs);
void who_ran_what(pages::Page& page, const Runs& runs);

}  // namespace pmg::logs::report
