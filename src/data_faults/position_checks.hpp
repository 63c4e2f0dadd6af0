// Signs and units of positions and their commands that are wrong in all runs.
#pragma once

#include <vector>

#include "data_faults/examined.hpp"

namespace pmg::data_faults {

/// How a run's readings follow its commands, as a fault: none, turned, or in another unit.
struct Follows {
  bool known = false;   ///< they correlate
  bool turned = false;  ///< readings go the other way
  std::string unit;     ///< of the column that is in another unit, or ""
  bench::Column column = bench::Column::kPosition;
  double per_unit = 1.0;
  double slope = 0.0, correlation = 0.0;
};

Follows follows(const Examined& examined, const bench::BenchRun& run);

/// Of all runs. A fault is named only if the quick model follows the corrected
/// runs far better than the runs as they are.
std::vector<DataFault> position_faults(const Examined& examined);

}  // namespace pmg::data_faults
