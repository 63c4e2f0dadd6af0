#include "fitting/covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace pmg::fitting {

namespace {
constexpr double kCovarianceRidge = 1e-9;  // added to a unit diagonal: keeps collinear coordinates solvable
}

Eigen::MatrixXd solved(const Eigen::MatrixXd& information, const Eigen::MatrixXd& right) {
  if (information.size() == 0) return right;
  // Scaled to a unit diagonal: coordinates have different units.
  const Eigen::VectorXd weight = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = weight.asDiagonal() * information * weight.asDiagonal();
  scaled.diagonal().array() += kCovarianceRidge;
  return weight.asDiagonal() * scaled.ldlt().solve(weight.asDiagonal() * right);
}

Eigen::MatrixXd information(const LinearisedFit& fit) {
  Eigen::MatrixXd sum = prior(fit).information;
  for (const NormalEquations& block : fit.blocks) sum += block.information;
  return sum;
}

Eigen::MatrixXd beyond(const Eigen::MatrixXd& own, const Eigen::MatrixXd& mixed, const Eigen::MatrixXd& information) {
  return own - mixed.transpose() * solved(information, mixed);
}

Covariance cluster_robust_covariance(const LinearisedFit& fit, std::vector<Eigen::Index> of) {
  const auto size = static_cast<Eigen::Index>(of.size());
  const auto blocks = static_cast<double>(fit.blocks.size());
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(fit.coordinates.size(), fit.coordinates.size());
  for (const NormalEquations& block : fit.blocks) scatter += block.gradient * block.gradient.transpose();
  scatter *= blocks / std::max(1.0, blocks - static_cast<double>(size));
  scatter += fit.prior_weight * prior(fit).information;
  const Eigen::MatrixXd seen = information(fit)(of, of);
  Covariance found;
  found.inverse = solved(seen, Eigen::MatrixXd::Identity(size, size));
  found.robust = found.inverse * scatter(of, of) * found.inverse;
  found.of = std::move(of);
  return found;
}

Eigen::VectorXd effective_blocks(const LinearisedFit& fit, const Covariance& covariance) {
  const Eigen::MatrixXd& inverse = covariance.inverse;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(inverse.rows());
  for (const NormalEquations& block : fit.blocks) {
    const Eigen::MatrixXd own = block.information(covariance.of, covariance.of);
    squares += (inverse.cwiseProduct((own * inverse).transpose())).rowwise().sum().cwiseAbs2();
  }
  return inverse.diagonal().cwiseAbs2().cwiseQuotient(squares.cwiseMax(1e-300));
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
