// Folds for cross-validation: which blocks of a bench's runs are left out together.
#pragma once

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// (fit) => (folds): by gain, by load and by trajectory, at most eight of each kind. Each block is in one fold of each
/// kind. A kind with a single value is left out; without any kind, each run is cut into four stretches of time
/// ("time").
std::vector<fitting::Fold> folds(const NestedFit& fit);

}  // namespace pmg::effects
