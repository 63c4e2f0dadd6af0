// Fits of candidates to the missing torque: linear, without a simulation. They say which are worth a fit of rollouts.
#pragma once

#include <vector>

#include "fitting/folds.hpp"
#include "residual_torque/candidates.hpp"

namespace pmg::residual_torque {

/// A candidate, fitted to the missing torque.
struct TorqueFit {
  Candidate candidate;
  Eigen::VectorXd amplitudes;  ///< of its modes
  Eigen::VectorXd deviations;  ///< of a normal prior of the amplitudes: less for rough modes
  double gain = 0.0;           ///< mean over blocks left out of log(squares without it / squares with it)
};

/// (missing torque, folds, typical torque) => (fits, the best first). Each has the smoothness that predicts blocks left
/// out best. Beside the candidate the tolerances of the model are free.
std::vector<TorqueFit> torque_fits(const MissingTorque& missing, const std::vector<fitting::Fold>& folds,
                                   double torque_Nm, const Options& options);

}  // namespace pmg::residual_torque
