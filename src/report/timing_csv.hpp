// The wall times of a lockstep run, which stand in a file beside its log.
#pragma once

#include <filesystem>

#include "report/run_series.hpp"

namespace pmg::report {

/// Adds the samples of a timing.csv (time_s,tick_us,generator_us,gco_us,policy_us) to run.timing; none if there is no
/// file.
void read_timing_csv(const std::filesystem::path& file, RunSeries& run);

}  // namespace pmg::report
