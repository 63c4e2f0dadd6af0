// A quick, robust model of a joint whose positions are commanded: a robust fit; one faulty run has little influence.
#pragma once

#include <optional>
#include <vector>

#include "bench/bench.hpp"
#include "calib/single_joint.hpp"
#include "effects/unknowns.hpp"

namespace pmg::data_faults {

/// Factors on numbers of bench.yaml and runs.csv, one for each run.
struct RunFactors {
  double kp = 1.0, kd = 1.0, load = 1.0, commanded_torque = 1.0;
};

/// (model, factors of a run) => (the model with which the run's rollout has them).
calib::JointModel with_factors(calib::JointModel model, const RunFactors& factors);

/// One unknown factor that some runs share: of a gain, of a load (inertia and gravity), or of the torque that the drive
/// is commanded.
struct SharedFactor {
  double RunFactors::*of = &RunFactors::kp;
  std::vector<std::size_t> runs;
  double deviation = 0.0;  ///< of the factor's logarithm around 0: a normal prior; none if 0
};

struct QuickFit {
  calib::JointModel model;
  std::vector<std::string> extra{};  ///< further free parameters: of a rate limit, or of one effect of the catalogue
  std::vector<double> factors{};     ///< in the order of the shared factors
  std::vector<double> log_error{};   ///< of each run: ln of the rollout's root mean square error [rad], noise included
  double loss = 0.0;                 ///< mean of log_error
  /// loss, and what the parameters' distance from what is known of them costs, in the same unit.
  double loss_with_prior = 0.0;
};

/// Twice the logarithm by which a fit is likelier than another one of the same runs, what is known of the joint
/// counted.
double evidence(const QuickFit& fit, const QuickFit& other);

/// Gravity load, inertia, dry and viscous friction, drive law, dead time, rate limit, constant torque: the parameters
/// that every bench shows. Weights of runs are 1 / error, so that the loss is the mean logarithm of the runs' errors
/// and one bad run decides nothing.
class QuickModel {
 public:
  /// given: the simulation's model, or none. The bench must outlive the object.
  QuickModel(const bench::Bench& bench, const std::optional<model::ActuatorParameters>& given, unsigned threads);

  /// What the joint is taken for before any fit: the given model, or what bench.yaml knows.
  const model::ActuatorParameters& start() const { return start_.actuator; }

  calib::SingleJoint joint(const bench::BenchRun& run) const { return {*bench_, run, step_s_}; }
  std::vector<calib::SingleJoint> joints(const std::vector<bench::BenchRun>& runs) const;

  /// (runs) => (fit from scratch).
  QuickFit fit(const std::vector<calib::SingleJoint>& runs) const;
  /// (runs, fit nearby, shared factors) => (fit with these factors free). most_iterations: of each of three rounds.
  QuickFit refit(const std::vector<calib::SingleJoint>& runs, const QuickFit& from,
                 const std::vector<SharedFactor>& shared, int most_iterations = 6) const;

  /// The fit with that effect of the catalogue in it that explains the runs best; the fit itself if none does. What
  /// still stands beside it is no trace of that effect.
  QuickFit with_best_effect(const std::vector<calib::SingleJoint>& runs, const QuickFit& fit) const;

  /// ln of the root mean square error [rad] of one run's rollout, noise included.
  double log_error(const calib::SingleJoint& joint, const calib::JointModel& model) const;
  std::vector<double> log_errors(const std::vector<calib::SingleJoint>& joints, const calib::JointModel& model) const;

 private:
  calib::Unknowns unknowns(const std::vector<calib::SingleJoint>& runs, const std::vector<std::string>& extra) const;
  calib::JointModel screened(const std::vector<calib::SingleJoint>& runs, const calib::Unknowns& unknowns) const;
  QuickFit minimised(const std::vector<calib::SingleJoint>& runs, const calib::Unknowns& unknowns, const QuickFit& from,
                     const std::vector<SharedFactor>& shared, int most_iterations) const;
  QuickFit with_rate_limit(const std::vector<calib::SingleJoint>& runs, const QuickFit& fit) const;
  QuickFit at(const std::vector<calib::SingleJoint>& runs, QuickFit fit) const;

  const bench::Bench* bench_;
  calib::JointModel start_;
  bool given_;
  unsigned threads_;
  double step_s_;
};

}  // namespace pmg::data_faults
