// Output, command or reading changes once a period only: ControlLaw, CommandPath, AngleSensor.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::hold() {
  return {.name = "hold",
          .title = "sample and hold",
          .forms = {{.name = "output",
                     .title = "of the drive's output",
                     .parameters = {"command.hold_s"},
                     .source = "Astrom, Wittenmark 1997",
                     .starts =
                         [](const NominalJoint&) {
                           return each(1e-3, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0);
                         }},
                    {.name = "commands",
                     .title = "of commands",
                     .parameters = {"command.update_s"},
                     .source = "Franklin, Powell, Workman 1998",
                     .starts =
                         [](const NominalJoint& joint) {
                           return only_if(joint.closes_loop, each(1e-3, 20.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0));
                         }},
                    {.name = "readings",
                     .title = "of readings",
                     .parameters = {"sensor.hold_s"},
                     .source = "Franklin, Powell, Workman 1998",
                     .starts =
                         [](const NominalJoint& joint) {
                           return only_if(joint.closes_loop, each(1e-3, 4.0, 8.0, 12.0, 16.0, 20.0, 25.0));
                         }}},
          .shows = "the output has steps of its own",
          .needs = "fast motion, fast recording",
          .workshop = {.what = "commands that the drive takes too seldom",
                       .check = "Look into the settings of the drive: how often does it take a command?",
                       .cost = "It moves in small jerks, and shakes where its gains are high."},
          .demonstration = {.command_rad = sine, .with = {{"command.hold_s", 0.06}}}};
}

}  // namespace pmg::effects
