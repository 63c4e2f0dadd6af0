// The report's sections, one function each. A section without data says so.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "pages/page.hpp"
#include "report/run_series.hpp"

namespace pmg::report {

using Runs = std::vector<RunSeries>;

/// Colours of one run's lines.
struct Palette {
  const char *measured, *asked, *admissible, *optimised;
};
const Palette& palette(std::size_t run);

/// " B" behind a line's name if there are several runs.
std::string suffix(const Runs& runs, std::size_t run);

/// Bands behind the lines, where a controller was in a fault.
std::vector<pages::Band> fault_bands(const Runs& runs);

/// The values with NaN where the drives did not follow the reference, because the reference has no meaning there.
std::vector<double> followed(const RunSeries& run, std::span<const double> t_s, std::vector<double> values);

/// A line of one run; without a point it isn't drawn.
struct RunLine {
  std::string name;  ///< the chart adds the run's suffix
  std::span<const double> x;
  std::vector<double> y;
  std::string colour;
  double width_px = 1.3;
  bool dashed = false, stepped = false;
  double widens_from = -std::numeric_limits<double>::infinity(), widens_to = std::numeric_limits<double>::infinity();
};

/// One chart with the lines of all runs: lines_of(number of a run) gives that run's. No chart if there is no line.
void chart_of_runs(pages::Page& page, const Runs& runs, const std::string& title,
                   const std::function<std::vector<RunLine>(std::size_t)>& lines_of, int height_px = 200);

void verdicts(pages::Page& page, const Runs& runs);
void timeline(pages::Page& page, const Runs& runs);
void commands(pages::Page& page, const Runs& runs);
void contact_and_slip(pages::Page& page, const Runs& runs);
void joints(pages::Page& page, const Runs& runs);
void limits_and_temperatures(pages::Page& page, const Runs& runs);
void timing(pages::Page& page, const Runs& runs);
void who_ran_what(pages::Page& page, const Runs& runs);

}  // namespace pmg::report
