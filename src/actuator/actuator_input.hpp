// What a drive is told, and what it works under.
#pragma once

#include "model/actuator_parameters.hpp"

namespace pmg::actuator {

/// The drive's command and supply. Units as in ActuatorParameters.
struct ActuatorInput {
  double q_rad = 0.0, dq_rad_s = 0.0;
  double kp = 0.0, kd = 0.0;     ///< [unit of output per rad, per rad/s]
  double feed_forward_Nm = 0.0;  ///< torque under every drive law; the drive converts it to its own output
  double supply = 1.0;           ///< bus voltage of a voltage servo
  bool enabled = true;
  double temperature_C = model::kReferenceTemperature_C;  ///< of gear and winding
  double external_Nm = 0.0;  ///< what else turns the joint: gravity, contacts. Only friction.load_net asks for it
};

}  // namespace pmg::actuator
