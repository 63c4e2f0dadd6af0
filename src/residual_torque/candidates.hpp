// Curves and maps that a residual torque may be, and the smooth modes that each is made of.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "residual_torque/missing_torque.hpp"
#include "residual_torque/options.hpp"

namespace pmg::residual_torque {

/// A term without values, and its modes.
struct Candidate {
  model::ResidualTerm term;
  /// Of a bend the index of MissingTorque::widths_rad, of the command's change that of kLags_s.
  std::array<std::size_t, 2> variants{};
  /// (values, modes): cosines over the axes, or waves over a turn; the smoothest first. Its columns are orthonormal.
  Eigen::MatrixXd modes;
  Eigen::VectorXd half_waves;  ///< of each mode, over the axes: root of the sum of squares

  bool is_map() const { return term.axes[1].knots > 1; }
};

/// All curves, and all maps over two of their quantities, on the range that was recorded. What physics forbids is not
/// among them: torque over speed.
std::vector<Candidate> candidates(const MissingTorque& missing, const Options& options);

/// "torque over position_rad and time_s".
std::string text(const model::ResidualTerm& term);

/// (candidate, amplitudes of its modes, bound) => (term): its values, no larger than the bound. Where physics has an
/// order, the values have it too: a bent bristle pulls back the more it is bent and at its ends never pushes on (so it
/// takes energy), an integral term pushes towards the command, friction grows while the joint rests, and what
/// depends on the command's change makes it act later, never before.
model::ResidualTerm term_of(const Candidate& candidate, const Eigen::VectorXd& amplitudes, double bound_Nm);

}  // namespace pmg::residual_torque
