#include "residual_torque/torque_fit.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::residual_torque {

namespace {

/// Half waves over the range from which on modes are damped.
constexpr double kSmoothness[] = {1.0, 2.5, 6.0, 15.0};
constexpr double kNoiseShare = 0.02;  // of the missing torque's mean square: smaller squares of a block are equal
constexpr double kMapMargin = 1.1;    // a map has more freedom than a curve: it must gain so many times as much

/// Rows of one run: what each mode and each tolerance gives.
Eigen::MatrixXd rows(const MissingRun& run, const Candidate* candidate) {
  const Eigen::Index modes = candidate == nullptr ? 0 : candidate->modes.cols();
  Eigen::MatrixXd found(run.missing_Nm.size(), modes + static_cast<Eigen::Index>(kTolerances));
  found.rightCols(kTolerances) = run.tolerances_Nm;
  if (candidate == nullptr) return found;
  const model::ResidualTerm& term = candidate->term;
  const bool friction = term.acts_as == model::ResidualActs::kFriction;
  const Eigen::VectorXd& first = run.values(term.axes[0].quantity, candidate->variants[0]);
  const Eigen::VectorXd& second = run.values(term.axes[1].quantity, candidate->variants[1]);
  for (Eigen::Index k = 0; k < found.rows(); ++k) {
    found.row(k).head(modes).setZero();
    if (run.direction[k] == 0.0) continue;
    const auto weights = term.weights(first[k], second[k]);
    const double sign = friction ? -run.direction[k] : 1.0;
    for (int i = 0; i < term.count(); ++i) {
      const double weight = weights[static_cast<std::size_t>(i)];
      if (weight != 0.0) found.row(k).head(modes) += sign * weight * candidate->modes.row(i);
    }
  }
  return found;
}

class TorqueFitting {
 public:
  TorqueFitting(const MissingTorque& missing, const std::vector<fitting::Fold>& folds, double torque_Nm)
      : missing_(missing), folds_(folds), torque_Nm_(torque_Nm) {
    for (const MissingRun& run : missing.runs) off_.push_back(-run.missing_Nm);
    without_ = linearised(nullptr);
    squares_ = 0.0;
    for (const fitting::NormalEquations& block : without_.blocks) squares_ += block.squares;
    compare_.emplace(missing.blocks, folds, kNoiseShare * squares_ / std::max(1.0, missing.blocks.all_samples()));
    held_out_without_ = held_out(without_);
  }

  TorqueFit fit(const Candidate& candidate) const {
    TorqueFit best{candidate, {}, {}, -1e300};
    fitting::LinearisedFit linear = linearised(&candidate);
    const Eigen::Index modes = candidate.modes.cols();
    for (const double smooth : kSmoothness) {
      // An amplitude of sqrt(knots) makes values of 1, for the modes are orthonormal.
      const Eigen::VectorXd deviations = torque_Nm_ * std::sqrt(static_cast<double>(candidate.term.count())) /
                                         (1.0 + (candidate.half_waves.array() / smooth).square());
      for (Eigen::Index m = 0; m < modes; ++m) linear.ranges[static_cast<std::size_t>(m)].deviation = deviations[m];
      const double gain = (*compare_)(held_out_without_, held_out(linear)).log_gain;
      if (gain <= best.gain) continue;
      best.gain = gain;
      best.deviations = deviations;
      best.amplitudes = fitting::steps_without(linear, {{"none", {}}}).front().head(modes);
    }
    return best;
  }

 private:
  fitting::LinearisedFit linearised(const Candidate* candidate) const {
    fitting::LinearisedFit linear;
    fitting::Jacobian slopes;
    for (const MissingRun& run : missing_.runs) slopes.push_back(rows(run, candidate));
    linear.blocks = missing_.blocks.normal_equations(off_, slopes);
    const Eigen::Index count = slopes.front().cols();
    linear.coordinates = Eigen::VectorXd::Zero(count);
    const double most = 1e3 * torque_Nm_;
    for (Eigen::Index i = 0; i < count; ++i)
      linear.ranges.push_back({.lower = -most, .upper = most, .step = 1.0, .expected = 0.0, .deviation = 1.0});
    // A block counts as one observation, and so does each prior.
    double squares = 0.0;
    for (const fitting::NormalEquations& block : linear.blocks) squares += block.squares;
    linear.prior_weight = squares / static_cast<double>(std::max<std::size_t>(1, linear.blocks.size()));
    return linear;
  }

  Eigen::VectorXd held_out(const fitting::LinearisedFit& linear) const {
    const std::vector<Eigen::VectorXd> steps = fitting::steps_without(linear, folds_);
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(std::ssize(linear.blocks)), times = squares;
    for (std::size_t f = 0; f < folds_.size(); ++f) {
      for (const Eigen::Index b : folds_[f].blocks) {
        squares[b] += std::max(0.0, linear.blocks[static_cast<std::size_t>(b)].squares_after(steps[f]));
        times[b] += 1.0;
      }
    }
    return squares.cwiseQuotient(times.cwiseMax(1.0));
  }

  const MissingTorque& missing_;
  const std::vector<fitting::Fold>& folds_;
  double torque_Nm_, squares_ = 0.0;
  fitting::Residuals off_;
  fitting::LinearisedFit without_;
  std::optional<fitting::BlockComparison> compare_;
  Eigen::VectorXd held_out_without_;
};

}  // namespace

std::vector<TorqueFit> torque_fits(const MissingTorque& missing, const std::vector<fitting::Fold>& folds,
                                   double torque_Nm, const Options& options) {
  const TorqueFitting fitting(missing, folds, torque_Nm);
  std::vector<TorqueFit> found;
  for (const Candidate& candidate : candidates(missing, options)) found.push_back(fitting.fit(candidate));
  std::stable_sort(found.begin(), found.end(), [](const TorqueFit& a, const TorqueFit& b) {
    const auto worth = [](const TorqueFit& fit) { return fit.candidate.is_map() ? fit.gain / kMapMargin : fit.gain; };
    return worth(a) > worth(b);
  });
  return found;
}

}  // namespace pmg::residual_torque
