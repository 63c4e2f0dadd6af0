#include "asked_for.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::literature {

namespace {

std::size_t nearest_load(const Rig& rig, const diagnosis::NextRun& asked) {
  const auto away = [&](const Load& load) {
    return std::abs(load.mass_kg - asked.load_mass_kg) + std::abs(load.length_m - asked.load_length_m);
  };
  const auto nearest = std::min_element(rig.loads.begin(), rig.loads.end(),
                                        [&](const Load& a, const Load& b) { return away(a) < away(b); });
  return static_cast<std::size_t>(nearest - rig.loads.begin());
}

void add(Rig& rig, const diagnosis::NextRun& asked) {
  RunDesign run{.gains = rig.gains.size(),
                .load = nearest_load(rig, asked),
                .trajectory = rig.trajectories.size(),
                .asked_for = true};
  rig.gains.push_back({asked.kp, asked.kd});
  rig.trajectories.push_back({.name = asked.name, .q_rad = asked.q_cmd_rad, .dq_rad_s = {}, .ddq_rad_s2 = {}});
  differentiate(rig.trajectories.back(), rig.sample_rate_hz);
  for (run.repeat = 0; run.repeat < asked.times; ++run.repeat) rig.runs.push_back(run);
}

}  // namespace

LiteraturePlant with_asked_runs(LiteraturePlant plant, const diagnosis::NextExcitation& asked) {
  for (const diagnosis::NextRun& run : asked.runs) {
    add(plant.rig, run);
    add(plant.sound_rig, run);
  }
  return plant;
}

}  // namespace pmg::literature
