// Sign and unit of the torque that the drive is commanded: a feed-forward, or the command of a drive whose law is
// torque.
#pragma once

#include <vector>

#include "data_faults/examined.hpp"
#include "data_faults/run_evidence.hpp"

namespace pmg::data_faults {

/// The column of the commanded torque: torque_Nm under the law torque, else tau_ff_Nm.
bench::Column commanded_torque(const Examined& examined);

/// Sign and unit in all runs that have one. The examined runs must have a fit.
std::vector<DataFault> commanded_torque_fault(const Examined& examined);

/// Sign and unit in one run.
void try_commanded_torque(const Examined& examined, std::size_t run, std::vector<Explained>& into);

}  // namespace pmg::data_faults
