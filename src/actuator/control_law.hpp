// The drive's own law: (command, what its sensor shows) => (output).
#pragma once

#include <algorithm>
#include <cmath>

#include "actuator/actuator_input.hpp"
#include "actuator/angle_sensor.hpp"
#include "actuator/period.hpp"
#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

class ControlLaw {
 public:
  ControlLaw(const model::ActuatorParameters& parameters, double step_s);

  /// The drive's output; its unit is in ActuatorParameters.
  struct Output {
    double value;
    double speed_gain;  ///< [output per rad/s] by which a change of speed within this step lowers it
  };

  void reset() noexcept;

  /// prompt_speed: by how much the speed that is seen changes with the speed within the same step.
  Output step(const ActuatorInput& told, const Seen& seen, double prompt_speed) noexcept;

  /// What the output would be without its position error.
  double standing_output() const noexcept;

  void restart_periods() noexcept { hold_.restart(); }

 private:
  double beyond_dead_band_rad(double error_rad) noexcept;

  model::ActuatorParameters::Drive parameters_;
  Period hold_;
  double held_ = 0.0, of_position_ = 0.0;
  bool awake_ = true;
};

/// Newton metres are newton metres under every law: the drive divides its feed-forward by its torque constant (that of
/// the reference temperature, because it does not know its winding's) and by its supply.
inline ControlLaw::Output ControlLaw::step(const ActuatorInput& told, const Seen& seen, double prompt_speed) noexcept {
  const model::ActuatorParameters::Drive& p = parameters_;
  if (!hold_.every_step() && !hold_.due()) return {held_, 0.0};
  const double kd = p.kd_scale * told.kd;
  const double forward =
      told.feed_forward_Nm == 0.0 ? 0.0 : told.feed_forward_Nm / (p.torque_per_unit_Nm * told.supply);
  const double error_rad = told.q_rad - seen.q_rad;
  const double of_position =
      p.kp_scale * told.kp * (p.dead_band_rad == 0.0 ? error_rad : beyond_dead_band_rad(error_rad));
  double wish = of_position + kd * (told.dq_rad_s - seen.dq_rad_s) + forward;
  bool follows_speed = hold_.every_step();
  if (p.output_dead_band > 0.0) {
    wish -= std::clamp(wish, -p.output_dead_band, p.output_dead_band);
    follows_speed = follows_speed && wish != 0.0;
  }
  const double value = std::clamp(wish, -p.limit, p.limit);
  of_position_ = of_position;
  held_ = value;
  return {value, follows_speed && value == wish ? prompt_speed * kd : 0.0};
}

}  // namespace pmg::actuator
