// The checks that signatures() is made of.
#pragma once

#include <vector>

#include "evidence/signature.hpp"

namespace pmg::evidence {

/// Regressions of the equation of motion (TorqueBalance): friction of every kind, gain, load, cogging, backlash, ...
std::vector<Signature> balance_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs);

/// How a hanging load loses its swing while the drive is off: by Coulomb friction evenly, by viscous friction in
/// proportion.
std::vector<Signature> free_swing_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs);

/// When readings begin to move after a step of the command.
Signature step_onset_check(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs);

/// Where the joint comes to rest short of its command: by 1/gain under friction, whatever the gain in a dead band.
std::vector<Signature> rest_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs);

/// Whether readings are multiples of one number.
Signature quantum_check(const std::vector<bench::BenchRun>& runs);

}  // namespace pmg::evidence
