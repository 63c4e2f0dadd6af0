#include "evaluation/table2.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "policy/policy.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::evaluation {

namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

std::vector<int> policy_joints(const model::RobotModel& robot) {
  std::vector<int> joints;
  for (int j = 0; j < robot.joint_index.size(); ++j) {
    if (robot.joints[static_cast<std::size_t>(j)].policy) joints.push_back(j);
  }
  return joints;
}

/// Records the policy's joints in a walking simulation: their true angles, not the encoders' readings.
class WalkObserver {
 public:
  WalkObserver(Walk& walk, const model::RobotModel& robot, const sil::Scenario& scenario)
      : walk_(walk), robot_(robot), scenario_(scenario), joints_(policy_joints(robot)) {
    walk_.curves = WalkCurves(scenario.steps.size(), joints_.size());
  }
  bool operator()(const sil::RunProgress& now, sim::World& world) {
    const auto step = static_cast<std::size_t>(&now.step - scenario_.steps.data());
    if (now.result.mode != control::Mode::kWalk || now.result.reference.gain <= 0.0) return true;
    if (now.time_s < now.step.start_s + WalkCurves::kSettle_s) return true;
    const auto count = static_cast<Eigen::Index>(joints_.size());
    JointVector q(count), q_ref(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int joint = joints_[static_cast<std::size_t>(i)];
      const int id = mj_name2id(world.mj_model(), mjOBJ_JOINT, robot_.joint_index.name(joint).c_str());
      q[i] = world.mj_data()->qpos[world.mj_model()->jnt_qposadr[id]];
      q_ref[i] = now.result.reference.q[joint];
    }
    walk_.curves.add(step, now.result.reference.phase, q, q_ref);
    return true;
  }

 private:
  Walk& walk_;
  const model::RobotModel& robot_;
  const sil::Scenario& scenario_;
  std::vector<int> joints_;
};

/// A walk to simulate, and the place for its result.
struct Errand {
  Walk* walk;
  sim::ActuatorsByJoint motors;
  std::uint64_t seed;
};

/// The same motors with other commanded gains than the policy's: the simulation always commands the policy's, so the
/// ratio becomes the drives' gain scale.
sim::ActuatorsByJoint told(sim::ActuatorsByJoint motors, const model::RobotModel& robot, const Gains& policy,
                           const Gains& gains) {
  for (const int joint : policy_joints(robot)) {
    model::ActuatorParameters& p = motors[robot.joint_index.name(joint)];
    p.drive.kp_scale *= gains.kp_Nm_per_rad[joint] / policy.kp_Nm_per_rad[joint];
    p.drive.kd_scale *= gains.kd_Nm_s_per_rad[joint] / policy.kd_Nm_s_per_rad[joint];
  }
  return motors;
}

sim::ActuatorsByJoint corrected(sim::ActuatorsByJoint plant, const std::vector<FoundOffset>& offsets) {
  for (const FoundOffset& found : offsets) {
    if (plant.contains(found.joint)) plant[found.joint].sensor.zero_offset_rad -= found.zero_offset_rad;
  }
  return plant;
}

double worst_offset_rad(const sim::ActuatorsByJoint& plant) {
  double worst = 0.0;
  for (const auto& [name, p] : plant) worst = std::max(worst, std::abs(p.sensor.zero_offset_rad));
  return worst;
}

Gains gains_of(const control::LoadedControl& loaded) {
  const auto count = static_cast<Eigen::Index>(loaded.robot.joints.size());
  Gains gains{JointVector(count), JointVector(count)};
  for (Eigen::Index j = 0; j < count; ++j) {
    gains.kp_Nm_per_rad[j] = loaded.robot.joints[static_cast<std::size_t>(j)].kp_Nm_per_rad;
    gains.kd_Nm_s_per_rad[j] = loaded.robot.joints[static_cast<std::size_t>(j)].kd_Nm_s_per_rad;
  }
  if (const auto own = loaded.policy->gains()) gains = {own->kp_Nm_per_rad, own->kd_Nm_s_per_rad};
  return gains;
}

void calibrate(Table2& table, const model::RobotModel& robot, const Gains& gains, const std::filesystem::path& folder,
               const Supervision& supervision) {
  table.plants.resize(static_cast<std::size_t>(table.ranges.plants));
  for_each_piece(table.plants.size(), supervision, [&](std::size_t k) {
    CalibratedPlant& plant = table.plants[k];
    const auto number = static_cast<unsigned>(k + 1);
    const std::filesystem::path place = folder / "plants" / std::to_string(number);
    std::filesystem::create_directories(place);
    plant.truth = draw_plant(table.ranges, robot, static_cast<int>(number));
    plant.motors = calibrated_motors(plant.truth, robot, gains, number);
    plant.offsets = calibrated_offsets(plant.truth, robot, place, number, supervision.progress);
    plant.worst_offset_rad = worst_offset_rad(corrected(plant.truth, plant.offsets));
  });
  if (supervision.interrupted_now()) table.complete = false;
}

/// Every walk of the table: three kinds of robot per plant, three kinds of simulation.
struct Walks {
  std::vector<Walk> as_it_is, informed, corrected;  // by plant
  std::vector<Walk> nominal, informed_nominal;      // by seed
  std::vector<std::vector<Walk>> fitted;            // by plant and seed
};

WalkCurves pooled(const std::vector<Walk>& walks) {
  WalkCurves all = walks.front().curves;
  for (std::size_t k = 1; k < walks.size(); ++k) all.add(walks[k].curves);
  return all;
}

int falls(const std::vector<Walk>& walks) { return static_cast<int>(std::ranges::count_if(walks, &Walk::fell)); }

void summarise(Table2& table, const Walks& walks) {
  const WalkCurves nominal = pooled(walks.nominal), informed = pooled(walks.informed_nominal);
  const std::size_t knee_step = table.scenario.steps.size() - 2, knee = 3;
  for (std::size_t c = 0; c < kConfigurations; ++c) {
    const std::vector<Walk>& robots = c == kPhysicallyInformed ? walks.informed
                                      : c == kFullCalibration  ? walks.corrected
                                                               : walks.as_it_is;
    ConfigurationResult& result = table.results[c];
    result.robot_falls = falls(robots);
    result.simulation_falls = c == kBaseline             ? falls(walks.nominal)
                              : c == kPhysicallyInformed ? falls(walks.informed_nominal)
                                                         : 0;
    for (std::size_t k = 0; k < robots.size(); ++k) {
      const bool fitted = c == kDynamicCalibration || c == kFullCalibration;
      if (fitted) result.simulation_falls += falls(walks.fitted[k]);
      const WalkCurves simulation = fitted ? pooled(walks.fitted[k]) : c == kBaseline ? nominal : informed;
      if (k == 0) {
        table.shown_robot[c] = robots[k].curves.curve(knee_step, knee);
        table.shown_simulation[c] = simulation.curve(knee_step, knee);
      }
      if (!robots[k].complete) continue;
      result.add(robots[k].curves.imitation_rad(), WalkCurves::difference_rad(robots[k].curves, simulation));
    }
  }
}

/// "8 of 10 robots: ...", for a configuration in which some fell.
std::string falls_text(const ConfigurationResult& one) {
  const std::size_t on_the_way =
      one.fell_on_the_way() ? static_cast<std::size_t>(one.robot_falls) - one.robots_without_errors : 0;
  std::vector<std::string> parts;
  if (one.robots_without_errors > 0)
    parts.push_back(fmt::format("{} fell before they had walked", one.robots_without_errors));
  if (on_the_way > 0) parts.push_back(fmt::format("{} fell on the way", on_the_way));
  if (one.simulation_falls > 0)
    parts.push_back(fmt::format("{} simulated walks ended in a fall", one.simulation_falls));
  return fmt::format("{} of {} robots: {}{}", one.imitation_of_plant_rad.size(), one.robots(), fmt::join(parts, ", "),
                     on_the_way > 0 || one.simulation_falls > 0 ? " (errors are of the steps before the fall)" : "");
}

}  // namespace

Gains informed_gains(const model::RobotModel& robot, const Gains& otherwise) {
  constexpr double kOmega = 2.0 * std::numbers::pi * kNaturalFrequency_Hz;
  Gains gains = otherwise;
  for (const int joint : policy_joints(robot)) {
    const double inertia = robot.joints[static_cast<std::size_t>(joint)].armature_kg_m2;
    gains.kp_Nm_per_rad[joint] = inertia * kOmega * kOmega;
    gains.kd_Nm_s_per_rad[joint] = 2.0 * kDampingRatio * inertia * kOmega;
  }
  return gains;
}

WalkCurves::WalkCurves(std::size_t steps, std::size_t joints)
    : steps_(steps), joints_(joints), sum_rad_(steps * kBins * joints, 0.0), count_(sum_rad_.size(), 0.0) {}

void WalkCurves::add(std::size_t step, double phase, const JointVector& q_rad, const JointVector& q_ref_rad) {
  const std::size_t bin = std::min(kBins - 1, static_cast<std::size_t>(phase * static_cast<double>(kBins)));
  for (std::size_t j = 0; j < joints_; ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    sum_rad_[index(step, bin, j)] += q_rad[i];
    count_[index(step, bin, j)] += 1.0;
    squares_rad2_ += (q_rad[i] - q_ref_rad[i]) * (q_rad[i] - q_ref_rad[i]);
    samples_ += 1.0;
  }
}

void WalkCurves::add(const WalkCurves& other) {
  for (std::size_t i = 0; i < sum_rad_.size(); ++i) {
    sum_rad_[i] += other.sum_rad_[i];
    count_[i] += other.count_[i];
  }
  squares_rad2_ += other.squares_rad2_;
  samples_ += other.samples_;
}

double WalkCurves::imitation_rad() const { return samples_ > 0.0 ? std::sqrt(squares_rad2_ / samples_) : kNotMeasured; }

double WalkCurves::difference_rad(const WalkCurves& a, const WalkCurves& b) {
  if (a.sum_rad_.size() != b.sum_rad_.size()) throw std::invalid_argument("walks of different scenarios");
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < a.sum_rad_.size(); ++i) {
    if (a.count_[i] == 0.0 || b.count_[i] == 0.0) continue;
    const double difference = a.sum_rad_[i] / a.count_[i] - b.sum_rad_[i] / b.count_[i];
    squares += difference * difference;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : kNotMeasured;
}

std::vector<double> WalkCurves::curve(std::size_t step, std::size_t joint) const {
  std::vector<double> values;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const std::size_t i = index(step, bin, joint);
    values.push_back(count_[i] > 0.0 ? sum_rad_[i] / count_[i] : kNotMeasured);
  }
  return values;
}

void ConfigurationResult::add(double imitation, double sim_to_real) {
  if (!std::isfinite(imitation) || !std::isfinite(sim_to_real)) {
    ++robots_without_errors;
    return;
  }
  imitation_of_plant_rad.push_back(imitation);
  sim_to_real_of_plant_rad.push_back(sim_to_real);
  imitation_rad = mean_interval(imitation_of_plant_rad);
  sim_to_real_rad = mean_interval(sim_to_real_of_plant_rad);
}

double Table2::ratio() const {
  return results[kFullCalibration].sim_to_real_rad.mean / results[kBaseline].sim_to_real_rad.mean;
}

ZeroPoints zero_points(const std::vector<CalibratedPlant>& plants) {
  ZeroPoints all;
  for (const CalibratedPlant& plant : plants) {
    const auto well = static_cast<std::size_t>(std::ranges::count_if(plant.offsets, &FoundOffset::well));
    all.well += well;
    all.roughly += plant.offsets.size() - well;
    all.untold += plant.truth.size() - std::min(plant.truth.size(), plant.offsets.size());
    all.worst_left_rad = std::max(all.worst_left_rad, plant.worst_offset_rad);
  }
  return all;
}

work::Worth worth_of(const Table2& table) {
  if (!table.complete) return {work::Grade::kInterrupted, "nothing can be compared"};
  work::Worth worth;
  const ConfigurationResult& full = table.results[kFullCalibration];
  worth.add_if(table.ratio() > kAskedRatio, work::Grade::kMissed,
               fmt::format("full calibration leaves {:.2f} of the baseline's sim-to-real error, more than {:.2f}",
                           table.ratio(), kAskedRatio));
  for (std::size_t c = 0; c < kConfigurations; ++c) {
    const ConfigurationResult& one = table.results[c];
    const std::string configuration = kConfigurationNames[c];
    if (c != kFullCalibration && full.measured() && one.measured()) {
      worth.add_if(full.imitation_rad.mean >= one.imitation_rad.mean, work::Grade::kMissed,
                   "full calibration imitates no better than " + configuration);
      worth.add_if(full.sim_to_real_rad.mean >= one.sim_to_real_rad.mean, work::Grade::kMissed,
                   "full calibration's sim-to-real error is no smaller than that of " + configuration);
    }
    if (!one.measured()) {
      worth.add(work::Grade::kPartial,
                configuration + " was not measured: no robot and its simulation walked one step both");
      continue;
    }
    const bool in_ratio = c == kBaseline || c == kFullCalibration;
    worth.add_if(one.robots_without_errors > 0 || one.fell_on_the_way() || one.simulation_falls > 0,
                 work::Grade::kPartial,
                 configuration + " was measured on " + falls_text(one) +
                     (in_ratio ? "" : "; the ratio below doesn't depend on it"));
  }
  return worth;
}

bool Table2::all_reached() const { return complete && worth_of(*this).grade() == work::Grade::kHolds; }

std::array<double, 2> published(Configuration configuration) {
  constexpr std::array<std::array<double, 2>, kConfigurations> kPaper = {
      {{0.0571, 0.0781}, {0.0747, 0.0656}, {0.0682, 0.0562}, {0.0562, 0.0414}}};
  return kPaper[configuration];
}

void run_table2(Table2& table, const std::filesystem::path& folder, const Supervision& supervision) {
  const Candidate candidate{table.policy, {.robot = table.robot, .clips = {}, .policy = table.policy}};
  const control::LoadedControl loaded = control::load_control(candidate.control);
  const model::RobotModel& robot = loaded.robot;
  const Gains gains = gains_of(loaded), informed = informed_gains(robot, gains);
  for (const int joint : policy_joints(robot)) table.joints.push_back(robot.joint_index.name(joint));
  calibrate(table, robot, gains, folder, supervision);
  if (!table.complete) return;

  const std::size_t plants = table.plants.size(), seeds = static_cast<std::size_t>(table.simulation_seeds);
  Walks walks{.as_it_is = std::vector<Walk>(plants),
              .informed = std::vector<Walk>(plants),
              .corrected = std::vector<Walk>(plants),
              .nominal = std::vector<Walk>(seeds),
              .informed_nominal = std::vector<Walk>(seeds),
              .fitted = std::vector<std::vector<Walk>>(plants, std::vector<Walk>(seeds))};
  std::vector<Errand> errands;
  for (std::size_t s = 0; s < seeds; ++s) {
    errands.push_back({&walks.nominal[s], {}, s + 1});
    // A joint with scaled gains only keeps the model's rotor and friction.
    errands.push_back({&walks.informed_nominal[s], told({}, robot, gains, informed), s + 1});
  }
  for (std::size_t k = 0; k < plants; ++k) {
    const CalibratedPlant& plant = table.plants[k];
    const std::uint64_t seed = 100 + k;
    errands.push_back({&walks.as_it_is[k], plant.truth, seed});
    errands.push_back({&walks.informed[k], told(plant.truth, robot, gains, informed), seed});
    errands.push_back({&walks.corrected[k], corrected(plant.truth, plant.offsets), seed});
    for (std::size_t s = 0; s < seeds; ++s) errands.push_back({&walks.fitted[k][s], plant.motors, s + 1});
  }
  for_each_piece(errands.size(), supervision, [&](std::size_t e) {
    sim::WorldOptions world = sil::world_with_noise(errands[e].seed, false);
    world.motors = errands[e].motors;
    const TrialResult trial = run_trial(candidate, table.scenario, world,
                                        {.gantry = false,
                                         .progress = supervision.progress,
                                         .observer = WalkObserver(*errands[e].walk, robot, table.scenario)});
    errands[e].walk->complete = trial.complete;
    errands[e].walk->fell = trial.fell;
  });
  table.complete = !supervision.interrupted_now();
  if (table.complete) summarise(table, walks);
}

}  // namespace pmg::evaluation
