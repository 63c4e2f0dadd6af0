// Friction times exp(friction_per_Nm2_s H), dH/dt = torque^2 - H / cooling; or torque falls so: Warmth.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::self_heating() {
  return {
      .name = "self_heating",
      .title = "self-heating",
      .forms = {{.name = "friction_winding",
                 .title = "of friction, by the winding's heat",
                 .parameters = {"thermal.friction_per_Nm2_s"},
                 .source = "Simoni, Beschi, Legnani, Visioli 2015",
                 .starts =
                     [](const NominalJoint& joint) {
                       return each(1.0 / (joint.torque * joint.torque), -0.2, 0.2, -2.0);
                     }},
                {.name = "friction_own",
                 .title = "of friction, by its own heat",
                 .parameters = {"thermal.friction_per_J"},
                 .source = "Bittencourt, Gunnarsson 2012",
                 .starts =
                     [](const NominalJoint& joint) {
                       return each(1.0 / (0.1 * joint.torque * joint.speed * joint.scale.duration_s), -0.3, 0.3, -3.0);
                     }},
                {.name = "torque_winding",
                 .title = "of torque, by the winding's heat",
                 .parameters = {"thermal.torque_per_Nm2_s", "thermal.cooling_s"},
                 .shapes = {"thermal.cooling_s"},
                 .source = "Urata et al. 2008",
                 .starts =
                     [](const NominalJoint& joint) {
                       return followed_by(
                           10.0 * joint.scale.duration_s,
                           each(1.0 / (joint.torque * joint.torque * joint.scale.duration_s), -0.1, -0.4));
                     }},
                {.name = "torque_time",
                 .title = "of torque, by time",
                 .parameters = {"thermal.torque_fade_share", "thermal.torque_fade_s"},
                 .shapes = {"thermal.torque_fade_s"},
                 .source = "Urata et al. 2008",
                 .starts =
                     [](const NominalJoint& joint) {
                       return pairs({0.15}, 1.0, {0.15, 0.5}, joint.scale.duration_s);
                     }}},
      .shows = "friction or torque changes along a run, the more the harder it works",
      .needs = "long runs of hard work",
      .workshop = {.what = "friction that changes as the joint works",
                   .check = "Let the joint work hard for a long time, then turn it by hand and compare with before. "
                            "Check grease and cooling.",
                   .cost = "After hard work it moves otherwise than before."},
      .demonstration = {
          .command_rad = sine, .with = {{"thermal.friction_per_Nm2_s", 0.3}}, .both = {{"friction.coulomb_Nm", 0.3}}}};
}

}  // namespace pmg::effects
