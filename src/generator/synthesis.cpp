#include "generator/synthesis.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <mutex>
#include <utility>

#include "generator/corner_synthesis.hpp"
#include "generator/gait_parts.hpp"
#include "generator/gait_reference.hpp"
#include "generator/static_clips.hpp"
#include "work/parallel.hpp"

namespace pmg::generator {
namespace {

GaitTask forward_task(const Making& making) {
  GaitTask task;
  task.period_s = 1.05;
  task.duty_factor = 0.62;
  task.velocity = {0.845, 0.0, 0.0};  // ends at 0.81: flat soles pull it down
  task.sway_m = 0.015;
  task.clearance_m = 0.026;
  // The foot keeps 15 mm until 15 % of the swing are left: a robot's leg sags, and a foot that is low for long lands
  // early. Its whole cycle then shifts against the published one.
  task.landing = 1.2;
  task.foot_gap_m = 0.055;
  task.flat_from = 0.15;
  task.flat_to = 0.62;
  // Published feet bend at the toes and rise by 50 degrees before they leave the ground. A rigid foot pivots over its
  // toe edge. This pivoting is limited, because at half amplitude it lifts the other foot or scrapes the ground.
  // Instead the pelvis lifts the swinging side.
  task.hike_rad = 0.145;
  // Walking people are lower than standing people: their legs spread.
  task.height_m = -0.022;
  task.reference = published_reference(making.legs);
  task.shape = {{kHipPitch, 0.960, 5.4 * kRadPerDegree},
                {kKnee, 0.967, 5.2 * kRadPerDegree},
                {kAnklePitch, 0.962, 5.5 * kRadPerDegree, 0.86}};
  task.weights.reference << 0.5, 40.0, 60.0, 0.5, 0.5, 2.0;
  task.weights.bias << 1.0, 6.0, 20.0, 1.0, 1.0, 6.0;
  task.weights.slip = 75.0;
  task.weights.step_height = 3600.0;
  task.weights.step_height_free_m = 0.005;
  task.weights.velocity = 25.0;
  task.weights.velocity_up = 4.0;  // high steps of the base would fall faster than a body can
  task.weights.foot_flat = 14.0;
  task.weights.sole = 150.0;
  task.sole_free_rad = 5.0 * kRadPerDegree;
  task.weights.clearance = 300.0;
  task.weights.above_ground = 5000.0;
  task.weights.correlation = 300.0;
  task.weights.rms = 300.0;
  task.weights.amplitude = 80.0;
  task.weights.height = 60.0;
  task.weights.velocity_yaw = 4.0;
  task.weights.limit = 1500.0;
  task.weights.smooth = 6e-3;
  task.scenarios = scenarios(making, 0.36);
  for (Scenario& scenario : task.scenarios) {  // small steps drag the toes most
    if (scenario.gain < 0.35 && scenario.addition.q.empty()) scenario.weight *= 2.0;
  }
  task.later_iterations = 40;
  task.scenarios.push_back({0.5, 1.0, posture_addition(making, kHeight, -0.03)});
  return task;
}

GaitTask backward_task(const Making& making, const LegTrajectory& forward, const GaitTask& forward_task) {
  GaitTask task;
  task.period_s = 1.17;
  task.duty_factor = 0.58;
  task.velocity = {-0.5, 0.0, 0.0};
  task.sway_m = 0.015;
  task.clearance_m = 0.045;
  task.foot_gap_m = 0.045;
  task.height_m = -0.006;
  task.flat_from = 0.3;
  task.flat_to = 0.85;
  const double scale = (0.5 * task.period_s) / (0.8 * forward_task.period_s);
  task.reference = reversed_reference(making.legs, forward, forward_task.duty_factor, scale);
  task.weights.reference << 2.0, 1.5, 1.5, 2.0, 2.0, 0.5;
  task.weights.velocity = 12.0;
  task.weights.height = 30.0;
  task.weights.velocity_yaw = 6.0;
  task.scenarios = scenarios(making, 0.5);
  return task;
}

// Timing of the four sidesteps of CMU subject 69 (mocap.cs.cmu.edu): 1.00 to 1.03 s per cycle, 53 to 65 % stance.
GaitTask lateral_task(const Making& making) {
  GaitTask task;
  task.period_s = 1.02;
  task.duty_factor = 0.61;  // same windows as walking, so mixtures of the two agree on contact
  task.velocity = {0.0, 0.35, 0.0};
  task.symmetric = false;
  task.clearance_m = 0.045;
  task.height_m = -0.010;
  task.foot_gap_m = 0.035;
  task.weights.reference = LegVector<double>::Constant(1.5);
  task.weights.step_height = 1200.0;
  task.weights.step_height_free_m = 0.004;
  task.weights.velocity = 12.0;
  task.weights.height = 60.0;
  task.weights.velocity_yaw = 6.0;
  task.scenarios = scenarios(making, 0.6);
  task.scenarios.push_back({0.5, 0.5, posture_addition(making, kRoll, -0.12)});
  // Feet 0.31 m apart on average, so the closing foot stays clear of the other.
  task.reference = stepping_reference(making.legs, task, {.half_width_m = 0.155, .lift_m = 0.05, .height_m = -0.03});
  return task;
}

// Timing of steady turning in circle walks of CMU subject 69 (1.17 to 1.20 s, 58 to 60 % stance). The subject's turns
// in place are quarter turns with stops, 84 % stance; such windows can't be blended with walking.
GaitTask turn_task(const Making& making) {
  GaitTask task;
  task.period_s = 1.18;
  task.duty_factor = 0.61;  // as in lateral_task
  task.velocity = {0.0, 0.0, 0.8};
  task.symmetric = false;
  task.sway_m = 0.012;
  task.clearance_m = 0.045;
  task.height_m = -0.008;
  task.foot_gap_m = 0.03;
  task.weights.reference = LegVector<double>::Constant(1.5);
  task.weights.step_height = 1200.0;
  task.weights.step_height_free_m = 0.003;
  task.weights.velocity = 12.0;
  task.weights.height = 30.0;
  task.weights.velocity_yaw = 6.0;
  task.scenarios = scenarios(making, 0.6);
  task.scenarios.push_back({0.6, 8.0, posture_addition(making, kHeight, -0.05)});
  task.scenarios.push_back({0.5, 0.5, posture_addition(making, kRoll, -0.12)});
  task.reference = stepping_reference(making.legs, task,
                                      {.half_width_m = 0.115, .toe_out_rad = 0.08, .lift_m = 0.05, .height_m = -0.012});
  return task;
}

}  // namespace

ClipLibrary synthesize(const model::RobotModel& robot, bool with_corners, const work::Progress& progress) {
  const JointRoles roles = find_joint_roles(robot);
  Making making{robot, roles, robot_legs(robot, roles), {}};
  ClipLibrary library;
  library.q_stand = robot.q_stand();
  library.q_lower = robot.q_lower();
  library.q_upper = robot.q_upper();
  library.mirror = robot.mirror;

  progress.report_or_throw(work::kUnknownShare, "making bend");
  making.posture[0] = make_bend(robot, roles, making.legs);
  progress.report_or_throw(work::kUnknownShare, "making lean");
  making.posture[1] = make_lean(robot, roles, making.legs);
  progress.report_or_throw(work::kUnknownShare, "making squat");
  making.posture[2] = make_squat(robot, roles, making.legs);
  library.posture = making.posture;

  std::mutex one_at_a_time;  // several clips are made at the same time
  const work::Progress locked{.report =
                                  [&](double share, std::string_view name) {
                                    const std::lock_guard lock(one_at_a_time);
                                    if (progress.report) progress.report(share, name);
                                  },
                              .interrupted = progress.interrupted};
  const auto during = [&locked](const char* name) {
    return work::Progress{
        .report = [&locked, name](double share,
                                  std::string_view) { locked.report(share, "making " + std::string(name)); },
        .interrupted = locked.interrupted};
  };
  const auto make = [&](const char* name, const GaitTask& task, UpperBody body) {
    return MadeGait{task, optimize_gait(making.legs, task, during(name)).legs, std::move(body)};
  };
  const auto clip = [&making](const MadeGait& gait) { return assemble(making, gait.task, gait.legs, gait.body); };

  const MadeGait forward =
      make("forward", forward_task(making),
           {.pelvis_tilt_rad = 8.0 * kRadPerDegree, .arm_swing = 0.8, .torso_yaw_rad = 3.5 * kRadPerDegree});
  library.positive[kVx] = clip(forward);

  GaitTask lateral_wanted = lateral_task(making), turn_wanted = turn_task(making);
  lateral_wanted.scenarios.push_back(
      {0.53, 3.0, clip_addition(making, forward.legs, forward.task, 0.47, lateral_wanted.period_s)});
  turn_wanted.scenarios.push_back(
      {0.45, 4.0, clip_addition(making, forward.legs, forward.task, 0.55, turn_wanted.period_s)});
  MadeGait backward, lateral, turn;
  const std::array<std::function<void()>, 3> makings = {
      [&] {
        backward =
            make("backward", backward_task(making, forward.legs, forward.task),
                 {.pelvis_tilt_rad = 3.0 * kRadPerDegree, .arm_swing = 0.4, .torso_yaw_rad = 2.0 * kRadPerDegree});
      },
      [&] { lateral = make("lateral", lateral_wanted, {.pelvis_tilt_rad = 2.0 * kRadPerDegree}); },
      [&] {
        turn = make("turn", turn_wanted,
                    {.pelvis_tilt_rad = 2.0 * kRadPerDegree, .arm_swing = 0.25, .gaze_yaw_rad = 0.12});
      }};
  work::for_each_in_parallel(makings.size(), static_cast<unsigned>(makings.size()),
                             [&](std::size_t i) { makings[i](); });
  library.negative[kVx] = clip(backward);
  library.positive[kVy] = clip(lateral);
  library.positive[kOmega] = clip(turn);

  if (with_corners) library.corners = make_corners(making, library, {forward, backward, lateral, turn}, locked);
  return library;
}

std::string clip_source(const std::string& name) {
  if (name == "forward") {
    return "synthesised from published adult gait (Leboeuf et al., Gait & Posture 69, 2019)";
  }
  if (name == "backward") {
    return "synthesised: forward walking with time reversed (Thorstensson 1986; Winter, Pluck, Yang 1989)";
  }
  if (name == "lateral" || name == "turn") {
    return "synthesised: flat-footed stepping; timing of CMU mocap subject 69 (mocap.cs.cmu.edu)";
  }
  if (name.find('_') != std::string::npos) {
    return "synthesised: the single clips' sum, feet lifted once, fitted to the ground over the mixtures of both";
  }
  return "synthesised: feet in place, centre of mass over them";
}

}  // namespace pmg::generator
