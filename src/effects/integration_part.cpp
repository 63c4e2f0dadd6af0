#include "effects/integration_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/step_choice.hpp"
#include "fitting/covariance.hpp"

namespace pmg::effects {

fitting::Residuals integration_residuals(const bench::Bench& bench, const NestedFit& fit,
                                         const calib::JointModel& model, const fitting::Residuals& residuals) {
  const std::vector<calib::SingleJoint> fine_runs =
      calib::with_step(bench, fit.runs(), 0.5 * fit.runs().front().step_s());
  fitting::Residuals error = calib::residuals(model, fine_runs, fit.threads());
  if (error.empty() || residuals.empty()) return {};
  for (std::size_t run = 0; run < error.size(); ++run) error[run] = 2.0 * (residuals[run] - error[run]);
  return error;
}

double integration_part_rms(const bench::Bench& bench, const NestedFit& fit, const calib::JointModel& model,
                            const calib::Unknowns& unknowns) {
  const NestedModel at = fit.fit(model, unknowns, 0);
  const fitting::Residuals residuals = fit.residuals(at.model);
  fitting::Residuals error = integration_residuals(bench, fit, at.model, residuals);
  if (error.empty()) return std::numeric_limits<double>::infinity();
  const fitting::Jacobian slopes = fit.jacobian(at, residuals).of_run;
  const Eigen::VectorXd taken_up = fitting::solved(fitting::products(slopes, slopes), fitting::products(slopes, error));
  for (std::size_t run = 0; run < error.size(); ++run) error[run] -= slopes[run] * taken_up;
  double along = 0.0, squares = 0.0;
  for (std::size_t run = 0; run < error.size(); ++run) {
    along += residuals[run].dot(error[run]);
    squares += error[run].squaredNorm();
  }
  if (!(squares > 0.0)) return 0.0;
  return std::clamp(along / squares, 0.0, 1.0) * std::sqrt(squares / std::max(1.0, fit.blocks().all_samples()));
}

}  // namespace pmg::effects
