// |d command / dt| <= rate limit, of the position command or of the drive's output: CommandPath, MotorTorque.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::rate_limit() {
  return {
      .name = "rate_limit",
      .title = "rate limit",
      .forms = {{.name = "command",
                 .title = "of the command",
                 .parameters = {"command.rate_limit_rad_s"},
                 .source = "Duda 1997",
                 .starts =
                     [](const NominalJoint& joint) { return each(joint.speed, 0.3, 0.5, 0.7, 0.85, 1.0, 1.3, 2.0); }},
                {.name = "profile",
                 .title = "of the command, with an acceleration limit",
                 .parameters = {"command.rate_limit_rad_s", "command.acceleration_limit_rad_s2"},
                 .source = "Biagiotti, Melchiorri 2008",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(joint.closes_loop, pairs({0.7, 1.0, 1.5}, joint.speed, {5.0, 12.0}, joint.speed));
                     }},
                {.name = "output",
                 .title = "of the drive's output",
                 .parameters = {"drive.output_rate_limit_per_s"},
                 .source = "Klyde, McRuer, Myers 1997",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(joint.closes_loop, each(joint.scale.output, 5.0, 10.0, 20.0, 40.0));
                     }}},
      .shows = "steps rise along a line, the steeper the higher the gain; fast sines become triangles",
      .needs = "large steps",
      .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {m.value}; },
      .workshop = {.what = "a limit on how fast the command may change",
                   .check = "Look into the settings of the drive for a limit of speed or acceleration, or for a ramp.",
                   .cost = "Large fast motions come late: a step that should catch the robot may be too slow."},
      .demonstration = {.with = {{"command.rate_limit_rad_s", 1.5}}}};
}

}  // namespace pmg::effects
