// Rows of runs.csv with the gains and the load of other rows.
#pragma once

#include <vector>

#include "data_faults/run_evidence.hpp"

namespace pmg::data_faults {

/// Two rows that stand for each other, and single rows that were recorded like others. The examined runs must have a
/// fit.
std::vector<Explained> row_explanations(const Examined& examined);

/// The lowest ln error of a run with the gains and load of any other row; infinite if all rows have the same.
double lowest_log_error_of_rows(const Examined& examined, std::size_t run);

}  // namespace pmg::data_faults
