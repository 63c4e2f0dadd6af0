// Times between commands and readings that no drive explains.
#pragma once

#include <string>
#include <vector>

#include "data_faults/run_evidence.hpp"

namespace pmg::data_faults {

/// Readings of one run that are early or late, where those of similar runs are not. The examined runs must have a fit.
void try_shifts(const Examined& examined, std::vector<Explained>& into);

/// The readings of a run as late by lag_s, early where that is negative.
DataFault shifted_readings(const Examined& examined, std::size_t run, double lag_s, std::vector<std::string> evidence);

/// In all runs: readings before their commands, or later than a drive's delay; empty if there is none.
std::vector<DataFault> common_shift(const Examined& examined);

}  // namespace pmg::data_faults
