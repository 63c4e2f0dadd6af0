// A joint with an actuator, and actuators that differ from the neutral one in something.
#pragma once

#include <functional>

#include "sim/actuator_model.hpp"

namespace pmg::test {

constexpr double kActuatorStep_s = 0.002;
constexpr sim::ActuatorInput kLimp{};

/// A joint of 0.05 kg m^2 about its axis, under a constant torque from outside.
struct OneJoint {
  explicit OneJoint(const model::ActuatorParameters& parameters, double start_rad = 0.0)
      : actuator(parameters, kActuatorStep_s), q_rad(start_rad) {
    actuator.reset(start_rad);
  }
  void step(const sim::ActuatorInput& input, double outside_Nm = 0.0) {
    torque = actuator.step(input, q_rad, dq_rad_s);
    const double inertia = 0.05 + actuator.joint_armature_kg_m2();
    dq_rad_s +=
        kActuatorStep_s * (torque.torque_Nm + outside_Nm) / (inertia - kActuatorStep_s * torque.slope_Nm_s_per_rad);
    q_rad += kActuatorStep_s * dq_rad_s;
  }
  void run(double duration_s, const sim::ActuatorInput& input, double outside_Nm = 0.0) {
    for (double t_s = 0.0; t_s < duration_s; t_s += kActuatorStep_s) step(input, outside_Nm);
  }
  double reading_rad() const { return actuator.reading_rad(q_rad); }
  sim::ActuatorModel actuator;
  double q_rad, dq_rad_s = 0.0;
  sim::ActuatorTorque torque;
};

inline model::ActuatorParameters with(const std::function<void(model::ActuatorParameters&)>& set) {
  model::ActuatorParameters parameters;
  set(parameters);
  return parameters;
}

/// Torque of the first step at that speed.
inline double first_torque_Nm(const model::ActuatorParameters& parameters, const sim::ActuatorInput& input,
                              double dq_rad_s = 0.0) {
  return sim::ActuatorModel(parameters, kActuatorStep_s).step(input, 0.0, dq_rad_s).torque_Nm;
}

}  // namespace pmg::test
