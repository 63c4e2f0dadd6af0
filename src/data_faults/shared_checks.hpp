// Numbers that several runs share: loads of bench.yaml, gains of runs.csv.
#pragma once

#include <vector>

#include "data_faults/examined.hpp"

namespace pmg::data_faults {

/// A load that doesn't weigh what bench.yaml says, beside others that do. The examined runs must have a fit.
std::vector<DataFault> mass_fault(const Examined& examined);

/// A gain that acts by a factor of its number: one value of it beside others, or all.
std::vector<DataFault> gain_fault(const Examined& examined);

/// The same beside a model that misses little, which stays as it is: the one value of three or more whose runs want
/// another factor than those of all others.
std::vector<DataFault> mass_fault_beside(const Examined& examined, const calib::JointModel& model);
std::vector<DataFault> gain_fault_beside(const Examined& examined, const calib::JointModel& model);

}  // namespace pmg::data_faults
