#include "evaluation/table2_plant.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

#include "calib/motor_fit.hpp"
#include "files/config_reader.hpp"
#include "io/clock.hpp"
#include "io/log_writer.hpp"
#include "model/hanging_load.hpp"
#include "sil/lockstep.hpp"
#include "sil/sil_hal.hpp"
#include "sil/simulated_robot.hpp"
#include "sim/sensor_noise.hpp"
#include "zero/zero_calibration.hpp"
#include "zero/zero_stances.hpp"

namespace pmg::evaluation {

namespace {

constexpr double kRate_Hz = 100.0;
constexpr int kBenchSamples = 500;  // a recording of five seconds
constexpr int kBenchRuns = 4;
constexpr double kAmplitude_rad = 0.3;
constexpr double kWeight_kg = 4.0, kArm_m = 0.3;  // on the joint, in half of the runs

sim::Range range(files::ConfigReader& reader, const std::string& key) {
  const std::vector<double> ends = reader.numbers(key, 2, files::non_negative());
  if (ends[0] > ends[1]) reader.fail(key, "runs backwards", "[lower, upper]");
  return {ends[0], ends[1]};
}

/// Uniform. std::uniform_real_distribution may differ between standard libraries; the engine may not.
double draw(const sim::Range& range, std::mt19937_64& random) {
  return range.lower + (range.upper - range.lower) * static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Steps and smooth segments about 0 (paper III-C.1), different for each number, with pauses in which a joint comes to
/// rest.
bench::Recording excitation(int number) {
  bench::Recording recording;
  for (int k = 0; k < kBenchSamples; ++k) {
    const double t_s = static_cast<double>(k) / kRate_Hz, pace = 1.0 + 0.5 * number;
    const double smooth = 0.7 * std::sin(2.0 * pace * t_s) + 0.3 * std::sin(9.0 * t_s + number);
    const double step = t_s < 3.0 ? 0.8 : t_s < 3.8 ? -0.6 : 0.2;
    recording.t_s.push_back(t_s);
    recording.q_cmd_rad.push_back(t_s < 0.1 ? 0.0 : kAmplitude_rad * (t_s < 2.2 ? smooth : step));
    recording.q_rad.push_back(0.0);
    recording.valid.push_back(true);
  }
  return recording;
}

/// Plays the stances; false if interrupted.
bool take_stances(const sim::ActuatorsByJoint& plant, const std::filesystem::path& folder, std::uint64_t seed,
                  const work::Progress& progress) {
  control::LoadedControl loaded =
      control::load_control({.robot = (folder / "stances").string(), .clips = {}, .policy = "none"});
  const sil::Scenario scenario = sil::load_scenario(folder / "stances/scenario.yaml");
  sim::WorldOptions options = sil::world_with_noise(seed, false);
  options.motors = plant;
  sim::World world(loaded.robot, options);
  const io::WallClock stopwatch;
  const std::unique_ptr<control::Tick> tick = control::make_tick(loaded, stopwatch);
  sil::SilHal bus(world);
  sil::WorldPlant truth(world);
  io::LogWriter file(folder / "log.lcm");
  recording::TickLog log(file, loaded.robot, {.robot = loaded.robot.name}, kRate_Hz);
  sil::Lockstep lockstep(loaded.robot, bus, truth, *tick, scenario, &log, {.balanced_by_policy = false});
  lockstep.interrupted = [&progress] { return progress.interrupted_now(); };
  const bool interrupted = lockstep.run().interrupted;
  file.flush();
  return !interrupted;
}

}  // namespace

PlantRanges load_plant_ranges(const std::filesystem::path& file) {
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  PlantRanges ranges;
  ranges.plants = reader.required<int>("plants", files::positive());
  ranges.seed = reader.required<int>("seed", files::non_negative());
  ranges.coulomb_Nm = range(reader, "coulomb_Nm");
  ranges.viscous_Nm_s_per_rad = range(reader, "viscous_Nm_s_per_rad");
  ranges.armature_factor = range(reader, "armature_factor");
  ranges.kp_factor = range(reader, "kp_factor");
  ranges.kd_factor = range(reader, "kd_factor");
  ranges.delay_s = range(reader, "delay_s");
  ranges.zero_offset_rad = range(reader, "zero_offset_rad");
  ranges.backlash_rad = range(reader, "backlash_rad");
  ranges.stiffness_Nm_per_rad = range(reader, "stiffness_Nm_per_rad");
  ranges.load_friction = range(reader, "load_friction");
  reader.finish();
  return ranges;
}

// A seed's meaning includes the order of the draws.
sim::ActuatorsByJoint draw_plant(const PlantRanges& ranges, const model::RobotModel& robot, int number) {
  std::mt19937_64 random(static_cast<std::uint64_t>(ranges.seed) + 1000 * static_cast<std::uint64_t>(number));
  const double delay_s = draw(ranges.delay_s, random);
  sim::ActuatorsByJoint plant;
  for (const model::Joint& joint : robot.joints) {
    if (!joint.policy) continue;
    model::ActuatorParameters& p = plant[joint.name];
    p.command.delay_s = delay_s;
    p.drive.kp_scale = draw(ranges.kp_factor, random);
    p.drive.kd_scale = draw(ranges.kd_factor, random);
    p.transmission.armature_kg_m2 = joint.armature_kg_m2 * draw(ranges.armature_factor, random);
    p.transmission.backlash_rad = draw(ranges.backlash_rad, random);
    p.transmission.stiffness_Nm_per_rad = draw(ranges.stiffness_Nm_per_rad, random);
    // A tenth of the critical damping of rotor and shaft, an assumption for steel with bearings and grease.
    p.transmission.damping_Nm_s_per_rad =
        0.2 * std::sqrt(p.transmission.stiffness_Nm_per_rad * p.transmission.armature_kg_m2);
    p.friction.coulomb_Nm = draw(ranges.coulomb_Nm, random);
    p.friction.viscous_Nm_s_per_rad = draw(ranges.viscous_Nm_s_per_rad, random);
    p.friction.load_driving = p.friction.load_backdriving = draw(ranges.load_friction, random);
    p.sensor.zero_offset_rad = draw(ranges.zero_offset_rad, random) * (random() >> 63 == 0 ? 1.0 : -1.0);
  }
  return plant;
}

std::vector<calib::SingleJoint> record_joint(const bench::Bench& bench, const model::RobotModel& robot,
                                             const std::string& joint, const model::ActuatorParameters& truth,
                                             const Gains& gains, unsigned seed) {
  const int index = robot.joint_index.at(joint);
  const double kp = gains.kp_Nm_per_rad[index], kd = gains.kd_Nm_s_per_rad[index];
  const model::HangingLoad load = model::hanging_load(robot, joint);
  sim::NormalSource noise(seed + 17U * static_cast<unsigned>(index));
  calib::JointModel plant;
  plant.actuator = truth;
  // A position drive's zero does not show on its own encoder. The hanging limb would show it, but the paper fits only
  // the response.
  plant.actuator.sensor.zero_offset_rad = 0.0;
  std::vector<calib::SingleJoint> runs;
  for (int number = 0; number < kBenchRuns; ++number) {
    bench::BenchRun run;
    run.file = fmt::format("run{}.csv", number);
    run.kp = kp * (number % 2 == 0 ? 1.0 : 0.5);
    run.kd = kd * (number < 2 ? 1.0 : 0.5);  // with a single kd it can't be told from viscous friction
    // A known weight in two of the runs. If a limb is lighter than its rotor, gain, rotor and friction could otherwise
    // all be larger by one factor.
    const bool weighted = number == 1 || number == 2;
    run.load.inertia_kg_m2 = load.inertia_kg_m2 + (weighted ? kWeight_kg * kArm_m * kArm_m : 0.0);
    run.load.gravity_Nm = load.gravity_Nm + (weighted ? kGravity_m_s2 * kWeight_kg * kArm_m : 0.0);
    run.recording = excitation(number);
    run.recording.q_rad = calib::SingleJoint(bench, run, calib::simulation_step_s(bench)).rollout(plant);
    for (double& q_rad : run.recording.q_rad) q_rad += sil::kEncoderNoise_rad * noise.next();
    runs.emplace_back(bench, run, calib::simulation_step_s(bench));
  }
  return runs;
}

sim::ActuatorsByJoint calibrated_motors(const sim::ActuatorsByJoint& plant, const model::RobotModel& robot,
                                        const Gains& gains, unsigned seed) {
  bench::Bench bench;
  bench.rig = bench::Rig::kPendulum;
  bench.law = bench::DriveLaw::kPositionPd;
  calib::FitOptions options;
  options.starts = 2;
  options.screened_per_dimension = 8;
  options.seed = seed;
  sim::ActuatorsByJoint found;
  for (const auto& [name, truth] : plant) {
    const int joint = robot.joint_index.at(name);
    calib::Unknowns unknowns;
    for (const char* parameter : {"drive.kp_scale", "drive.kd_scale", "transmission.armature_kg_m2",
                                  "friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "command.delay_s"}) {
      unknowns.push_back(calib::unknown(parameter, bench));
    }
    calib::JointModel start;
    start.actuator.transmission.armature_kg_m2 = robot.joints[static_cast<std::size_t>(joint)].armature_kg_m2;
    const calib::FitProblem problem(unknowns, start, record_joint(bench, robot, name, truth, gains, seed));
    found[name] = calib::fit(problem, options).model.actuator;
  }
  return found;
}

std::vector<FoundOffset> calibrated_offsets(const sim::ActuatorsByJoint& plant, const model::RobotModel& robot,
                                            const std::filesystem::path& folder, std::uint64_t seed,
                                            const work::Progress& progress) {
  zero::write_zero_rig(robot, folder / "stances");
  if (!take_stances(plant, folder, seed, progress)) return {};
  const zero::ZeroCalibration found = zero::calibrate_zero(robot, zero::read_still_poses({folder / "log.lcm"}, robot));
  std::vector<FoundOffset> offsets;
  for (std::size_t i = 0; i < found.joints.size(); ++i) {
    if (found.known[i] != zero::Known::kNo)
      offsets.push_back({robot.joint_index.name(found.joints[i]), -found.z_rad[static_cast<Eigen::Index>(i)],
                         found.known[i] == zero::Known::kWell});
  }
  return offsets;
}

}  // namespace pmg::evaluation
