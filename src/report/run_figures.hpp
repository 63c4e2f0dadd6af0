// A run's log in a few figures, for the report's tables and for machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "report/run_series.hpp"

namespace pmg::report {

/// Whether the drives followed the reference at each of these increasing times: mode stand or walk. Always, when the
/// log says nothing of modes.
std::vector<bool> holding(const RunSeries& run, std::span<const double> t_s);

struct JointTracking {
  double error_rms_rad = 0.0;  ///< of q_ref - q while holding; 0 without a single such tick
  double torque_max_Nm = 0.0;  ///< of its absolute value
};
std::vector<JointTracking> joint_tracking(const RunSeries& run);

/// Errors against what was asked, and slip: the figures of summary.json in a sentence. Empty without a simulation's
/// truth.
std::string tracking_text(const RunSeries& run);

/// The joint that was limited most, by what and since when; empty when the log names none.
std::string limited_text(const RunSeries& run);

/// For how long the feet carried nothing, so that the policy was not run.
double hanging_s(const RunSeries& run);

/// What ran, how long, how it ended, how well it followed and what limited it.
std::string verdict(const RunSeries& run);

nlohmann::ordered_json run_json(const RunSeries& run);

}  // namespace pmg::report
