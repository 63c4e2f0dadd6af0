// What happens to a command before the drive acts.
#include "effects/families.hpp"

namespace pmg::effects {

std::vector<Effect> command_effects() {
  return {
      {.name = "delay",
       .title = "delay",
       .forms = {law("commands", "of commands", {"command.delay_s"}, "Smith 1957", each({2.0, 5.0, 10.0, 20.0, 40.0})),
                 called({.what = "position readings that are old when they arrive",
                         .check = "Measure the time from a motion to its reading. Check the load of the bus, and "
                                  "filters in the drive."},
                        law("readings", "of readings", {"sensor.delay_s"}, "Nilsson 1998",
                            where(closes_loop, each({3.0, 10.0})))),
                 law("loop", "of commands and readings alike", {"drive.torque_delay_s"}, "Astrom, Wittenmark 1997",
                     where(closes_loop, each({3.0, 10.0})))},
       .shows = "every step starts late by the same time",
       .needs = "steps or fast motion",
       .workshop =
           {"a delay between command and motion",
            "Measure the time from a command to the motion. Check the load of the bus, and filters in the drive.",
            "The robot answers late to a push, and shakes where its gains are high."},
       .strength = itself,
       .never_negative = true},
      {.name = "rate_limit",
       .title = "rate limit",
       .forms = {law("command", "of the command", {"command.rate_limit_rad_s"}, "Duda 1997",
                     each({0.3, 0.5, 0.7, 0.85, 1.0, 1.3, 2.0})),
                 law("profile", "of the command, with an acceleration limit",
                     {"command.rate_limit_rad_s", "command.acceleration_limit_rad_s2"}, "Biagiotti, Melchiorri 2008",
                     where(closes_loop, grid({{0.7, 1.0, 1.5}, {5.0, 12.0}}))),
                 called({.what = "a drive whose output can grow only so fast",
                         .check = "Look into the settings of the drive for a ramp of its current or voltage."},
                        law("output", "of the drive's output", {"drive.output_rate_limit_per_s"},
                            "Klyde, McRuer, Myers 1997", where(closes_loop, each({5.0, 10.0, 20.0, 40.0}))))},
       .shows = "steps rise along a line, the steeper the higher the gain; fast sines become triangles",
       .needs = "large steps",
       .workshop = {"a limit on how fast the command may change",
                    "Look into the settings of the drive for a limit of speed or acceleration, or for a ramp.",
                    "Large fast motions come late: a step that should catch the robot may be too slow."},
       .strength = itself},
      {.name = "hold",
       .title = "sample and hold",
       .forms = {called({.what = "a drive that renews its output too seldom",
                         .check = "Look into the settings of the drive: how often does its control loop run?"},
                        law("output", "of the drive's output", {"command.hold_s"}, "Astrom, Wittenmark 1997",
                            each({2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0}))),
                 law("commands", "of commands", {"command.update_s"}, "Franklin, Powell, Workman 1998",
                     where(closes_loop, each({20.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0}))),
                 called({.what = "a position that the drive reads too seldom",
                         .check =
                             "Look into the settings of the drive and of its sensor: how often is the position read?"},
                        law("readings", "of readings", {"sensor.hold_s"}, "Franklin, Powell, Workman 1998",
                            where(closes_loop, each({4.0, 8.0, 12.0, 16.0, 20.0, 25.0}))))},
       .shows = "the output has steps of its own",
       .needs = "fast motion, fast recording",
       .workshop = {"commands that the drive takes too seldom",
                    "Look into the settings of the drive: how often does it take a command?",
                    "It moves in small jerks, and shakes where its gains are high."},
       .demonstration = {.command = shown::sine}},
  };
}

}  // namespace pmg::effects
