// The checks that signatures() is made of.
#pragma once

#include <vector>

#include "evidence/command_shape.hpp"
#include "evidence/signature.hpp"

namespace pmg::evidence {

/// Regressions of the equation of motion (TorqueBalance): friction of every kind, gain, load, cogging, backlash, ...
std::vector<Signature> balance_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                      const SignatureOptions& options);

/// (best command shape, sample time) => (checks for delay and rate_limit).
std::vector<Signature> command_shape_checks(const FoundShape& shape, double sample_s, const ShapeOptions& options);

/// A pendulum with its drive off: Coulomb friction lowers the amplitude linearly, viscous friction exponentially.
std::vector<Signature> free_swing_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                         const SignatureOptions& options);

/// Dead time from a step of the command to the onset of motion.
Signature step_onset_check(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                           const SignatureOptions& options);

/// Steady-state error: proportional to 1 / gain under Coulomb friction, independent of the gain in a dead band.
std::vector<Signature> rest_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                   const SignatureOptions& options);

/// Whether readings are multiples of one number.
Signature quantum_check(const std::vector<bench::BenchRun>& runs, const SignatureOptions& options);

}  // namespace pmg::evidence
