// T = unit (supply (1 - sag duty T) duty - back_emf dq): MotorTorque.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::supply_sag() {
  return {
      .name = "supply_sag",
      .title = "bus sag",
      .forms = {{.name = "resistance",
                 .title = "of a source with a resistance",
                 .parameters = {"drive.supply_sag_per_Nm"},
                 .source = "Horowitz, Hill 2015",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(feels_bus(joint), each(1.0 / joint.peak, 0.05, 0.2, 0.5, 1.0));
                     }},
                {.name = "battery",
                 .title = "of a battery that takes time",
                 .parameters = {"drive.supply_sag_per_Nm", "drive.supply_sag_time_s", "drive.supply_sag_slow_share"},
                 .shapes = {"drive.supply_sag_time_s", "drive.supply_sag_slow_share"},
                 .source = "Chen, Rincon-Mora 2006",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(feels_bus(joint),
                                      followed_by(0.5, pairs({0.2, 0.6}, 1.0 / joint.peak, {0.2, 0.8}, 1.0)));
                     }},
                {.name = "limit",
                 .title = "of a supply with a current limit",
                 .parameters = {"drive.supply_limit_Nm"},
                 .source = "Horowitz, Hill 2015",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(feels_bus(joint), each(joint.peak, 0.2, 0.4, 0.7));
                     }}},
      .shows = "hard motion of a voltage servo is weaker than its gain says",
      .needs = "small and large steps",
      .workshop = {.what = "a supply voltage that falls under load",
                   .check = "Measure the voltage at the drive while the joint works hard. Check power supply, battery, "
                            "cables and plugs.",
                   .cost = "It is weakest when the robot needs it most."},
      .demonstration = {.command_rad = big_step,
                        .with = {{"drive.supply_sag_per_Nm", 0.2}},
                        // A hobby servo: full voltage from 0.4 rad of error; 3.6 Nm at rest, none at 10 rad/s.
                        .both = {{"drive.limit", 1.0},
                                 {"drive.kp_scale", 0.1},
                                 {"drive.kd_scale", 0.0},
                                 {"drive.torque_per_unit_Nm", 3.6},
                                 {"drive.back_emf_s_per_rad", 0.1}}}};
}

}  // namespace pmg::effects
