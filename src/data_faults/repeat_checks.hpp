// What a run's repeats say of it, without a model: they had the same commands, gains and load.
#pragma once

#include <vector>

#include "data_faults/examined.hpp"

namespace pmg::data_faults {

/// Faults of single runs that are far from at least two repeats which agree: readings that are earlier or later than
/// those of all of them, and two runs that stand for each other, because each agrees with the other's repeats.
std::vector<DataFault> repeat_faults(const Examined& examined);

}  // namespace pmg::data_faults
