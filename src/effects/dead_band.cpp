// No output where |error| is below the band: ControlLaw.
#include "effects/named.hpp"

namespace pmg::effects {

Effect named::dead_band() {
  return {
      .name = "dead_band",
      .title = "dead band",
      .forms = {{.name = "jumps",
                 .title = "that jumps at its edge",
                 .parameters = {"drive.dead_band_rad"},
                 .source = "Gelb, Vander Velde 1968",
                 .starts = [](const NominalJoint&) { return each(1.0, 0.003, 0.01, 0.03); }},
                {.name = "subtracts",
                 .title = "that subtracts its width",
                 .parameters = {"drive.dead_band_rad"},
                 .fixed = {{"drive.dead_band_subtracts", 1.0}},
                 .source = "Tao, Kokotovic 1994",
                 .starts = [](const NominalJoint& joint) { return only_if(joint.closes_loop, each(1.0, 0.01, 0.03)); }},
                {.name = "output",
                 .title = "of the drive's output",
                 .parameters = {"drive.output_dead_band"},
                 .source = "Leggate, Kerkman 1997",
                 .starts = [](const NominalJoint& joint) { return each(joint.scale.output, 0.05, 0.2); }},
                {.name = "wakes_later",
                 .title = "that ends later than it begins",
                 .parameters = {"drive.dead_band_rad", "drive.dead_band_wake_rad"},
                 .source = "Gelb, Vander Velde 1968",
                 .starts =
                     [](const NominalJoint& joint) {
                       return only_if(joint.closes_loop, Starts{{0.01, 0.01}, {0.03, 0.03}});
                     }}},
      .shows = "errors below a threshold give no output",
      .needs = "two gains: the error at rest is the same",
      .one_sign = true,
      .strength = [](const MeasuredCheck& m) -> std::vector<double> { return {m.value}; },
      .workshop = {.what = "small errors that the drive ignores",
                   .check = "Look into the settings of the drive for a dead band or a smallest output.",
                   .cost = "It rests a little beside its target and drifts about it."},
      .demonstration = {.with = {{"drive.dead_band_rad", 0.08}}}};
}

}  // namespace pmg::effects
