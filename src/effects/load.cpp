// Inertia and gravity of the bench's loads times a factor.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::load() {
  return {
      .name = "load",
      .title = "mass, centre of mass or inertia",
      .forms = {{.name = "scales",
                 .parameters = {"load.inertia_scale", "load.gravity_scale"},
                 .source = "Atkeson, An, Hollerbach 1986",
                 .starts =
                     [](const NominalJoint&) {
                       return Starts{{0.8, 0.8}, {1.25, 1.25}, {1.2, 1.0}, {0.8, 1.0}, {1.0, 1.2}, {1.0, 0.8}};
                     }}},
      .shows = "swings too slowly or too fast; sags more or less than the load says",
      .needs = "steps, and poses away from hanging",
      .linear = true,
      // A wrong mass changes inertia and weight alike, and its check compares these two.
      .check = CheckSays::kNothingAgainst,
      .workshop =
          {.what = "a mass, or the place of a mass, that differs from what is written",
           .check =
               "Weigh the arm and its load and measure where their centre is. Compare with the numbers of the bench.",
           .cost = "The robot computes its balance with a wrong weight: it leans, and swings this limb too far or not "
                   "far enough."},
      .demonstration = {.with = {{"load.inertia_scale", 1.8}}}};
}

}  // namespace pmg::effects
