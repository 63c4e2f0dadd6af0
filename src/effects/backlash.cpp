// The shaft carries no torque while its twist is within the play: Shaft.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::backlash() {
  return {.name = "backlash",
          .title = "backlash",
          .forms = {{.name = "friction_before",
                     .title = "with the friction before the gear and the sensor behind it",
                     .parameters = {"transmission.backlash_rad", "transmission.stiffness_Nm_per_rad",
                                    "transmission.damping_Nm_s_per_rad"},
                     .shapes = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                     .source = "Nordin, Galic, Gutman 1997",
                     .starts =
                         [](const NominalJoint& joint) {
                           return plays(joint, {0.005, 0.02, 0.06});
                         }},
                    {.name = "friction_behind",
                     .title = "with the friction behind the gear",
                     .parameters = {"transmission.backlash_rad", "transmission.stiffness_Nm_per_rad",
                                    "transmission.damping_Nm_s_per_rad"},
                     .shapes = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                     .fixed = {{"transmission.friction_on_joint", 1.0}},
                     .source = "Nordin, Gutman 2002",
                     .starts = [](const NominalJoint& joint) { return plays(joint, {0.005}); }},
                    {.name = "sensor_before",
                     .title = "with the sensor before the gear",
                     .parameters = {"transmission.backlash_rad", "transmission.stiffness_Nm_per_rad",
                                    "transmission.damping_Nm_s_per_rad"},
                     .shapes = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                     .fixed = {{"sensor.on_motor", 1.0}},
                     .source = "Nordin, Gutman 2002",
                     .starts =
                         [](const NominalJoint& joint) { return only_if(joint.closes_loop, plays(joint, {0.005})); }}},
          .shows = "a dead spot at each reversal",
          .needs = "reversals with little load",
          .contains = {"compliance"},
          .workshop = {.what = "play in the gear",
                       .check = "Hold the motor still and rock the output by hand: is there a dead spot? Check gear, "
                                "keys, couplings and screws.",
                       .cost = "The limb is loose by this play: it knocks where its load changes sides, and the robot "
                               "sways within it."},
          .demonstration = {
              .command_rad = triangle,
              .with = {{"transmission.backlash_rad", 0.06}},
              .both = {{"transmission.stiffness_Nm_per_rad", 2000.0}, {"transmission.damping_Nm_s_per_rad", 2.0}},
              .gravity_Nm = 0.2}};
}

}  // namespace pmg::effects
