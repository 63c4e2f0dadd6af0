// The wall times that a lockstep run keeps beside its log.
#pragma once

#include <filesystem>

#include "report/run_series.hpp"

namespace pmg::report {

/// Adds to run.timing what a timing.csv (time_s,tick_us,generator_us,gco_us,policy_us) holds; nothing when there is
/// none.
void read_timing_csv(const std::filesystem::path& file, RunSeries& run);

}  // namespace pmg::report
