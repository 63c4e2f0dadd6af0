// A torque that no known effect explains: curves and maps over one or two quantities of the joint.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace pmg::model {

/// What a residual torque may depend on. Motor means its angle and speed at the joint's scale; with a rigid
/// transmission it moves as the joint does.
enum class ResidualQuantity {
  kPosition,  ///< of the motor [rad]
  kSpeed,     ///< |speed| of the motor [rad/s]
  kError,     ///< the drive's command, after its delay, minus the drive's reading [rad]
  kDrive,     ///< torque of the drive itself [Nm]
  kIntegral,  ///< integral of the torque that the position error alone asks for [Nm s]; it waits at the output's limit
  kBend,      ///< way since the last reversals, clamp(bend + h dq, low, high) of its axis [rad]
  kRest,      ///< time for which dry friction has held the motor [s]
  kTemperature,    ///< [degC]
  kTime,           ///< since the start [s]
  kCommandChange,  ///< the position command less the same behind a first-order lag of its axis' lag_s, as the torque
                   ///< that the drive's kp makes of it [Nm]
};

/// A quantity and its name in motor.yaml.
struct ResidualQuantityName {
  ResidualQuantity quantity;
  std::string_view name;  ///< with its unit: "position_rad"
};
std::span<const ResidualQuantityName> residual_quantities();
std::string_view name(ResidualQuantity quantity);

/// One axis of a term: `knots` equally spaced knots, the first at low, the last at high. A periodic axis repeats every
/// turn: its knots are low + 2 pi k / knots, and high is unused.
struct ResidualAxis {
  ResidualQuantity quantity = ResidualQuantity::kPosition;
  double low = 0.0, high = 1.0;
  int knots = 1;  ///< 1: the axis has no influence
  bool periodic = false;
  double lag_s = 0.0;  ///< of the command's change

  double spacing() const;
  bool operator==(const ResidualAxis&) const = default;
};

/// How a term acts: as a torque on the motor; or as dry friction, which adds to the friction of the model. The sum of
/// all dry friction is never below zero: a joint with such a term takes energy from the motion, whatever the values
/// are.
enum class ResidualActs { kTorque, kFriction };

/// A value and its slope along the first axis.
struct ResidualValue {
  double value_Nm = 0.0, slope = 0.0;
};

/// A curve (the second axis has one knot) or a map. Between knots it is linear or bilinear, beyond the axes it falls to
/// zero within one spacing: outside of what was recorded it is zero. It never exceeds its largest value.
struct ResidualTerm {
  static constexpr int kMostValues = 64;

  ResidualActs acts_as = ResidualActs::kTorque;
  std::array<ResidualAxis, 2> axes{};
  std::array<double, kMostValues> values_Nm{};  ///< the second axis varies faster; unused ones are 0

  int count() const { return axes[0].knots * axes[1].knots; }
  /// (first quantity, second quantity) => (torque, and its slope in the first).
  ResidualValue at(double first, double second) const noexcept;
  /// Weight of each value at this place: the derivative of at() in values_Nm. At most four aren't zero.
  std::array<double, kMostValues> weights(double first, double second) const noexcept;
  bool operator==(const ResidualTerm&) const = default;
};

/// Neutral by default: no term.
struct ResidualTorque {
  static constexpr int kMostTerms = 2;
  int count = 0;
  std::array<ResidualTerm, kMostTerms> terms{};  ///< unused ones are neutral

  std::span<const ResidualTerm> used() const { return {terms.data(), static_cast<std::size_t>(count)}; }
  bool operator==(const ResidualTorque&) const = default;
};

/// Throws std::invalid_argument on axes that make no sense, and on a quantity that a term of this kind can't have: a
/// torque over speed could drive the joint, so speed is for friction alone; values that rise over a bend could drive
/// it, and values that fall over the integral push away from the command.
void check(const ResidualTorque& torque);

}  // namespace pmg::model
