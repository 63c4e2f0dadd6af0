// Commands, readings or the drive's torque act late by a constant time: CommandPath, AngleSensor, MotorTorque.
#include "effects/named.hpp"

namespace pmg::effects {

namespace {

Starts delay_starts(const NominalJoint& joint) { return only_if(joint.closes_loop, each(1e-3, 3.0, 10.0)); }

}  // namespace

Effect named::delay() {
  return {
      .name = "delay",
      .title = "delay",
      .forms = {{.name = "commands",
                 .title = "of commands",
                 .parameters = {"command.delay_s"},
                 .source = "Smith 1957",
                 .starts = [](const NominalJoint&) { return each(1e-3, 2.0, 5.0, 10.0, 20.0, 40.0); }},
                {.name = "readings",
                 .title = "of readings",
                 .parameters = {"sensor.delay_s"},
                 .source = "Nilsson 1998",
                 .starts = delay_starts},
                {.name = "loop",
                 .title = "of commands and readings alike",
                 .parameters = {"drive.torque_delay_s"},
                 .source = "Astrom, Wittenmark 1997",
                 .starts = delay_starts}},
      .shows = "every step starts late by the same time",
      .needs = "steps or fast motion",
      .one_sign = true,
      .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {m.value}; },
      .workshop =
          {.what = "a delay between command and motion",
           .check =
               "Measure the time from a command to the motion. Check the load of the bus, and filters in the drive.",
           .cost = "The robot answers late to a push, and shakes where its gains are high."},
      .demonstration = {.with = {{"command.delay_s", 0.06}}}};
}

}  // namespace pmg::effects
