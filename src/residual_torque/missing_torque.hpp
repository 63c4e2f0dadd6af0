// The torque that a model lacks along each recording, and the quantities that it may depend on.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "effects/nested_fit.hpp"
#include "model/residual_torque.hpp"

namespace pmg::residual_torque {

inline constexpr std::size_t kQuantities = 10;  // of model::ResidualQuantity
inline constexpr std::size_t kWidths = 3;       // of bends: half, a fifth and a twelfth of the range of motion
inline constexpr std::size_t kLags = 4;         // of the command's changes: kLags_s
/// From bus cycles to commands that wait long for the bus. A lag between two of them is
/// twice or half of one, which describes most of it.
inline constexpr std::array<double, kLags> kLags_s = {0.005, 0.02, 0.08, 0.32};
inline constexpr std::size_t kTolerances = 6;

/// One run, a row per thinned sample. Rows in which the joint rests have missing_Nm and tolerances 0: at rest dry
/// friction takes any torque.
struct MissingRun {
  Eigen::VectorXd missing_Nm;
  Eigen::VectorXd direction;                            ///< of the motion, 1 or -1; 0 at rest
  std::array<Eigen::VectorXd, kQuantities> quantities;  ///< by model::ResidualQuantity; bend and change are below
  std::array<Eigen::VectorXd, kWidths> bends_rad;
  std::array<Eigen::VectorXd, kLags> changes_Nm;  ///< of the command
  /// Torques that a change of the model by its tolerance would make: of dry and viscous friction, a constant, gravity,
  /// inertia and gain.
  Eigen::MatrixXd tolerances_Nm;

  /// variant: which width of a bend, which lag of the command's change.
  const Eigen::VectorXd& values(model::ResidualQuantity quantity, std::size_t variant) const {
    if (quantity == model::ResidualQuantity::kBend) return bends_rad[variant];
    if (quantity == model::ResidualQuantity::kCommandChange) return changes_Nm[variant];
    return quantities[static_cast<std::size_t>(quantity)];
  }
};

struct MissingTorque {
  std::vector<MissingRun> runs;
  fitting::Blocks blocks;  ///< of the rows; the same blocks as of the rollouts
  std::array<double, kWidths> widths_rad{};
  bool temperature_varies = false;
};

/// (fit, model) => (missing torque). The simulation is pulled along each recording by a spring and a damper,
/// I (w^2 e + 2 w de/dt) with the error e = measured - simulated. What moves the real joint and not the simulated one
/// is
///   missing = I (w^2 e + 2 w de/dt + d2e/dt2) + kp e + kd de/dt,
/// the last two being the drive's answer to e. Derivatives are those of local parabolas, without lag. Costs about two
/// rollouts of every run.
MissingTorque missing_torque(const bench::Bench& bench, const effects::NestedFit& fit, const calib::JointModel& model,
                             const effects::BenchScale& scale);

}  // namespace pmg::residual_torque
