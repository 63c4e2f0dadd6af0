// reading = q + zero_offset: AngleSensor.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::zero_offset() {
  return {.name = "zero_offset",
          .title = "zero offset",
          .forms = {{.name = "constant",
                     .parameters = {"sensor.zero_offset_rad"},
                     .source = "Mooring, Roth, Driels 1991",
                     .starts = [](const NominalJoint&) { return each(1.0, -0.05, -0.01, 0.01, 0.05); }}},
          .shows = "misses by a constant where gravity differs",
          .needs = "a load that hangs",
          // A reading r = q + z: gravity G sin(r - z) is G sin r - z G cos r.
          .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {-m.torque_Nm}; },
          .workshop = {.what = "a wrong zero of the position sensor",
                       .check = "Put the joint on its mark and compare the reading with the angle. Set the zero again.",
                       .cost = "Whatever uses this angle is wrong by it: a foot stands tilted, or the robot leans."},
          .demonstration = {.with = {{"sensor.zero_offset_rad", 0.3}}}};
}

}  // namespace pmg::effects
