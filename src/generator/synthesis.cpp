#include "generator/synthesis.hpp"

#include <cmath>
#include <numbers>

#include "generator/gait_measure.hpp"
#include "generator/gait_reference.hpp"
#include "generator/static_clips.hpp"
#include "generator/upper_body.hpp"

namespace pmg::generator {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct Making {
  const model::RobotModel& robot;
  JointRoles roles;
  RobotLegs legs;
  std::array<StaticClip, 3> posture;  // pitch, roll, height
};

Addition posture_addition(const Making& making, Channel channel, double command) {
  Addition addition;
  const StaticClip& clip = making.posture[channel - kPitch];
  addition.q = {leg_offset(clip, making.roles, making.legs, command)};
  if (channel == kPitch) {
    // The optimisation sees a level base; the pelvis' part of the pitch is undone by the hips, the chain's first
    // joints.
    const double pelvis_pitch = kPelvisShareOfPitch * command;
    for (const Foot foot : {kLeft, kRight}) {
      addition.q[0][foot][kHipPitch] += pelvis_pitch;
    }
  }
  addition.height_m = channel == kHeight ? command : 0.0;
  return addition;
}

/// A finished clip as a part of a mixture.
Addition clip_addition(const Making& making, const LegTrajectory& legs, const GaitTask& task, double gain,
                       double period_s) {
  Addition addition;
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    LegPose q;
    LegPose dq;
    for (const Foot foot : {kLeft, kRight}) {
      q[foot] = gain * (legs.q[k][foot] - making.legs.stand[foot]);
      dq[foot] = gain * legs.dq_dphi[k][foot];
    }
    addition.q.push_back(q);
    addition.dq_dphi.push_back(dq);
    const Roll roll = hike(task, static_cast<double>(k) / static_cast<double>(kClipSamples));
    addition.roll.push_back({gain * roll.angle_rad, gain * roll.slope_rad});
  }
  addition.velocity = gain * task.velocity * (task.period_s / period_s);
  addition.height_m = gain * task.height_m;
  return addition;
}

/// posture_weight: of walking in a posture against plain walking.
std::vector<Scenario> scenarios(const Making& making, double posture_weight) {
  std::vector<Scenario> list;
  for (const double gain : {0.12, 0.3, 0.55, 0.8, 1.0}) {
    list.push_back({gain, 1.0, {}});
  }
  list.push_back({0.3, posture_weight, posture_addition(making, kHeight, -0.09)});
  list.push_back({0.6, posture_weight, posture_addition(making, kHeight, -0.09)});
  list.push_back({0.5, posture_weight, posture_addition(making, kRoll, 0.12)});
  return list;
}

GaitTask forward_task(const Making& making) {
  GaitTask task;
  task.period_s = 1.10;
  task.duty_factor = 0.62;
  task.velocity = {0.8, 0.0, 0.0};
  task.sway_m = 0.015;
  task.clearance_m = 0.026;
  task.foot_gap_m = 0.045;
  task.flat_from = 0.2;
  task.flat_to = 0.62;
  // Published feet bend at the toes and rise by 50 degrees before they leave the ground. A rigid one pivots over its
  // toe edge; that at half amplitude it shall neither leave the other foot in the air nor scrape the ground limits by
  // how much. The pelvis lifts the swinging side, and the ankle moves about a mean a few degrees above the published
  // one: its movement counts, not its offset.
  task.hike_rad = 0.14;
  task.reference = published_reference(making.legs);
  task.shape = {
      {kHipPitch, 0.956, 5.5 * kDegree}, {kKnee, 0.953, 5.4 * kDegree}, {kAnklePitch, 0.98, 4.8 * kDegree, 0.85}};
  task.weights.reference << 0.5, 6.0, 6.0, 0.5, 0.5, 2.0;
  task.weights.bias << 1.0, 6.0, 6.0, 1.0, 0.1, 6.0;
  task.weights.slip = 12.0;
  task.weights.step_height = 1200.0;
  task.weights.step_height_free_m = 0.007;
  task.weights.velocity = 12.0;
  task.weights.foot_flat = 8.0;
  task.weights.clearance = 200.0;
  task.weights.above_ground = 1800.0;
  task.weights.correlation = 300.0;
  task.weights.rms = 200.0;
  task.weights.amplitude = 60.0;
  task.weights.height = 60.0;
  task.weights.velocity_yaw = 4.0;
  task.weights.limit = 300.0;
  task.weights.smooth = 1.2e-3;
  task.scenarios = scenarios(making, 0.36);
  task.scenarios.push_back({0.5, 1.0, posture_addition(making, kHeight, -0.03)});
  // Walking people stand higher on straighter legs than the robot does; asked for its standing height it walks so.
  task.scenarios.push_back({1.0, 0.6, posture_addition(making, kHeight, -0.012)});
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

// Timing: the four sidesteps of CMU subject 69 (mocap.cs.cmu.edu): 1.00 .. 1.03 s a cycle, 53 .. 65 % stance.
GaitTask lateral_task(const Making& making) {
  GaitTask task;
  task.period_s = 1.02;
  task.duty_factor = 0.61;  // with walking's windows: mixtures of the two then agree about the ground
  task.velocity = {0.0, 0.35, 0.0};
  task.symmetric = false;
  task.clearance_m = 0.045;
  task.foot_gap_m = 0.035;
  task.weights.reference = LegVector<double>::Constant(1.5);
  task.weights.step_height = 1200.0;
  task.weights.step_height_free_m = 0.004;
  task.weights.velocity = 12.0;
  task.weights.height = 60.0;
  task.weights.velocity_yaw = 6.0;
  task.scenarios = scenarios(making, 0.6);
  task.scenarios.push_back({0.5, 0.5, posture_addition(making, kRoll, -0.12)});
  // Feet 0.31 m apart on average: the closing foot then keeps clear of the other.
  task.reference = stepping_reference(making.legs, task, {.half_width_m = 0.155, .lift_m = 0.05, .height_m = -0.02});
  return task;
}

// Timing: steady turning in circle walks of CMU subject 69 (1.17 .. 1.20 s, 58 .. 60 % stance). The same subject's
// turns in place are quarter turns that stop in between, 84 % stance: such windows can't be blended with walking.
GaitTask turn_task(const Making& making) {
  GaitTask task;
  task.period_s = 1.18;
  task.duty_factor = 0.61;  // as in lateral_task
  task.velocity = {0.0, 0.0, 0.8};
  task.symmetric = false;
  task.sway_m = 0.012;
  task.clearance_m = 0.045;
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
                                      {.half_width_m = 0.115, .toe_out_rad = 0.08, .lift_m = 0.05, .height_m = 0.0});
  return task;
}

DynamicClip assemble(const Making& making, const GaitTask& task, const LegTrajectory& legs, UpperBody body) {
  body.pelvis_roll_rad = [&task](double phase) { return hike(task, phase).angle_rad; };
  DynamicClip clip;
  clip.period_s = task.period_s;
  const GaitTiming when = timing(task.period_s, task.duty_factor);
  clip.contact_center = when.contact_center;
  clip.duty_factor = when.duty_factor;
  const JointVector q_stand = making.robot.q_stand();
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const double phase = static_cast<double>(k) / static_cast<double>(kClipSamples);
    JointVector q = q_stand;
    JointVector dq = JointVector::Zero(q_stand.size());
    move_upper_body(making.roles, body, phase, q);
    constexpr double kStep = 1e-5;  // cycles; the upper body's curves are smooth
    JointVector before = q_stand;
    JointVector after = q_stand;
    move_upper_body(making.roles, body, phase - kStep, before);
    move_upper_body(making.roles, body, phase + kStep, after);
    dq = (after - before) / (2.0 * kStep);
    for (const Foot foot : {kLeft, kRight}) {
      for (std::size_t role = 0; role < kLegJoints; ++role) {
        const auto i = static_cast<Eigen::Index>(role);
        const int joint = making.roles.leg[foot][role];
        q[joint] += legs.q[k][foot][i] - making.legs.stand[foot][i];
        dq[joint] += legs.dq_dphi[k][foot][i];
      }
    }
    clip.q.push_back(q);
    clip.dq_dphi.push_back(dq);
  }
  const Eigen::Vector3d mean = measure(making.legs, legs, when, hiking_base(task, 1.0)).mean_velocity;
  clip.mean_velocity = {mean.x(), mean.y(), mean.z()};
  return clip;
}

}  // namespace

ClipLibrary synthesize(const model::RobotModel& robot, const std::function<void(const std::string&)>& progress) {
  const JointRoles roles = find_joint_roles(robot);
  Making making{robot, roles, robot_legs(robot, roles), {}};
  ClipLibrary library;
  library.q_stand = robot.q_stand();
  library.q_lower = robot.q_lower();
  library.q_upper = robot.q_upper();
  library.mirror = robot.mirror;

  progress("bend");
  making.posture[0] = make_bend(robot, roles, making.legs);
  progress("lean");
  making.posture[1] = make_lean(robot, roles, making.legs);
  progress("squat");
  making.posture[2] = make_squat(robot, roles, making.legs);
  library.posture = making.posture;

  const auto during = [&progress](const char* clip) { return [&progress, clip] { progress(clip); }; };
  const GaitTask forward = forward_task(making);
  const LegTrajectory forward_legs = optimize_gait(making.legs, forward, during("forward")).legs;
  library.positive[kVx] =
      assemble(making, forward, forward_legs,
               {.pelvis_tilt_rad = 8.0 * kDegree, .arm_swing = 0.8, .torso_yaw_rad = 3.5 * kDegree});

  const GaitTask backward = backward_task(making, forward_legs, forward);
  const LegTrajectory backward_legs = optimize_gait(making.legs, backward, during("backward")).legs;
  library.negative[kVx] =
      assemble(making, backward, backward_legs,
               {.pelvis_tilt_rad = 3.0 * kDegree, .arm_swing = 0.4, .torso_yaw_rad = 2.0 * kDegree});

  GaitTask lateral = lateral_task(making);
  lateral.scenarios.push_back({0.53, 3.0, clip_addition(making, forward_legs, forward, 0.47, lateral.period_s)});
  const LegTrajectory lateral_legs = optimize_gait(making.legs, lateral, during("lateral")).legs;
  library.positive[kVy] = assemble(making, lateral, lateral_legs, {.pelvis_tilt_rad = 2.0 * kDegree});

  GaitTask turn = turn_task(making);
  turn.scenarios.push_back({0.45, 4.0, clip_addition(making, forward_legs, forward, 0.55, turn.period_s)});
  const LegTrajectory turn_legs = optimize_gait(making.legs, turn, during("turn")).legs;
  library.positive[kOmega] =
      assemble(making, turn, turn_legs, {.pelvis_tilt_rad = 2.0 * kDegree, .arm_swing = 0.25, .gaze_yaw_rad = 0.12});
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
  return "synthesised: feet in place, centre of mass over them";
}

}  // namespace pmg::generator
