// T = (amplitude + torque_share drive's torque) sin(order q + phase).
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::cogging() {
  return {.name = "cogging",
          .title = "cogging",
          .forms = {{.name = "sine",
                     .title = "of one size",
                     .parameters = {"ripple.amplitude_Nm", "ripple.order", "ripple.phase_rad"},
                     .shapes = {"ripple.order", "ripple.phase_rad"},
                     .source = "Jahns, Soong 1996",
                     .starts = [](const NominalJoint& joint) { return waves(joint, 0.1 * joint.torque, 0.25, 64.0); }},
                    {.name = "current",
                     .title = "in proportion to the drive's torque",
                     .parameters = {"ripple.torque_share", "ripple.order", "ripple.phase_rad"},
                     .shapes = {"ripple.order", "ripple.phase_rad"},
                     .source = "Holtz, Springob 1996",
                     .starts = [](const NominalJoint& joint) { return waves(joint, 0.2, 0.5, 32.0); }}},
          .shows = "misses with the joint's angle, several times a turn",
          .needs = "slow motion over a large part of a turn",
          .workshop = {.what = "a torque that repeats several times per turn",
                       .check = "Switch the motor off and turn the joint slowly by hand: do you feel steps? Look at "
                                "the magnets of the motor and the teeth of the gear.",
                       .cost = "Slow motion is uneven, and places between the steps are hard to hold."},
          .demonstration = {.command_rad = slow_ramp,
                            .with = {{"ripple.amplitude_Nm", 0.5}, {"ripple.order", 12.0}},
                            .against = Demonstration::Against::kPosition}};
}

}  // namespace pmg::effects
