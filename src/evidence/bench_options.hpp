// Thresholds of rooms below, with their reasons.
#pragma once

#include <vector>

#include "bench/odd_runs.hpp"
#include "calib/step_choice.hpp"
#include "evidence/option.hpp"

namespace pmg::evidence {

/// Every number of the struct, in its order.
std::vector<Option> listed(const bench::OddRunOptions& options);
std::vector<Option> listed(const calib::StepOptions& options);

}  // namespace pmg::evidence
