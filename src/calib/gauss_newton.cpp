#include "calib/gauss_newton.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "calib/linearised.hpp"

namespace pmg::calib {

namespace {

constexpr double kFirstDamping = 1e-3, kMostDamping = 1e3, kLessDamping = 0.1, kMoreDamping = 10.0;
constexpr double kLongestStep = 0.1;         // of the cube's edge: beyond, slopes by differences say little
constexpr double kRelativeTolerance = 1e-6;  // of the loss

/// The damped step; what would leave the cube at once stays.
Eigen::VectorXd step(const Linearised& at, const std::vector<double>& point, double damping) {
  Eigen::MatrixXd a = at.information;
  Eigen::VectorXd b = -at.gradient;
  const double unseen = 1e-14 * a.diagonal().maxCoeff();
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    const double place = point[static_cast<std::size_t>(i)];
    const bool held = (place <= 0.0 && b[i] < 0.0) || (place >= 1.0 && b[i] > 0.0) || !(a(i, i) > unseen);
    if (held) {
      a.row(i).setZero();
      a.col(i).setZero();
      a(i, i) = 1.0;
      b[i] = 0.0;
    } else {
      a(i, i) *= 1.0 + damping;
    }
  }
  const Eigen::VectorXd weight = a.diagonal().cwiseSqrt().cwiseInverse();  // parameters of any weight alike
  const Eigen::MatrixXd scaled = weight.asDiagonal() * a * weight.asDiagonal();
  Eigen::VectorXd found = weight.asDiagonal() * scaled.ldlt().solve(weight.asDiagonal() * b);
  const double longest = found.cwiseAbs().maxCoeff();
  if (longest > kLongestStep) found *= kLongestStep / longest;
  return found;
}

std::vector<double> moved(const std::vector<double>& point, const Eigen::VectorXd& by) {
  std::vector<double> there = point;
  for (std::size_t i = 0; i < there.size(); ++i) {
    there[i] = std::clamp(there[i] + by[static_cast<Eigen::Index>(i)], 0.0, 1.0);
  }
  return there;
}

}  // namespace

Found gauss_newton(const FitProblem& problem, const Found& start, int most_steps, unsigned threads,
                   const Interrupted& interrupted) {
  Found best = start;
  best.evaluations = 0;
  double damping = kFirstDamping;
  const auto over = [&] { return damping > kMostDamping || (interrupted && interrupted()); };
  try {
    for (int k = 0; k < most_steps && !over(); ++k) {
      const Linearised at = linearise(problem, best.point, threads);
      best.evaluations += 1 + 2 * static_cast<int>(problem.dimensions());
      const double before = best.loss;
      while (best.loss == before && !over()) {
        const std::vector<double> there = moved(best.point, step(at, best.point, damping));
        const double loss = problem.loss(there, threads);
        ++best.evaluations;
        if (loss < best.loss) best.loss = loss, best.point = there;
        damping *= best.loss < before ? kLessDamping : kMoreDamping;
      }
      if (best.loss > before * (1.0 - kRelativeTolerance)) break;
    }
  } catch (const std::invalid_argument&) {  // at the edge of what the actuator model takes
  }
  return best;
}

}  // namespace pmg::calib
