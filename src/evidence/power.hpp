// What a model-free check would say of a simulated joint: its power to refute an effect, and the size that it would
// see.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/single_joint.hpp"
#include "evidence/signature.hpp"

namespace pmg::evidence {

/// (runs, model, seed) => (the same runs as the model moves them, with white noise of each recording's own sensor noise
/// and with its rounding). A run that can't be simulated keeps its readings.
std::vector<bench::BenchRun> simulated_runs(const std::vector<calib::SingleJoint>& runs, const calib::JointModel& model,
                                            double quantum_rad, unsigned seed);

/// Runs the checks of a bench again on simulations of it.
class CheckPower {
 public:
  /// Bench, runs and options must outlive it. quantum_rad: of the recorded readings, 0 for a fine sensor.
  CheckPower(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs, double quantum_rad,
             const SignatureOptions& options)
      : bench_(bench), runs_(runs), quantum_rad_(quantum_rad), options_(options) {}

  /// (effect, the joint with it at its fitted strength, the joint without it) => (true if a check refutes it). A check
  /// that disagrees refutes the effect if
  ///  - it doesn't disagree on the simulated bench with the effect: it has the power to see this strength,
  ///  - the recordings' value x lies within power.compatible_deviations of that without the effect, and
  ///  - log L(x | without) - log L(x | with) > power.refuting_log_ratio, with normal likelihoods whose variance is the
  ///    sum of the recorded value's and the simulated one's.
  /// Costs two rollouts of every run and three times the checks, once for each effect and pair of models.
  bool refutes(const std::string& effect, const calib::JointModel& with, const calib::JointModel& without);

  /// Every check on the simulated bench.
  std::vector<Signature> expected(const calib::JointModel& model) const;

 private:
  const std::vector<Signature>& recorded();

  const bench::Bench& bench_;
  const std::vector<calib::SingleJoint>& runs_;
  double quantum_rad_;
  const SignatureOptions& options_;
  std::vector<Signature> recorded_;  // empty until asked for
};

/// Standard deviation of a check's value.
double deviation(const Signature& check);

/// (check of the recordings, the same of the simulated joint) => (a sentence if their sizes differ: by
/// power.size_deviations, and by power.size_share of the larger; else nothing).
std::optional<std::string> size_conflict(const Signature& recorded, const std::vector<Signature>& expected,
                                         const PowerOptions& options);

}  // namespace pmg::evidence
