// T = -(viscous |dq| + viscous_quadratic dq^2) sign(dq): GearFriction.
#include <algorithm>

#include "effects/named.hpp"

namespace pmg::effects {

Effect named::viscous() {
  return {.name = "viscous",
          .title = "viscous friction",
          .forms = {{.name = "linear",
                     .title = "growing in proportion to speed",
                     .parameters = {"friction.viscous_Nm_s_per_rad"},
                     .source = "Stokes 1851",
                     .starts =
                         [](const NominalJoint& joint) {
                           return each_from(joint.actuator.friction.viscous_Nm_s_per_rad, joint.torque / joint.speed,
                                            {0.03, 0.1, 0.3, -0.05, -0.2});
                         }},
                    {.name = "quadratic",
                     .title = "growing with the square of speed",
                     .parameters = {"friction.viscous_quadratic_Nm_s2_per_rad2"},
                     .source = "Changenet, Oviedo-Marlot, Velex 2006",
                     .starts =
                         [](const NominalJoint& joint) {
                           return each(joint.torque / (joint.speed * joint.speed), 0.1, 0.4);
                         }}},
          .shows = "the residual grows with speed",
          .needs = "slow and fast motion; two settings of kd, or a commanded speed",
          .one_sign = true,
          .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {std::max(0.0, m.torque_Nm)}; },
          .workshop = {.what = "friction that grows with speed",
                       .check = "Switch the motor off and turn the joint by hand, slowly and fast: is fast much "
                                "harder? Look for thick, cold or too much grease.",
                       .cost = "Fast motion lags behind and warms the motor."},
          .demonstration = {.with = {{"friction.viscous_Nm_s_per_rad", 0.8}},
                            .against = Demonstration::Against::kVelocity}};
}

}  // namespace pmg::effects
