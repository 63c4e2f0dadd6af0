#include "actuator/residual_action.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

using model::ResidualQuantity;

void ResidualAction::reset() noexcept {
  integral_Nm_s_ = rest_s_ = time_s_ = 0.0;
  bend_rad_ = {};
  changes_ = {};
  followed_ = false;
  given_ = friction_ = {};
}

double ResidualAction::value(ResidualQuantity quantity) const noexcept {
  switch (quantity) {
    case ResidualQuantity::kPosition:
      return seen_.motor_rad;
    case ResidualQuantity::kSpeed:
      return std::abs(seen_.motor_rad_s);
    case ResidualQuantity::kError:
      return seen_.error_rad;
    case ResidualQuantity::kDrive:
      return seen_.drive_Nm;
    case ResidualQuantity::kIntegral:
      return integral_Nm_s_;
    case ResidualQuantity::kBend:
    case ResidualQuantity::kCommandChange:
      break;
    case ResidualQuantity::kRest:
      return rest_s_;
    case ResidualQuantity::kTemperature:
      return seen_.temperature_C;
    case ResidualQuantity::kTime:
      return time_s_;
  }
  return 0.0;
}

void ResidualAction::follow(const ResidualSeen& seen) noexcept {
  if (!seen.enabled) integral_Nm_s_ = 0.0;
  if (seen.integrates) integral_Nm_s_ += step_s_ * seen.stiffness_Nm_per_rad * seen.error_rad;
  rest_s_ = seen.sticks ? rest_s_ + step_s_ : 0.0;
  for (int t = 0; t < torque_.count; ++t) {
    const auto index = static_cast<std::size_t>(t);
    for (const model::ResidualAxis& axis : torque_.terms[index].axes) {
      if (axis.knots > 1 && axis.quantity == ResidualQuantity::kBend)
        bend_rad_[index] = std::clamp(bend_rad_[index] + step_s_ * seen.motor_rad_s, axis.low, axis.high);
      if (axis.quantity == ResidualQuantity::kCommandChange) follow_change(changes_[index], axis.lag_s, seen);
    }
  }
  followed_ = true;
  look(seen);
  time_s_ += step_s_;
}

/// lagged += h / (lag + h) (command - lagged), implicit Euler. The first command counts as in force for long.
void ResidualAction::follow_change(Change& change, double lag_s, const ResidualSeen& seen) const noexcept {
  if (!followed_) change.lagged_rad = seen.command_rad;
  change.lagged_rad += step_s_ / (lag_s + step_s_) * (seen.command_rad - change.lagged_rad);
  change.value_Nm = seen.stiffness_Nm_per_rad * (seen.command_rad - change.lagged_rad);
}

void ResidualAction::look(const ResidualSeen& seen) noexcept {
  seen_ = seen;
  given_ = friction_ = {};
  for (int t = 0; t < torque_.count; ++t) {
    const auto index = static_cast<std::size_t>(t);
    const model::ResidualTerm& term = torque_.terms[index];
    const auto on = [&](const model::ResidualAxis& axis) {
      if (axis.quantity == ResidualQuantity::kCommandChange) return changes_[index].value_Nm;
      return axis.quantity == ResidualQuantity::kBend ? bend_rad_[index] : value(axis.quantity);
    };
    const model::ResidualValue found = term.at(on(term.axes[0]), on(term.axes[1]));
    const ResidualQuantity first = term.axes[0].quantity;
    if (term.acts_as == model::ResidualActs::kFriction) {
      friction_.value_Nm += found.value_Nm;
      if (first == ResidualQuantity::kSpeed) friction_.slope += std::max(0.0, found.slope);
      continue;
    }
    given_.value_Nm += found.value_Nm;
    const bool turns = first == ResidualQuantity::kPosition || first == ResidualQuantity::kBend;
    if (turns) given_.slope += step_s_ * std::min(0.0, found.slope);
  }
}

}  // namespace pmg::actuator
