// T = -coulomb sign(dq): GearFriction.
#include <algorithm>

#include "effects/named.hpp"

namespace pmg::effects {

Effect named::coulomb() {
  return {.name = "coulomb",
          .title = "Coulomb friction",
          .forms =
              {{.name = "dry",
                .parameters = {"friction.coulomb_Nm"},
                .source = "Coulomb 1785",
                .starts =
                    [](const NominalJoint& joint) {
                      return each_from(joint.actuator.friction.coulomb_Nm, joint.torque, {0.03, 0.1, 0.3, -0.05, -0.2});
                    }}},
          .shows =
              "stops short of the target by the same torque whatever the speed; a free swing's amplitude falls by a "
              "constant",
          .needs = "two gains, and motion that stops",
          .one_sign = true,
          .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {std::max(0.0, m.torque_Nm)}; },
          .workshop = {.what = "dry friction",
                       .check = "Switch the motor off and turn the joint slowly by hand: does it stick? Look at "
                                "bearings, seals and the alignment of the shaft.",
                       .cost = "It stops short of where it should, and small corrections don't move it."},
          .demonstration = {.with = {{"friction.coulomb_Nm", 0.8}}}};
}

}  // namespace pmg::effects
