// A torque as a line in a speed.
#pragma once

namespace pmg::actuator {

/// Torque at the given speed, and its derivative by this speed. The integrator takes the slope implicitly.
struct TorqueLine {
  double torque_Nm = 0.0, slope_Nm_s_per_rad = 0.0;
};

}  // namespace pmg::actuator
