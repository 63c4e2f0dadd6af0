// (a run's log) => a few figures, for the report's tables and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "report/run_series.hpp"
#include "work/worth.hpp"

namespace pmg::report {

/// Whether the drives followed the reference (mode stand or walk) at each of these increasing times. True if the log
/// has no modes.
std::vector<bool> holding(const RunSeries& run, std::span<const double> t_s);

/// Tracking errors against the command, and slip: the figures of summary.json in a sentence. Empty without ground
/// truth.
std::string tracking_text(const RunSeries& run);

/// The joint with the most limited ticks, the limits and the first time; empty if there is none.
std::string limited_text(const RunSeries& run);

/// Seconds in which the feet carried nothing, so that the policy did not run.
double hanging_s(const RunSeries& run);

/// Of what was read: interrupted, or partial where the log has problems. A page holds as far as its logs were read.
work::Worth worth_of_reading(const RunSeries& run);

/// Of the run, beside its reading: missed, where the robot fell or faulted; partial, where its command was cut; open,
/// where the log doesn't tell, or the feet carried nothing for most of the time.
work::Worth worth_of(const RunSeries& run);

/// One sentence: policy, duration, end, what was cut of its command, tracking and limits.
std::string verdict(const RunSeries& run);

/// The run's figures. `worth` is that of the whole, as its line of the page; `reading` is that of the reading alone.
nlohmann::ordered_json run_json(const RunSeries& run);

}  // namespace pmg::report
