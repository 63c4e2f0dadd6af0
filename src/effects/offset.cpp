// T = offset.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::offset() {
  return {.name = "offset",
          .title = "constant torque (asymmetry)",
          .forms = {{.name = "constant",
                     .parameters = {"ripple.offset_Nm"},
                     .source = "Craig 2005",
                     .starts = [](const NominalJoint& joint) { return each(joint.torque, -0.2, -0.05, 0.05, 0.2); }}},
          .shows = "pushed to one side by the same torque always, at rest too",
          .needs = "two gains, and motion in both directions",
          // The balance is drive = load + friction - constant torque.
          .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {-m.torque_Nm}; },
          .workshop = {.what = "a constant torque to one side",
                       .check = "Let the joint go where gravity doesn't turn it: does something push it? Look for a "
                                "cable, a hose or a spring that pulls.",
                       .cost = "It rests beside its target, always on the same side."},
          .demonstration = {.with = {{"ripple.offset_Nm", 1.0}}}};
}

}  // namespace pmg::effects
