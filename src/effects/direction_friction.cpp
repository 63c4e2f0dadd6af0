// Friction times 1 + asymmetry forwards, 1 - asymmetry backwards: GearFriction.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::direction_friction() {
  return {.name = "direction_friction",
          .title = "direction-dependent friction",
          .forms = {{.name = "dry",
                     .title = "of dry friction",
                     .parameters = {"friction.asymmetry"},
                     .source = "Armstrong-Helouvry, Dupont, Canudas de Wit 1994",
                     .starts = [](const NominalJoint&) { return each(1.0, -0.2, 0.2); }},
                    {.name = "viscous",
                     .title = "of viscous friction",
                     .parameters = {"friction.viscous_asymmetry"},
                     .source = "Canudas de Wit, Astrom, Braun 1987",
                     .starts =
                         [](const NominalJoint& joint) {
                           return only_if(joint.actuator.friction.viscous_Nm_s_per_rad > 0.0, each(1.0, -0.5, 0.5));
                         }},
                    {.name = "stribeck",
                     .title = "of Stribeck friction",
                     .parameters = {"friction.stribeck_asymmetry", "friction.stribeck_Nm", "friction.stribeck_rad_s"},
                     .shapes = {"friction.stribeck_rad_s"},
                     .source = "Armstrong-Helouvry 1991",
                     .starts =
                         [](const NominalJoint& joint) {
                           return Starts{{0.8, 0.1 * joint.torque, 0.1 * joint.speed},
                                         {-0.8, 0.1 * joint.torque, 0.1 * joint.speed}};
                         }}},
          .shows = "one direction misses more than the other, in proportion to the friction",
          .needs = "motion in both directions",
          // Dry friction is coulomb (1 + asymmetry direction).
          .strength = [](const MeasuredCheck& m) -> std::vector<double> {
            const double coulomb_Nm = m.joint.friction.coulomb_Nm;
            if (!(coulomb_Nm > 0.0)) return {};
            return {m.torque_Nm / coulomb_Nm};
          },
          .workshop = {.what = "friction that is stronger in one direction",
                       .check = "Switch the motor off and turn the joint both ways: is one way harder? Look for a "
                                "tilted bearing, a seal that rubs, or worn teeth.",
                       .cost = "It comes nearer to its target from one side than from the other."},
          .demonstration = {
              .command_rad = triangle, .with = {{"friction.asymmetry", 0.7}}, .both = {{"friction.coulomb_Nm", 0.6}}}};
}

}  // namespace pmg::effects
