// The position loop's gain or all torque times a factor; or T / (1 + saturation |T|): ControlLaw, MotorTorque.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::gain() {
  return {.name = "gain",
          .title = "wrong gain or unit",
          .forms = {{.name = "position",
                     .title = "of the position loop",
                     .parameters = {"drive.kp_scale"},
                     .source = "Ljung 1999",
                     .starts =
                         [](const NominalJoint& joint) {
                           return each(joint.actuator.drive.kp_scale, 0.6, 0.8, 0.9, 1.1, 1.25, 1.6);
                         }},
                    {.name = "torque",
                     .title = "of all torque",
                     .parameters = {"drive.torque_scale"},
                     .source = "Gautier, Briot 2014",
                     .starts = [](const NominalJoint&) { return each(1.0, 0.7, 0.9, 1.1, 1.4); }},
                    {.name = "saturation",
                     .title = "that falls with torque",
                     .parameters = {"drive.saturation_per_Nm"},
                     .source = "Hanselman 2006",
                     .starts = [](const NominalJoint& joint) { return each(1.0 / joint.torque, 0.05, 0.2); }}},
          .shows = "all errors are too large, or too small, by a factor",
          .needs = "load, or steps",
          .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {m.value}; },
          .workshop = {.what = "a drive that is stronger or weaker than its number says",
                       .check = "Compare the gains and their units in the drive with those of the simulation. Check "
                                "gear ratio and motor type.",
                       .cost = "The robot stands stiffer or softer than its controller expects."},
          .demonstration = {.with = {{"drive.kp_scale", 0.6}}}};
}

}  // namespace pmg::effects
