// Model-free checks: each looks for one effect in the recordings alone, without a simulation. Their results support or
// contradict the causes that a fit names.
#pragma once

#include <string>
#include <vector>

#include "bench/bench.hpp"
#include "evidence/signature_options.hpp"
#include "evidence/verdict.hpp"

namespace pmg::evidence {

enum class Agreement {
  kAgrees,     ///< the recordings show the effect; at most 2 % false alarms on joints without it
  kDisagrees,  ///< the recordings should show the effect and do not
  kCannotTell,
};

/// agrees, disagrees, can't tell.
const char* name(Agreement agreement);

struct Signature {
  std::string effect;  ///< of the catalogue
  std::string check;   ///< the method: "step onset", "balance of torques", ...
  Agreement agreement = Agreement::kCannotTell;
  Interval value;  ///< the measured value with its 95 % interval; NaN if it could not be measured
  std::string unit;
  std::string sentence;  ///< for people, with the numbers
};

/// (bench, runs) => (one result per check). Where the runs cannot answer a check, its sentence says what is missing.
/// Some effects have two checks; effects that need a model have none. A check detects everything that the joint has,
/// also the friction and the offsets that the model already contains.
std::vector<Signature> signatures(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                  const SignatureOptions& options = {});

}  // namespace pmg::evidence
