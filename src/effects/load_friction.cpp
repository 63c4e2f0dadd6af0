// T = -(load_driving or load_backdriving) |load| sign(dq): GearFriction.
#include "effects/named.hpp"

namespace pmg::effects {

namespace {

Starts load_friction_starts(const NominalJoint&) { return Starts{{0.1, 0.1}, {0.3, 0.3}}; }

}  // namespace

Effect named::load_friction() {
  return {.name = "load_friction",
          .title = "load-dependent friction",
          .forms = {{.name = "transmitted",
                     .title = "by the torque through the gear and the direction of power flow",
                     .parameters = {"friction.load_driving", "friction.load_backdriving"},
                     .source = "Dohring, Lee, Newman 1993; Verstraten et al. 2015",
                     .starts =
                         [](const NominalJoint&) {
                           return Starts{{0.1, 0.1}, {0.3, 0.3}, {0.7, 0.4}, {0.2, 0.0}, {0.0, 0.2}};
                         }},
                    {.name = "motor",
                     .title = "by the motor's torque",
                     .parameters = {"friction.load_driving", "friction.load_backdriving"},
                     .fixed = {{"friction.load_by_motor", 1.0}},
                     .source = "Duclusaud, Passault, Padois, Ly 2025",
                     .starts = load_friction_starts},
                    {.name = "net",
                     .title = "by the difference of motor torque and load",
                     .parameters = {"friction.load_driving", "friction.load_backdriving"},
                     .fixed = {{"friction.load_net", 1.0}},
                     .source = "Duclusaud, Passault, Padois, Ly 2025",
                     .starts = load_friction_starts}},
          .shows = "stops shorter under more load; lifting needs more than holding",
          .needs = "two loads",
          .one_sign = true,
          .strength = [](const MeasuredCheck& m) -> std::vector<double> {
            return {m.torque_Nm, m.torque_Nm};
          },
          .workshop = {.what = "friction that grows with the load",
                       .check = "Turn the joint with and without its load: does the load make it harder to turn? Look "
                                "at the teeth, the grease and the bearings of the gear.",
                       .cost = "It stops shorter the more it carries, and lifting takes more current than holding."},
          .demonstration = {.with = {{"friction.load_driving", 0.4}, {"friction.load_backdriving", 0.4}}}};
}

}  // namespace pmg::effects
