// T = -stribeck exp(-|dq / stribeck_rad_s|^exponent) sign(dq): GearFriction.
#include "effects/named.hpp"

namespace pmg::effects {

namespace {

Starts stribeck_starts(const NominalJoint& joint) {
  return pairs({-0.15, 0.1, 0.3}, joint.torque, {0.05, 0.2}, joint.speed);
}

}  // namespace

Effect named::stribeck() {
  return {
      .name = "stribeck",
      .title = "Stribeck friction",
      .forms = {{.name = "exponent_2",
                 .title = "with exponent 2",
                 .parameters = {"friction.stribeck_Nm", "friction.stribeck_rad_s"},
                 .shapes = {"friction.stribeck_rad_s"},
                 .source = "Armstrong-Helouvry 1991",
                 .starts =
                     [](const NominalJoint& joint) {
                       return pairs({-0.15, -0.05, 0.05, 0.15, 0.4}, joint.torque, {0.02, 0.1, 0.4}, joint.speed);
                     }},
                {.name = "exponent_1",
                 .title = "with exponent 1",
                 .parameters = {"friction.stribeck_Nm", "friction.stribeck_rad_s"},
                 .shapes = {"friction.stribeck_rad_s"},
                 .fixed = {{"friction.stribeck_exponent", 1.0}},
                 .source = "Tustin 1947",
                 .starts = stribeck_starts},
                {.name = "exponent_0_5",
                 .title = "with exponent 0.5",
                 .parameters = {"friction.stribeck_Nm", "friction.stribeck_rad_s"},
                 .shapes = {"friction.stribeck_rad_s"},
                 .fixed = {{"friction.stribeck_exponent", 0.5}},
                 .source = "Bo, Pavelescu 1982",
                 .starts = stribeck_starts}},
      .shows = "sticks, then jumps; negative: friction grows with speed and levels off",
      .needs = "slow motion through rest",
      .contains = {"coulomb", "viscous"},
      .one_sign = true,
      .strength = [](const MeasuredCheck& m) -> std::vector<double> {
        return {m.torque_Nm, m.slow_rad_s};
      },
      .workshop = {.what = "friction that is different at very slow motion",
                   .check =
                       "Let the joint move very slowly: does it stick and jump? Clean and grease bearings and seals.",
                   .cost = "Slow motion sticks and jumps: the robot sways where it should stand still."},
      .demonstration = {.command_rad = slow_sine,
                        .with = {{"friction.stribeck_Nm", 0.7}, {"friction.stribeck_rad_s", 0.1}},
                        .kp_Nm_per_rad = 8.0}};
}

}  // namespace pmg::effects
