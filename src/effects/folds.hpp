// Which blocks of a bench's runs are left out together.
#pragma once

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// Folds of all blocks of one gain, of one load, or of one trajectory: every block is in one fold of each kind. A kind
/// of which the runs have one value only is left out; where all are, four stretches of time ("time") take their place.
std::vector<fitting::Fold> folds(const NestedFit& fit);

}  // namespace pmg::effects
