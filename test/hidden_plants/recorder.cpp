#include "recorder.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "plant.hpp"

namespace pmg::hidden {

namespace {

constexpr double kPushStep_s = 1e-3;
constexpr double kMostDropouts = 0.01;  // of the samples
constexpr double kFurthest_rad = 2.5, kUsualMiss_rad = 0.6;

/// A torque that wanders: first-order coloured noise.
class WanderingPush {
 public:
  WanderingPush(const RigNoise& noise, Draw& draw) : noise_(noise), draw_(draw) {
    push_Nm_ = noise.push_Nm * draw.normal();
  }
  double next() {
    const double keeps = std::exp(-kPushStep_s / noise_.push_corner_s);
    push_Nm_ = keeps * push_Nm_ + std::sqrt(1.0 - keeps * keeps) * noise_.push_Nm * draw_.normal();
    return push_Nm_;
  }

 private:
  const RigNoise& noise_;
  Draw& draw_;
  double push_Nm_;
};

/// Sample times: a host that reads when it gets round to it.
std::vector<double> sample_times(const Rig& rig, std::size_t samples, Draw& draw) {
  std::vector<double> t_s;
  for (std::size_t k = 0; k < samples; ++k) {
    const double late = k == 0 ? 0.0 : draw.uniform(-0.5, 0.5) * rig.noise.jitter;
    t_s.push_back(1e-6 * std::round(1e6 * (static_cast<double>(k) + late) / rig.sample_rate_hz));
  }
  return t_s;
}

void drop_out(const Rig& rig, Draw& draw, std::vector<double>& q_rad) {
  const double each = std::min(kMostDropouts, rig.noise.dropouts_per_s / rig.sample_rate_hz);
  for (std::size_t k = 2; k + 2 < q_rad.size(); ++k) {
    if (!draw.chance(each)) continue;
    q_rad[k] += draw.sign() * draw.uniform(0.8, 2.0);
    k += 3;
  }
}

void move_until(Plant& plant, double from_s, double to_s, const PlantCommand& command, WanderingPush& push) {
  const int pieces = std::max(1, static_cast<int>(std::round((to_s - from_s) / kPushStep_s)));
  for (int i = 0; i < pieces; ++i) {
    plant.disturb(push.next());
    plant.advance((to_s - from_s) / pieces, command);
  }
}

}  // namespace

PlantRecording record(const PlantParameters& parameters, const Rig& rig, std::uint64_t seed, const PlantRun& run) {
  Draw draw(seed, 100000 + run.stream);
  PlantParameters p = parameters;
  p.body.load_inertia_kg_m2 = run.load.inertia_kg_m2 * run.mass_factor;
  p.body.load_gravity_Nm = run.load.gravity_Nm * run.mass_factor;
  Plant plant(p);
  plant.reset(rig.noise.start_rad * draw.normal(), run.temperature_C);
  WanderingPush push(rig.noise, draw);

  PlantRecording recording;
  recording.t_s = sample_times(rig, run.command.q_rad.size(), draw);
  recording.q_cmd_rad = run.command.q_rad;
  const double released_from_s = recording.t_s.back() - run.command.released_s;
  for (std::size_t k = 0; k < recording.t_s.size(); ++k) {
    recording.enabled.push_back(run.command.released_s == 0.0 || recording.t_s[k] < released_from_s);
    recording.q_rad.push_back(plant.reading_rad(rig.noise.sensor_rad * draw.normal()));
    recording.temp_C.push_back(0.1 * std::round(10.0 * (plant.temperature_C() + 0.1 * draw.normal())));
    if (k + 1 == recording.t_s.size()) break;
    const PlantCommand command{run.command.q_rad[k], run.kp, run.kd, rig.bus_V, recording.enabled.back()};
    move_until(plant, recording.t_s[k], recording.t_s[k + 1], command, push);
  }
  drop_out(rig, draw, recording.q_rad);
  return recording;
}

PlantRun run_of(const HiddenPlant& hidden, std::size_t index, std::uint64_t take) {
  const Rig& rig = hidden.rig;
  const RigRun& design = rig.runs.at(index);
  const double share = static_cast<double>(index) / static_cast<double>(rig.runs.size());
  return {.kp = rig.gains[design.gains].kp,
          .kd = rig.gains[design.gains].kd,
          .load = rig.loads[design.load],
          .mass_factor = rig.mass_factor[design.load],
          .command = rig.commands[design.command],
          .temperature_C = 25.0 + rig.warms_K * (1.0 - std::exp(-3.0 * share)),
          .stream = 1000 * take + index};
}

bool follows_its_commands(const HiddenPlant& hidden) {
  for (std::size_t i = 0; i < hidden.rig.runs.size(); ++i) {
    if (hidden.rig.runs[i].repeat > 0) continue;
    const PlantRecording r = record(hidden.plant, hidden.rig, hidden.seed, run_of(hidden, i));
    double missed_rad = 0.0;
    for (std::size_t k = 0; k < r.q_rad.size(); ++k) {
      if (!(std::abs(r.q_rad[k]) < kFurthest_rad + 2.0)) return false;  // dropouts leap by 2
      missed_rad += std::abs(r.q_rad[k] - r.q_cmd_rad[k]);
    }
    if (missed_rad / static_cast<double>(r.q_rad.size()) > kUsualMiss_rad) return false;
  }
  return true;
}

double mean_absolute_difference_rad(const PlantRecording& a, const PlantRecording& b) {
  if (a.q_rad.size() != b.q_rad.size()) throw std::invalid_argument("recordings of different commands");
  double sum_rad = 0.0;
  for (std::size_t k = 0; k < a.q_rad.size(); ++k) sum_rad += std::abs(a.q_rad[k] - b.q_rad[k]);
  return sum_rad / static_cast<double>(a.q_rad.size());
}

}  // namespace pmg::hidden
