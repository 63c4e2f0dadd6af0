// Fits of nested models to a bench's runs, by Gauss-Newton steps with Levenberg's and Marquardt's damping: a rollout is
// smooth enough in most parameters, and the same derivatives serve folds, intervals and screening.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/unknowns.hpp"

namespace pmg::diagnosis {

/// Normal equations of half a second of one run: misses within one hang together, so it counts as one observation.
struct BlockNormal {
  Eigen::MatrixXd information;  ///< J^T J
  Eigen::VectorXd gradient;     ///< J^T r
  double squares = 0.0;         ///< r^T r
  double samples = 0.0;
};

/// A fitted model. Coordinates are those of the unknowns.
struct NestedModel {
  calib::JointModel model;
  std::vector<Unknown> unknowns;
  Eigen::VectorXd coordinates;
  double squares = 0.0;             ///< over all valid samples [rad^2]
  std::vector<BlockNormal> blocks;  ///< at the model; empty unless linearised
  double prior_weight = 0.0;        ///< of what calibrations say of the unknowns, in squares [rad^2]; 0 for no say
};

/// The model moved to other coordinates.
calib::JointModel model_at(const NestedModel& model, const Eigen::VectorXd& coordinates);

/// What calibrations say, as one more block: weight * ((coordinate - expected) / deviation)^2 for each unknown.
BlockNormal prior(const NestedModel& model);

/// Misses (simulated minus measured reading), a vector a run; zero where the sensor dropped out.
using Misses = std::vector<Eigen::VectorXd>;

/// Sums of absolute misses, and valid samples, by block.
struct BlockErrors {
  std::vector<double> absolutes, samples;
  double mean() const;
};

/// d miss / d coordinate, a matrix a run with a column an unknown.
struct Slopes {
  std::vector<Unknown> unknowns;
  std::vector<Eigen::MatrixXd> of_run;
};

class NestedFit {
 public:
  static constexpr double kBlock_s = 0.5;

  NestedFit(std::vector<calib::SingleJoint> runs, unsigned threads);

  const std::vector<calib::SingleJoint>& runs() const { return runs_; }
  double samples() const { return samples_; }
  /// The run that each block is of.
  const std::vector<std::size_t>& run_of_block() const { return run_of_block_; }

  /// Empty where the simulation refuses the model.
  Misses misses(const calib::JointModel& model) const;
  double squares(const Misses& misses) const;
  std::vector<double> samples_by_block() const;
  Eigen::VectorXd squares_by_block(const Misses& misses) const;
  BlockErrors absolutes_by_block(const Misses& misses) const;

  /// From the start's values; never worse than the start. borrowed: see slopes; prior_weight: see NestedModel.
  NestedModel fit(const calib::JointModel& start, const std::vector<Unknown>& unknowns, int most_iterations,
                  const Slopes* borrowed = nullptr, double prior_weight = 0.0) const;
  /// Fills the model's blocks.
  void linearise(NestedModel& model, const Slopes* borrowed = nullptr) const;
  /// By differences. Unknowns that borrowed has as well take its columns: those of a model nearby do for a first look,
  /// at the cost of the others alone.
  Slopes slopes(const NestedModel& model, const Misses& misses, const Slopes* borrowed = nullptr) const;
  int evaluations() const { return evaluations_; }

 private:
  double valid_samples(std::size_t run, std::size_t block) const;

  std::vector<calib::SingleJoint> runs_;
  unsigned threads_;
  double samples_ = 0.0;
  std::vector<std::vector<Eigen::Index>> block_starts_;  // of each run, with its end
  std::vector<std::size_t> run_of_block_;
  mutable int evaluations_ = 0;
};

/// The step from the coordinates that minimises the linearised squares within the unknowns' ranges.
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                             const std::vector<Unknown>& unknowns, const Eigen::VectorXd& coordinates, double damping);

}  // namespace pmg::diagnosis
