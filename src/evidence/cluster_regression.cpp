#include "evidence/cluster_regression.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace pmg::evidence {

namespace {

double rms(const Eigen::VectorXd& values) {
  return values.size() > 0 ? values.norm() / std::sqrt(static_cast<double>(values.size())) : 0.0;
}

}  // namespace

ClusterRegression::ClusterRegression(const std::vector<Eigen::VectorXd>& columns, const Eigen::VectorXd& y,
                                     std::vector<int> clusters, double collinear_share)
    : basis_(y.size(), 0), rms_(rms(y)), clusters_(std::move(clusters)), collinear_share_(collinear_share) {
  for (const Eigen::VectorXd& column : columns) {
    const Eigen::VectorXd rest = without_columns(column);
    if (!(rest.norm() > collinear_share_ * column.norm())) continue;
    basis_.conservativeResize(Eigen::NoChange, basis_.cols() + 1);
    basis_.col(basis_.cols() - 1) = rest.normalized();
  }
  rest_ = without_columns(y);
  for (const int cluster : clusters_) clusters_count_ = std::max(clusters_count_, cluster + 1);
}

/// Projects twice: one pass leaves rounding errors where columns are nearly collinear.
Eigen::VectorXd ClusterRegression::without_columns(const Eigen::VectorXd& values) const {
  if (basis_.cols() == 0) return values;
  Eigen::VectorXd rest = values - basis_ * (basis_.transpose() * values);
  rest -= basis_ * (basis_.transpose() * rest);
  return rest;
}

TermEstimate ClusterRegression::term(const Eigen::VectorXd& column) const {
  TermEstimate found;
  const Eigen::VectorXd own = without_columns(column);
  found.own = column.norm() > 0.0 ? own.norm() / column.norm() : 0.0;
  const double squares = own.squaredNorm();
  if (!(found.own > collinear_share_)) return found;
  found.coefficient = own.dot(rest_) / squares;
  const Eigen::VectorXd error = rest_ - found.coefficient * own;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(clusters_count_);
  for (Eigen::Index i = 0; i < error.size(); ++i) sums[clusters_[static_cast<std::size_t>(i)]] += own[i] * error[i];
  const double spare = std::max(1.0, static_cast<double>(clusters_count_ - basis_.cols() - 1));
  found.deviation = std::sqrt(sums.squaredNorm() * static_cast<double>(clusters_count_) / spare) / squares;
  found.share = rms_ > 0.0 ? std::abs(found.coefficient) * rms(own) / rms_ : 0.0;
  found.share_upper = rms_ > 0.0 ? (std::abs(found.coefficient) + 2.0 * found.deviation) * rms(own) / rms_ : 0.0;
  return found;
}

ClusterRegression::Pair ClusterRegression::pair(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  Pair found;
  Eigen::MatrixXd own(a.size(), 2);
  own.col(0) = without_columns(a);
  own.col(1) = without_columns(b);
  found.own = std::min(own.col(0).norm() / std::max(1e-300, a.norm()), own.col(1).norm() / std::max(1e-300, b.norm()));
  const Eigen::Matrix2d squares = own.transpose() * own;
  // Two columns whose correlation r has r^2 > 0.999 cannot be told apart: det = (1 - r^2) * the diagonal's product.
  if (!(found.own > collinear_share_) || squares.determinant() < 1e-3 * squares(0, 0) * squares(1, 1)) return found;
  const Eigen::Matrix2d inverse = squares.inverse();
  found.coefficients = inverse * (own.transpose() * rest_);
  const Eigen::VectorXd error = rest_ - own * found.coefficients;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(clusters_count_, 2);
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    sums.row(clusters_[static_cast<std::size_t>(i)]) += error[i] * own.row(i);
  }
  const double spare = std::max(1.0, static_cast<double>(clusters_count_ - basis_.cols() - 2));
  const Eigen::Matrix2d scatter = sums.transpose() * sums * (static_cast<double>(clusters_count_) / spare);
  const Eigen::Matrix2d covariance = inverse * scatter * inverse;
  if (covariance.determinant() > 0.0) {
    found.t2 = found.coefficients.dot(covariance.inverse() * found.coefficients);
  }
  found.share = rms_ > 0.0 ? rms(own * found.coefficients) / rms_ : 0.0;
  return found;
}

}  // namespace pmg::evidence
