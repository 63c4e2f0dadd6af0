// The load of a joint on its bench.
#pragma once

namespace pmg::bench {

/// The load of the joint: everything that it moves except its own rotor. On a linear rig in kg and N.
struct JointLoad {
  double inertia_kg_m2 = 0.0;  ///< about the axis
  double gravity_Nm = 0.0;     ///< gravity's torque on the joint is -gravity_Nm sin(q - hangs_at_rad)
  double hangs_at_rad = 0.0;   ///< angle at which the load hangs at rest; 0 except for a robot's joints
  bool operator==(const JointLoad&) const = default;
};

}  // namespace pmg::bench
