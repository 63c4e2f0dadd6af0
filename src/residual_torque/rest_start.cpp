#include "residual_torque/rest_start.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "fitting/least_squares.hpp"

namespace pmg::residual_torque {

namespace {

using model::ResidualQuantity;

constexpr int kKnots = 20;
constexpr double kShortest_s = 0.05;                     // shorter rests are reversals
constexpr double kSizes[] = {0.15, 0.4, 1.0, 2.5};       // of the typical torque
constexpr double kLevelsOff[] = {1.0 / 3.0, 1.0 / 9.0};  // of the longest rest
/// The curves that the fit mixes: from what the knots resolve to the longest rest.
constexpr double kCurves[] = {1.0 / 12.0, 1.0 / 4.0, 1.0};

double longest_rest_s(const MissingTorque& missing) {
  double longest_s = 0.0;
  for (const MissingRun& run : missing.runs)
    longest_s = std::max(longest_s, run.values(ResidualQuantity::kRest, 0).maxCoeff());
  return longest_s;
}

/// 1 - exp(-t / levels_off) on the knots, which span times 0 to 1.
Eigen::VectorXd rising(double levels_off) {
  return 1.0 - (-Eigen::ArrayXd::LinSpaced(kKnots, 0.0, 1.0) / levels_off).exp();
}

Candidate candidate_over(double longest_s) {
  Candidate found;
  found.term.acts_as = model::ResidualActs::kFriction;
  found.term.axes[0] = {ResidualQuantity::kRest, 0.0, longest_s, kKnots, false};
  Eigen::MatrixXd curves(kKnots, std::ssize(kCurves));
  for (Eigen::Index c = 0; c < curves.cols(); ++c) curves.col(c) = rising(kCurves[c]);
  const Eigen::HouseholderQR<Eigen::MatrixXd> orthogonal(curves);
  found.modes = orthogonal.householderQ() * Eigen::MatrixXd::Identity(kKnots, curves.cols());
  found.half_waves = Eigen::VectorXd::Zero(curves.cols());
  return found;
}

}  // namespace

std::optional<TorqueFit> rest_start(const MissingTorque& missing, const effects::NestedFit& fit,
                                    const calib::JointModel& model, double torque_Nm, double bound_Nm) {
  const double longest_s = longest_rest_s(missing);
  if (longest_s < kShortest_s) return std::nullopt;
  TorqueFit start{candidate_over(longest_s), {}, {}, 0.0};
  double least = fitting::sum_of_squares(fit.residuals(model));
  for (const double levels_off : kLevelsOff) {
    for (const double size : kSizes) {
      const Eigen::VectorXd amplitudes = start.candidate.modes.transpose() * (size * torque_Nm * rising(levels_off));
      calib::JointModel with = model;
      with.actuator.residual_torque.count = 1;
      with.actuator.residual_torque.terms[0] = term_of(start.candidate, amplitudes, bound_Nm);
      const double squares = fitting::sum_of_squares(fit.residuals(with));
      if (!(squares < least)) continue;
      least = squares;
      start.amplitudes = amplitudes;
    }
  }
  if (start.amplitudes.size() == 0) return std::nullopt;
  // An amplitude of sqrt(knots) makes values of 1, for the modes are orthonormal.
  start.deviations = Eigen::VectorXd::Constant(start.amplitudes.size(), torque_Nm * std::sqrt(double{kKnots}));
  return start;
}

}  // namespace pmg::residual_torque
