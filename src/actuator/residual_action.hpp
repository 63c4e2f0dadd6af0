// A residual torque at work: follows its quantities along a simulation.
#pragma once

#include <array>

#include "model/residual_torque.hpp"

namespace pmg::actuator {

/// What the residual torque of an actuator sees in one step.
struct ResidualSeen {
  double motor_rad = 0.0, motor_rad_s = 0.0;
  double command_rad = 0.0;           ///< what the drive compares with its reading
  double error_rad = 0.0;             ///< of the drive
  double stiffness_Nm_per_rad = 0.0;  ///< torque that the drive's position gain makes of an error
  double drive_Nm = 0.0;              ///< of the drive
  double temperature_C = 0.0;
  bool integrates = true;  ///< the drive is on and within its output's limit
  bool enabled = true;
  bool sticks = false;  ///< dry friction holds the motor
};

/// No heap, no I/O.
class ResidualAction {
 public:
  ResidualAction(const model::ResidualTorque& torque, double step_s) : torque_(torque), step_s_(step_s) {}

  bool acts() const { return torque_.count > 0; }
  void reset() noexcept;

  /// Once a step. Integrates what the quantities need; then torque() and friction() are those of this step.
  void follow(const ResidualSeen& seen) noexcept;
  /// The same without time passing.
  void look(const ResidualSeen& seen) noexcept;

  /// Torque on the motor, and its slope in the motor's speed: h d torque / d position, where that is negative.
  const model::ResidualValue& torque() const { return given_; }
  /// What adds to the dry friction's limit, and its slope in |speed|, where that is positive.
  const model::ResidualValue& friction() const { return friction_; }

  const ResidualSeen& seen() const { return seen_; }  ///< in this step
  /// A quantity in this step; 0 for the bend and the command's change, which belong to a term.
  double value(model::ResidualQuantity quantity) const noexcept;

 private:
  struct Change {
    double lagged_rad = 0.0, value_Nm = 0.0;
  };
  void follow_change(Change& change, double lag_s, const ResidualSeen& seen) const noexcept;

  model::ResidualTorque torque_;
  double step_s_;
  double integral_Nm_s_ = 0.0, rest_s_ = 0.0, time_s_ = 0.0;
  std::array<double, model::ResidualTorque::kMostTerms> bend_rad_{};  // of each term: its axis gives the width
  std::array<Change, model::ResidualTorque::kMostTerms> changes_{};   // of the command, of each term
  bool followed_ = false;
  ResidualSeen seen_;
  model::ResidualValue given_, friction_;
};

}  // namespace pmg::actuator
