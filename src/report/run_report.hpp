// One or more runs as a page of pictures (docs/how-to/reports.md): how it went, at a glance, before any number.
#pragma once

#include <vector>

#include "pages/page.hpp"
#include "report/run_series.hpp"

namespace pmg::report {

inline constexpr std::size_t kMostRuns = 4;  ///< that one picture can hold and a reader can tell apart

/// The runs are laid over each other, each counted from its own beginning. Throws std::invalid_argument for none or
/// more than kMostRuns.
pages::Page run_report(const std::vector<RunSeries>& runs);

}  // namespace pmg::report
