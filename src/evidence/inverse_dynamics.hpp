// A joint's inertia and friction from its recorded drive output, by the balance of torques.
#pragma once

#include <optional>
#include <vector>

#include "bench/bench.hpp"
#include "calib/inverse_dynamics.hpp"
#include "evidence/signature_options.hpp"

namespace pmg::evidence {

/// (bench, runs) => (estimates): least squares of
///   recorded torque - load = armature ddq + viscous dq + coulomb direction - offset,
/// each integrated over the windows of TorqueBalance; deviations are robust to correlation within a second. Empty
/// without recorded drive_V or torque, with an unknown torque_per_unit, with fewer stretches of motion than
/// fewest_clusters, or where one term can't be told from the others.
std::optional<calib::InverseDynamics> inverse_dynamics(const bench::Bench& bench,
                                                       const std::vector<bench::BenchRun>& runs,
                                                       const SignatureOptions& options = {});

}  // namespace pmg::evidence
