#include "robot_diagnosis/robot_posterior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace pmg::robot_diagnosis {

namespace {

Eigen::MatrixXd posterior_precision(const fitting::NormalEquations& data, const Priors& priors) {
  return data.information + Eigen::MatrixXd(priors.precision().asDiagonal());
}

/// log of integral of exp(i.x - x'Ax / 2) N(x; 0, deviations) dx: i^T (A + P)^-1 i / 2 - log|A + P| / 2 + log|P| / 2.
double log_evidence_of(const Eigen::MatrixXd& precision, const Eigen::VectorXd& information,
                       const Eigen::VectorXd& prior_deviation) {
  const Eigen::VectorXd prior = prior_deviation.array().square().inverse();
  const Eigen::LLT<Eigen::MatrixXd> sum(precision + Eigen::MatrixXd(prior.asDiagonal()));
  const Eigen::MatrixXd factor = sum.matrixL();
  return 0.5 * information.dot(sum.solve(information)) - factor.diagonal().array().log().sum() +
         0.5 * prior.array().log().sum();
}

}  // namespace

void Priors::widen(int candidate) {
  for (const int k : list_->candidates[static_cast<std::size_t>(candidate)].parameters)
    wide_[static_cast<std::size_t>(k)] = true;
}

void Priors::widen_all() {
  for (std::size_t k = 0; k < wide_.size(); ++k) wide_[k] = list_->parameters[k].wide > 0.0;
}

Eigen::VectorXd Priors::precision() const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(wide_.size()));
  for (std::size_t k = 0; k < wide_.size(); ++k) {
    const RobotParameter& p = list_->parameters[k];
    const double deviation = wide_[k] ? p.wide : p.tolerance;
    result[static_cast<Eigen::Index>(k)] = 1.0 / (deviation * deviation);
  }
  return result;
}

bool Priors::wide(int candidate) const {
  return wide_[static_cast<std::size_t>(list_->candidates[static_cast<std::size_t>(candidate)].parameters.front())];
}

Posterior posterior(const fitting::NormalEquations& data, const Priors& priors) {
  const Eigen::MatrixXd precision = posterior_precision(data, priors);
  Posterior result;
  result.covariance = precision.llt().solve(Eigen::MatrixXd::Identity(precision.rows(), precision.rows()));
  result.mean = result.covariance * -data.gradient;
  return result;
}

Eigen::VectorXd posterior_mean(const fitting::NormalEquations& data, const Priors& priors) {
  return posterior_precision(data, priors).llt().solve(-data.gradient);
}

double log_evidence(const RobotCandidate& candidate, const RobotParameterList& list, const Posterior& now,
                    const Eigen::VectorXd& prior_precision) {
  const auto count = static_cast<Eigen::Index>(candidate.parameters.size());
  Eigen::MatrixXd covariance(count, count);
  Eigen::VectorXd mean(count), tolerance(count), wide(count), prior(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int k = candidate.parameters[static_cast<std::size_t>(i)];
    const RobotParameter& p = list.parameters[static_cast<std::size_t>(k)];
    mean[i] = now.mean[k];
    prior[i] = prior_precision[k];
    tolerance[i] = p.tolerance;
    wide[i] = p.wide;
    for (Eigen::Index j = 0; j < count; ++j)
      covariance(i, j) = now.covariance(k, candidate.parameters[static_cast<std::size_t>(j)]);
  }
  const Eigen::MatrixXd information_matrix = covariance.inverse();
  const Eigen::VectorXd information = information_matrix * mean;
  const Eigen::MatrixXd of_data = information_matrix - Eigen::MatrixXd(prior.asDiagonal());
  return log_evidence_of(of_data, information, wide) - log_evidence_of(of_data, information, tolerance);
}

}  // namespace pmg::robot_diagnosis
