// reading = q + eccentricity sin(order q + phase) + ellipticity sin(2 q + its phase): AngleSensor.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::eccentricity() {
  return {.name = "eccentricity",
          .title = "sensor eccentricity",
          .forms = {{.name = "once_a_turn",
                     .title = "once a turn",
                     .parameters = {"sensor.eccentricity_rad", "sensor.eccentricity_phase_rad"},
                     .shapes = {"sensor.eccentricity_phase_rad"},
                     .source = "Sanchez-Brea, Morlanes 2008",
                     .starts =
                         [](const NominalJoint&) {
                           return Starts{{0.02, 0.0}};
                         }},
                    {.name = "ellipse",
                     .title = "of a disc that is not round either",
                     .parameters = {"sensor.eccentricity_rad", "sensor.eccentricity_phase_rad",
                                    "sensor.ellipticity_rad", "sensor.ellipticity_phase_rad"},
                     .shapes = {"sensor.eccentricity_phase_rad", "sensor.ellipticity_phase_rad"},
                     .source = "Sanchez-Brea, Morlanes 2008",
                     .starts =
                         [](const NominalJoint&) {
                           return Starts{{0.02, 0.0, 0.01, 0.0}};
                         }},
                    {.name = "motor_shaft",
                     .title = "of a disc on the motor's shaft",
                     .parameters = {"sensor.eccentricity_rad", "sensor.eccentricity_order",
                                    "sensor.eccentricity_phase_rad"},
                     .shapes = {"sensor.eccentricity_order", "sensor.eccentricity_phase_rad"},
                     .source = "Ellin, Dolsak 2008",
                     .starts = [](const NominalJoint& joint) { return waves(joint, 0.005, 0.5, 32.0); }}},
          .shows = "misses with the joint's angle, once a turn",
          .needs = "motion over a large part of a turn",
          .workshop = {.what = "a position sensor that isn't centred",
                       .check = "Check that the magnet or disc of the encoder is centred on the shaft.",
                       .cost = "Its angle is too large at some places and too small at others."},
          .demonstration = {.command_rad = slow_ramp,
                            .with = {{"sensor.eccentricity_rad", 0.15}},
                            .against = Demonstration::Against::kPosition}};
}

}  // namespace pmg::effects
