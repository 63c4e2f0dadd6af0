// Readings that stand still while the joint moves: somebody else has the bus, and the reading before is recorded again.
#pragma once

#include <vector>

#include "bench/bench.hpp"
#include "data_faults/data_fault.hpp"
#include "data_faults/options.hpp"

namespace pmg::data_faults {

/// Of all runs, without a model. Other columns of the same bus (speed, torque) freeze as well; they stay as they are:
/// no residual is computed of them at samples without a reading.
std::vector<DataFault> frozen_readings(const std::vector<bench::BenchRun>& runs, bool linear,
                                       const DataFaultOptions& options);

}  // namespace pmg::data_faults
