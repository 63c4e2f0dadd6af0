// Faults of single runs: what the model that fits all runs says of one of them.
#pragma once

#include <vector>

#include "data_faults/examined.hpp"

namespace pmg::data_faults {

/// One round: the clearest fault of a run, or of two runs that stand for each other; empty if there is none. The
/// examined runs must have a fit.
std::vector<DataFault> clearest_run_fault(const Examined& examined);

/// A time between commands and readings that no drive's delay explains, in all runs; empty if there is none.
std::vector<DataFault> common_shift(const Examined& examined);

}  // namespace pmg::data_faults
