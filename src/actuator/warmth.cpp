#include "actuator/warmth.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::actuator {

Warmth::Warmth(const model::ActuatorParameters::Thermal& parameters, double step_s)
    : parameters_(parameters),
      step_s_(step_s),
      heats_(parameters.friction_per_Nm2_s != 0.0 || parameters.friction_per_J != 0.0 ||
             parameters.torque_per_Nm2_s != 0.0 || parameters.torque_fade_share != 0.0),
      kept_(std::exp(-step_s / parameters.torque_fade_s)) {}

void Warmth::reset() noexcept {
  heat_Nm2_s_ = work_J_ = 0.0;
  unfaded_ = 1.0;
  temperature_C_ = model::kReferenceTemperature_C;
  friction_ = {};
  torque_ = 1.0;
}

/// H += h (torque^2 - H / cooling); W += h friction's power.
void Warmth::pass(double motor_Nm, double friction_W) noexcept {
  if (!heats_) return;
  heat_Nm2_s_ += step_s_ * (motor_Nm * motor_Nm - heat_Nm2_s_ / parameters_.cooling_s);
  work_J_ += step_s_ * friction_W;
  unfaded_ *= kept_;
}

/// With the heat H, friction's work W, the time t since the start and the temperature T:
///   dry factor = exp(friction_per_K (T - 25 degC) + friction_per_Nm2_s H + friction_per_J W),
///   viscous factor = dry factor exp(viscous_per_K (T - 25 degC)),
///   torque factor = (1 + torque_per_K (T - 25 degC)) / (1 + resistance_per_K (T - 25 degC)) (1 + torque_per_Nm2_s H)
///                   (1 - fade_share (1 - exp(-t / fade_s))), no part below 0.
void Warmth::take(double temperature_C) noexcept {
  const model::ActuatorParameters::Thermal& p = parameters_;
  if (!heats_ && temperature_C == temperature_C_) return;  // exp() only when the reading changes, not in every step
  temperature_C_ = temperature_C;
  const double above_K = temperature_C - model::kReferenceTemperature_C;
  friction_.dry =
      std::exp(p.friction_per_K * above_K + p.friction_per_Nm2_s * heat_Nm2_s_ + p.friction_per_J * work_J_);
  friction_.viscous = p.viscous_per_K == 0.0 ? friction_.dry : friction_.dry * std::exp(p.viscous_per_K * above_K);
  torque_ = std::max(0.0, 1.0 + p.torque_per_K * above_K);
  constexpr double kLeastResistance = 0.1;  // of that at the reference temperature: nothing conducts infinitely well
  torque_ /= std::max(kLeastResistance, 1.0 + p.resistance_per_K * above_K);
  torque_ *= std::max(0.0, 1.0 + p.torque_per_Nm2_s * heat_Nm2_s_);
  torque_ *= 1.0 - p.torque_fade_share * (1.0 - unfaded_);
}

}  // namespace pmg::actuator
