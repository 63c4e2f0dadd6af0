// T <= stall (1 - w / no_load), T <= power / w, or none beyond a speed; w the speed along T: MotorTorque.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::torque_speed() {
  return {
      .name = "torque_speed",
      .title = "torque-speed limit",
      .forms = {{.name = "line",
                 .title = "along a line to the no-load speed",
                 .parameters = {"drive.stall_torque_Nm", "drive.no_load_rad_s"},
                 .source = "Hughes, Drury 2013",
                 .starts =
                     [](const NominalJoint& joint) {
                       return pairs({0.5, 1.0, 1.8}, joint.peak, {1.05, 1.4, 2.5}, joint.speed);
                     }},
                {.name = "power",
                 .title = "of constant power",
                 .parameters = {"drive.most_power_W"},
                 .source = "Krishnan 2001",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(!joint.servo, each(joint.peak * joint.speed, 0.15, 0.4, 0.8));
                     }},
                {.name = "cut",
                 .title = "that cuts the torque at a speed",
                 .parameters = {"drive.cut_speed_rad_s"},
                 .source = "Leonhard 2001",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(!joint.servo, each(joint.speed, 0.9, 1.05, 1.2));
                     }}},
      .shows = "fast motion lags however high the gain",
      .needs = "large steps",
      .contains = {"viscous"},
      .workshop = {.what = "too little torque at high speed",
                   .check = "Measure the supply voltage while the joint moves fast. Check the current limit of the "
                            "drive, and that the motor is of the right type.",
                   .cost = "Fast motion under load falls short: a step that should catch the robot may be too slow."},
      .demonstration = {.command_rad = big_step,
                        .with = {{"drive.stall_torque_Nm", 8.0}, {"drive.no_load_rad_s", 3.5}}}};
}

}  // namespace pmg::effects
