// What differs from assembly to assembly, within a diagnosis.
#pragma once

#include "diagnosis/diagnosis.hpp"
#include "effects/extension.hpp"

namespace pmg::diagnosis {

/// (bench, fitted runs, scored runs, fitted model, the model without effects, mean square of the noise, columns that
/// follow the load too) => (what varies). Both lists of runs have it from then on, and nothing else of their
/// assemblies.
assembly::AssemblyDifferences told_apart(const bench::Bench& bench, std::vector<calib::SingleJoint>& fitted,
                                         std::vector<calib::SingleJoint>& scored, const effects::NestedModel& model,
                                         const calib::JointModel& neutral, double noise_squares, bool loads_too,
                                         unsigned threads, const assembly::AssemblyOptions& options);

/// Geometric mean of the blocks' mean squares beyond the noise [rad^2], of a linearised fit.
double usual_rest(const effects::NestedFit& fit, const effects::NestedModel& model, double noise_squares);

/// An effect whose strength differs from assembly to assembly about nothing is no cause of its own: it moves from the
/// causes to the rejected effects.
void leave_out_what_only_differs(Diagnosis& diagnosis, const effects::Forms& forms);

}  // namespace pmg::diagnosis
