// Least squares whose observations hang together within clusters.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pmg::evidence {

/// What one more term adds to a regression that has the others already.
struct TermEstimate {
  double coefficient = 0.0, deviation = 0.0;  ///< one standard deviation, cluster-robust
  double t() const { return deviation > 0.0 ? coefficient / deviation : 0.0; }
  double share = 0.0;       ///< rms of what only this term adds, over the left-hand side's rms
  double share_sure = 0.0;  ///< the same with the coefficient two deviations farther from 0
  double own = 0.0;         ///< rms of the term that the others can't imitate, over its rms
};

/// y = columns * coefficients + error. Columns that the ones before them imitate to 1 % are left out.
class ClusterRegression {
 public:
  ClusterRegression(const std::vector<Eigen::VectorXd>& columns, const Eigen::VectorXd& y, std::vector<int> clusters);

  TermEstimate term(const Eigen::VectorXd& column) const;

  /// Of two terms together: their coefficients, and T^2 (chi-square with 2 degrees of freedom where neither is real).
  struct Pair {
    Eigen::Vector2d coefficients = Eigen::Vector2d::Zero();
    double t2 = 0.0, share = 0.0, own = 0.0;
  };
  Pair pair(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  std::size_t columns() const { return static_cast<std::size_t>(basis_.cols()); }
  int clusters() const { return clusters_count_; }

 private:
  Eigen::VectorXd without_columns(const Eigen::VectorXd& values) const;
  Eigen::MatrixXd basis_;  // orthonormal
  Eigen::VectorXd rest_;   // of y
  double rms_;             // of y
  std::vector<int> clusters_;
  int clusters_count_ = 0;
};

}  // namespace pmg::evidence
