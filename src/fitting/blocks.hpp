// Residuals of runs, cut into blocks of half a second that count as one observation each.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/least_squares.hpp"

namespace pmg::fitting {

/// Sums over one block after the other.
struct BlockSums {
  std::vector<double> values, samples;
  double mean() const;  ///< of all samples
};

/// How the runs' samples are cut. Residuals of one rollout hang together over time; a joint's motion forgets its
/// disturbance within half a second. Every sample is in one block; a rest shorter than half a block belongs to the
/// block before it.
class Blocks {
 public:
  static constexpr double kLength_s = 0.5;

  /// The next run: times [s], rising, and which of its samples are valid.
  void add_run(const std::vector<double>& t_s, const std::vector<bool>& valid);

  std::size_t count() const { return run_of_block_.size(); }
  const std::vector<std::size_t>& run_of_block() const { return run_of_block_; }
  const std::vector<double>& samples() const { return samples_; }  ///< valid ones of each block
  double all_samples() const { return all_samples_; }

  Eigen::VectorXd squares(const Residuals& residuals) const;  ///< of each block [rad^2]
  BlockSums absolutes(const Residuals& residuals) const;      ///< [rad]
  std::vector<NormalEquations> normal_equations(const Residuals& residuals, const Jacobian& jacobian) const;

 private:
  std::vector<std::vector<Eigen::Index>> starts_;  // of each run's blocks, with the run's end
  std::vector<std::size_t> run_of_block_;
  std::vector<double> samples_;
  double all_samples_ = 0.0;
};

}  // namespace pmg::fitting
