// Faults of single runs: what the model that fits all runs says of one of them.
#pragma once

#include <vector>

#include "data_faults/examined.hpp"

namespace pmg::data_faults {

/// The clearest wrong sign or unit of one run's positions or commands; empty if there is none. The examined runs must
/// have a fit.
std::vector<DataFault> clearest_position_fault(const Examined& examined);

/// The clearest of the subtler faults of one run, or of two that stand for each other: its row of runs.csv, a time
/// between its columns, the sign of its feed-forward.
std::vector<DataFault> clearest_run_fault(const Examined& examined);

}  // namespace pmg::data_faults
