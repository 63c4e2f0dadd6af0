#include "evidence/signature.hpp"

#include <algorithm>
#include <utility>

#include "evidence/signature_checks.hpp"

namespace pmg::evidence {

const char* name(Agreement agreement) {
  switch (agreement) {
    case Agreement::kAgrees:
      return "agrees";
    case Agreement::kDisagrees:
      return "disagrees";
    case Agreement::kCannotTell:
      break;
  }
  return "can't tell";
}

namespace {

/// A rate limit also delays the onset of motion. Then only the torque balance, which knows the rate, can show a delay.
void doubt_onset(std::vector<Signature>& checks) {
  const bool limited = std::any_of(checks.begin(), checks.end(), [](const Signature& check) {
    return check.effect == "rate_limit" && check.agreement == Agreement::kAgrees;
  });
  Signature& onset = checks.front();
  if (!limited || onset.agreement != Agreement::kAgrees) return;
  onset.agreement = Agreement::kCannotTell;
  onset.sentence += "; the limited rate alone would look so";
}

}  // namespace

std::vector<Signature> signatures(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                  const SignatureOptions& options) {
  std::vector<Signature> found;
  if (runs.empty()) return found;
  found.push_back(step_onset_check(bench, runs, options));
  for (Signature& check : balance_checks(bench, runs, options)) found.push_back(std::move(check));
  for (Signature& check : rest_checks(bench, runs, options)) found.push_back(std::move(check));
  for (Signature& check : free_swing_checks(bench, runs, options)) found.push_back(std::move(check));
  found.push_back(quantum_check(runs, options));
  doubt_onset(found);
  return found;
}

}  // namespace pmg::evidence
