#include "fitting/covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace pmg::fitting {

namespace {
constexpr double kCovarianceRidge = 1e-9;  // added to a unit diagonal: keeps collinear coordinates solvable
}

Eigen::MatrixXd information(const LinearisedFit& fit) {
  Eigen::MatrixXd sum = prior(fit).information;
  for (const NormalEquations& block : fit.blocks) sum += block.information;
  return sum;
}

Covariance cluster_robust_covariance(const LinearisedFit& fit, std::vector<Eigen::Index> of) {
  const auto size = static_cast<Eigen::Index>(of.size());
  const auto blocks = static_cast<double>(fit.blocks.size());
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(fit.coordinates.size(), fit.coordinates.size());
  for (const NormalEquations& block : fit.blocks) scatter += block.gradient * block.gradient.transpose();
  scatter *= blocks / std::max(1.0, blocks - static_cast<double>(size));
  scatter += fit.prior_weight * prior(fit).information;
  const Eigen::MatrixXd seen = information(fit)(of, of);
  // Scaled to a unit diagonal: coordinates have different units.
  const Eigen::VectorXd weight = seen.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = weight.asDiagonal() * seen * weight.asDiagonal();
  Covariance found;
  found.inverse = weight.asDiagonal() *
                  (scaled + kCovarianceRidge * Eigen::MatrixXd::Identity(size, size))
                      .ldlt()
                      .solve(Eigen::MatrixXd::Identity(size, size)) *
                  weight.asDiagonal();
  found.robust = found.inverse * scatter(of, of) * found.inverse;
  found.of = std::move(of);
  return found;
}

Eigen::VectorXd jackknife_variance(const LinearisedFit& fit, const std::vector<Fold>& folds) {
  const std::vector<Eigen::VectorXd> steps = steps_without(fit, folds);
  Eigen::VectorXd most = Eigen::VectorXd::Zero(fit.coordinates.size());
  for (std::size_t first = 0, last = 0; first < folds.size(); first = last) {
    while (last < folds.size() && folds[last].name == folds[first].name) ++last;
    const auto groups = static_cast<double>(last - first);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(most.size()), squares = mean;
    for (std::size_t f = first; f < last; ++f) mean += steps[f] / groups;
    for (std::size_t f = first; f < last; ++f) squares += (steps[f] - mean).cwiseAbs2();
    most = most.cwiseMax((groups - 1.0) / groups * squares);
  }
  return most;
}

}  // namespace pmg::fitting
