// T = stiffness x + hardening x^3 + damping dx, x the twist between motor and joint: Shaft.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::compliance() {
  return {.name = "compliance",
          .title = "compliance",
          .forms = {{.name = "spring_behind",
                     .title = "of a spring behind the friction",
                     .parameters = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                     .shapes = {"transmission.damping_Nm_s_per_rad"},
                     .source = "Spong 1987",
                     .starts = shafts},
                    {.name = "spring_before",
                     .title = "of a spring before the friction",
                     .parameters = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                     .shapes = {"transmission.damping_Nm_s_per_rad"},
                     .fixed = {{"transmission.friction_on_joint", 1.0}},
                     .source = "Albu-Schaffer, Ott, Hirzinger 2007",
                     .starts = shafts},
                    {.name = "hardening",
                     .title = "of a spring that hardens",
                     .parameters = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad",
                                    "transmission.hardening_Nm_per_rad3"},
                     .shapes = {"transmission.damping_Nm_s_per_rad"},
                     .source = "Tuttle, Seering 1996",
                     .starts = hardening_shafts},
                    {.name = "sensor_before",
                     .title = "behind the sensor",
                     .parameters = {"transmission.stiffness_Nm_per_rad", "transmission.damping_Nm_s_per_rad"},
                     .shapes = {"transmission.damping_Nm_s_per_rad"},
                     .fixed = {{"sensor.on_motor", 1.0}},
                     .source = "Sweet, Good 1985",
                     .starts = [](const NominalJoint& joint) { return only_if(joint.closes_loop, shafts(joint)); }}},
          .shows = "rings at a frequency of its own; bends with load",
          .needs = "steps, and two loads",
          .workshop = {.what = "a soft part between motor and output",
                       .check = "Hold the motor still and push the output: does it give way and spring back? Check "
                                "belt, coupling, gear and screws.",
                       .cost = "The limb gives way under load and swings after each stop."},
          .demonstration = {
              .with = {{"transmission.stiffness_Nm_per_rad", 40.0}, {"transmission.damping_Nm_s_per_rad", 0.1}}}};
}

}  // namespace pmg::effects
