// Blocks: half-second pieces of the runs. Each counts as one observation of a fit.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/least_squares.hpp"

namespace pmg::fitting {

/// Sum of a quantity, and number of valid samples, of each block.
struct BlockSums {
  std::vector<double> values, samples;
  double mean() const;  ///< over all samples
};

/// Cuts runs into blocks. Residuals of a rollout are correlated over time, up to about half a second after a
/// disturbance. Every sample is in one block; a remainder shorter than half a block joins the block before it.
class Blocks {
 public:
  static constexpr double kLength_s = 0.5;

  /// Adds the next run: increasing times [s], and which of its samples are valid.
  void add_run(const std::vector<double>& t_s, const std::vector<bool>& valid);

  std::size_t count() const { return run_of_block_.size(); }
  const std::vector<std::size_t>& run_of_block() const { return run_of_block_; }
  const std::vector<double>& samples() const { return samples_; }  ///< valid ones of each block
  double all_samples() const { return all_samples_; }

  Eigen::VectorXd squares(const Residuals& residuals) const;  ///< of each block [rad^2]
  BlockSums absolutes(const Residuals& residuals) const;      ///< sums of |residual| [rad]
  std::vector<NormalEquations> normal_equations(const Residuals& residuals, const Jacobian& jacobian) const;

 private:
  std::vector<std::vector<Eigen::Index>> starts_;  // first sample of each block of a run, then the run's end
  std::vector<std::size_t> run_of_block_;
  std::vector<double> samples_;
  double all_samples_ = 0.0;
};

}  // namespace pmg::fitting
