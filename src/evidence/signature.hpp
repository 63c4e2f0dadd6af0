// Checks of single effects on the recordings alone: no simulation, no fit of a rollout. What they see speaks for or
// against a cause that a fit names.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "evidence/signature_options.hpp"
#include "evidence/verdict.hpp"

namespace pmg::evidence {

enum class Agreement {
  kAgrees,     ///< the recordings show the effect; falsely in at most 2 % of recordings of a joint without it
  kDisagrees,  ///< they would show it, and don't
  kCannotTell,
};

/// agrees, disagrees, can't tell.
const char* name(Agreement agreement);

struct Signature {
  std::string effect;  ///< of the catalogue
  std::string check;   ///< what was looked at: "step onset", "balance of torques", ...
  Agreement agreement = Agreement::kCannotTell;
  Interval value;  ///< what was measured, with its 95 % interval; NaN where it couldn't be
  std::string unit;
  std::string sentence;  ///< for people, with the numbers
};

/// One for each check; where the runs don't have what it takes, it says what is missing. Effects that don't show
/// without a model have none, some have two. Friction and offsets that a check agrees with may well be in the model
/// already.
std::vector<Signature> signatures(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                  const SignatureOptions& options = {});

}  // namespace pmg::evidence
