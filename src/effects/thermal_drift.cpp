// Friction times exp(friction_per_K (T - 25 degC)), torque times 1 + torque_per_K (T - 25 degC): Warmth.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::thermal_drift() {
  return {
      .name = "thermal_drift",
      .title = "thermal drift",
      .forms = {{.name = "friction_and_torque",
                 .title = "of all friction, or of torque",
                 .parameters = {"thermal.friction_per_K", "thermal.torque_per_K"},
                 .source = "Simoni, Beschi, Legnani, Visioli 2015; Hanselman 2006",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(joint.scale.temperature_recorded,
                                      {{-0.02, 0.0}, {0.02, 0.0}, {0.0, -0.01}, {0.0, 0.01}});
                     }},
                {.name = "viscous",
                 .title = "of viscous friction",
                 .parameters = {"thermal.viscous_per_K"},
                 .source = "Bittencourt, Gunnarsson 2012",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(joint.scale.temperature_recorded, each(1.0, -0.03, 0.02));
                     }},
                {.name = "resistance",
                 .title = "of the winding's resistance",
                 .parameters = {"thermal.resistance_per_K"},
                 .source = "Hughes, Drury 2013",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(joint.scale.temperature_recorded && joint.servo, each(1.0, 0.004));
                     }}},
      .shows = "runs of the same design differ with temperature",
      .needs = "a temperature column, and runs from cold to warm",
      .check = CheckSays::kAll,
      .workshop = {.what = "a joint that changes with its temperature",
                   .check =
                       "Record it cold and warm and compare. Check grease, cooling and the temperature of the motor.",
                   .cost = "Warm, the robot moves otherwise than when it was measured."},
      .demonstration = {
          .command_rad = sine, .with = {{"thermal.friction_per_K", 0.04}}, .both = {{"friction.coulomb_Nm", 0.3}}}};
}

}  // namespace pmg::effects
