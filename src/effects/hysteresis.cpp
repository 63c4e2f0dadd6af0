// The reading follows the joint with play: AngleSensor.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::hysteresis() {
  return {.name = "hysteresis",
          .title = "sensor hysteresis",
          .forms = {{.name = "play",
                     .parameters = {"sensor.hysteresis_rad"},
                     .source = "Krasnosel'skii, Pokrovskii 1989",
                     .starts = [](const NominalJoint&) { return each(1.0, 0.003, 0.01, 0.03); }}},
          .shows = "the reading waits at each reversal though the joint moves",
          .needs = "reversals under load",
          .workshop = {.what = "a position sensor that doesn't follow at once when the motion turns",
                       .check = "Check that the encoder sits firmly: screws, magnet, coupling.",
                       .cost = "Where it stands depends on where it came from: the robot never stands twice alike."},
          .demonstration = {.command_rad = triangle, .with = {{"sensor.hysteresis_rad", 0.06}}}};
}

}  // namespace pmg::effects
