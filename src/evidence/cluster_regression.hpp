// Least squares with observations that are correlated within clusters.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pmg::evidence {

/// One more term added to a regression. u is the part of its column orthogonal to the other columns, r the residual of
/// y without the term.
struct TermEstimate {
  /// b = u.r / u.u, and its cluster-robust standard deviation sqrt(n / (n - p - 1) * sum over the n clusters of
  /// (sum of u_i e_i)^2) / u.u, with e = r - b u and p other columns (K.-Y. Liang, S. L. Zeger, Biometrika 73:13,
  /// 1986).
  double coefficient = 0.0, deviation = 0.0;
  double t() const { return deviation > 0.0 ? coefficient / deviation : 0.0; }
  double share = 0.0;        ///< |b| rms(u) / rms(y)
  double share_upper = 0.0;  ///< upper bound of share: (|b| + 2 deviations) rms(u) / rms(y)
  double own = 0.0;          ///< rms(u) / rms(column): 0 for a linear combination of the other columns
};

/// y = columns * coefficients + error. A column is left out if a linear combination of the columns before it leaves at
/// most collinear_share of its norm.
class ClusterRegression {
 public:
  ClusterRegression(const std::vector<Eigen::VectorXd>& columns, const Eigen::VectorXd& y, std::vector<int> clusters,
                    double collinear_share);

  TermEstimate term(const Eigen::VectorXd& column) const;

  /// Two terms together: coefficients b, Wald statistic t2 = b^T cov(b)^-1 b (chi-square with 2 degrees of freedom if
  /// both true coefficients are 0), rms of both terms over rms(y), and the smaller `own` of the two.
  struct Pair {
    Eigen::Vector2d coefficients = Eigen::Vector2d::Zero();
    double t2 = 0.0, share = 0.0, own = 0.0;
  };
  Pair pair(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  std::size_t columns() const { return static_cast<std::size_t>(basis_.cols()); }
  int clusters() const { return clusters_count_; }

 private:
  Eigen::VectorXd without_columns(const Eigen::VectorXd& values) const;
  Eigen::MatrixXd basis_;  // orthonormal basis of the columns
  Eigen::VectorXd rest_;   // part of y orthogonal to it
  double rms_;             // of y
  std::vector<int> clusters_;
  double collinear_share_;
  int clusters_count_ = 0;
};

}  // namespace pmg::evidence
