// What a drive gives until its next tick, and the torque that comes of it.
#pragma once

#include "machine.hpp"

namespace pmg::literature {

/// torque = held - emf_slope * speed, within what the motor and its supply can.
struct DriveOutput {
  double held_Nm = 0.0, emf_slope = 0.0;
  double most_Nm = kNever;  ///< that a supply with a current limit can feed
};

/// (output, angle and speed of the rotor, factor of temperature) => torque on the rotor [Nm].
double drive_torque_Nm(const Machine& machine, const DriveOutput& output, double torque_scale, double angle_rad,
                       double speed_rad_s);

}  // namespace pmg::literature
