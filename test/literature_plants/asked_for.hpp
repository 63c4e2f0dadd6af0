// What a diagnosis asked for, on the bench of the same joint.
#pragma once

#include "diagnosis/diagnosis.hpp"
#include "planting.hpp"

namespace pmg::literature {

/// (plant, what was asked for) => the plant whose bench has those runs too, to be fitted: after the session, with the
/// load that is nearest.
LiteraturePlant with_asked_runs(LiteraturePlant plant, const diagnosis::NextExcitation& asked);

}  // namespace pmg::literature
