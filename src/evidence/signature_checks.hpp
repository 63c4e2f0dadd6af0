// The checks that signatures() is made of.
#pragma once

#include <vector>

#include "evidence/command_shape.hpp"
#include "evidence/signature.hpp"

namespace pmg::evidence {

/// Regressions of the equation of motion (TorqueBalance): friction of every kind, gain, load, cogging, backlash, ...
std::vector<Signature> balance_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                      const SignatureOptions& options);

/// (best delay and rate limit of a command, time of a sample) => (checks for delay and rate_limit).
std::vector<Signature> command_shape_checks(const FoundShape& shape, double sample_s);

/// How a hanging load loses its swing while the drive is off: by Coulomb friction evenly, by viscous friction in
/// proportion.
std::vector<Signature> free_swing_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                         const SignatureOptions& options);

/// When readings begin to move after a step of the command.
Signature step_onset_check(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs);

/// Where the joint comes to rest short of its command: by 1/gain under friction, whatever the gain in a dead band.
std::vector<Signature> rest_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                   const SignatureOptions& options);

/// Whether readings are multiples of one number.
Signature quantum_check(const std::vector<bench::BenchRun>& runs, const SignatureOptions& options);

}  // namespace pmg::evidence
