// reading = quantum round(q / quantum): AngleSensor.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::quantisation() {
  return {.name = "quantisation",
          .title = "quantisation",
          .forms = {{.name = "rounds",
                     .parameters = {"sensor.quantum_rad"},
                     .source = "Widrow, Kollar 2008",
                     .starts =
                         [](const NominalJoint& joint) {
                           return only_if(joint.scale.quantum_rad > 0.0, {{joint.scale.quantum_rad}});
                         }}},
          .shows = "readings are multiples of one number",
          .needs = "slow motion",
          .check = CheckSays::kSize,
          .workshop = {.what = "position readings in coarse steps",
                       .check = "Check the resolution of the encoder, and how many digits the recording keeps.",
                       .cost = "The speed that the drive computes is rough: it growls and wears."},
          .demonstration = {.command_rad = slow_sine, .with = {{"sensor.quantum_rad", 0.02}}}};
}

}  // namespace pmg::effects
