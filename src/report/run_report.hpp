// (one or more runs) => a page of pictures (docs/how-to/reports.md), with the verdict first.
#pragma once

#include <vector>

#include "pages/page.hpp"
#include "report/run_series.hpp"

namespace pmg::report {

inline constexpr std::size_t kMostRuns = 4;  ///< in one picture; a reader can distinguish no more

/// The pictures show the runs over each other, each from its own beginning. Throws std::invalid_argument for no run and
/// for more than kMostRuns.
pages::Page run_report(const std::vector<RunSeries>& runs);

}  // namespace pmg::report
