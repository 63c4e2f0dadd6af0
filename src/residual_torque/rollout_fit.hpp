// A residual torque fitted to rollouts, together with the model's other unknowns.
#pragma once

#include <optional>

#include "effects/nested_fit.hpp"
#include "residual_torque/torque_fit.hpp"

namespace pmg::residual_torque {

/// The coordinates of LinearisedFit are those of the model's unknowns, then the amplitudes of the modes.
struct RolloutFit : fitting::LinearisedFit {
  effects::NestedModel without;  ///< the model that is extended
  Candidate candidate;
  double bound_Nm = 0.0;

  calib::JointModel model() const { return model_at(coordinates); }
  calib::JointModel model_at(const Eigen::VectorXd& coordinates) const;
};

/// (runs, model without, start) => (fit, linearised). Costs up to six rollouts of every run for each iteration, and one
/// for each coordinate in the iterations that make their Jacobian anew. None if the start can't be simulated.
std::optional<RolloutFit> rollout_fit(const effects::NestedFit& fit, const effects::NestedModel& without,
                                      const TorqueFit& start, double bound_Nm, int iterations);

/// Squares of each block by fits without its fold [rad^2].
fitting::HeldOut held_out_squares(const effects::NestedFit& fit, const RolloutFit& extended,
                                  const std::vector<fitting::Fold>& folds);

}  // namespace pmg::residual_torque
