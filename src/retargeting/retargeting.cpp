#include "retargeting/retargeting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <tuple>
#include <utility>

#include "generator/gait_optimization.hpp"
#include "pmg/periodic_slopes.hpp"
#include "retargeting/arm_imitation.hpp"
#include "retargeting/leg_imitation.hpp"
#include "retargeting/upper_body_imitation.hpp"

namespace pmg::retargeting {
namespace {
using generator::GaitTask;
using generator::kClipSamples;
using generator::LegTrajectory;

/// Of a clip with a posture; alone and in mixtures it has 1 at each gain.
constexpr double kPostureWeight = 0.2;

/// Gains of a clip and of another one in mixtures that half-gain clips are made for; their sum is 1 at most
/// (Blend::kGain).
constexpr std::array<std::pair<double, double>, 4> kPairs = {{{0.3, 0.7}, {0.5, 0.5}, {0.7, 0.3}, {0.3, 0.3}}};

/// Five times the synthesis' weight: a person's curves turn where clearance begins to be asked, and a drive must
/// follow.
constexpr double kSmooth = 1e-3;

/// Kept free at each limit: the generator keeps 2 degrees after it has added a posture.
constexpr double kLimitMargin_rad = 4.0 * kRadPerDegree;

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Slopes by central differences, for measures of the curves before the optimisation.
LegTrajectory with_slopes(const std::vector<generator::LegPose>& q) {
  LegTrajectory legs{q, q};
  const std::size_t n = q.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (const Foot foot : {kLeft, kRight})
      legs.dq_dphi[k][foot] = 0.5 * static_cast<double>(n) * (q[(k + 1) % n][foot] - q[(k + n - 1) % n][foot]);
  }
  return legs;
}

GaitTask retargeting_task(const generator::Making& making, const RetargetedClip& made) {
  const HumanCycle& human = made.human;
  GaitTask task;
  task.period_s = human.period_s * made.froude_ratio;
  task.duty_factor = human.duty_factor;
  task.velocity = made.wanted_velocity;
  task.symmetric = false;  // people aren't
  task.sway_m = human.sway_m * made.length_ratio;
  task.hike_rad = human.hike_rad;
  task.flat_from = human.flat_from;
  task.flat_to = human.flat_to;
  task.reference = imitate_legs(making.legs, human.pose, kLimitMargin_rad);
  const GaitTiming when = generator::timing(task.period_s, task.duty_factor);
  const generator::GroundMeasure imitated =
      generator::measure(making.legs, with_slopes(task.reference), when, generator::hiking_base(task, 1.0));
  task.height_m = imitated.height_mean_m;
  // What a library is accepted with (generator/clip_report.hpp), and 1 to 2 mm.
  task.clearance_m = 0.027;
  task.foot_gap_m = 0.03;
  // A degree off the human's angle costs as much as 7 cm/s off the mean speed, or as 1 cm/s of slip in double support.
  task.weights.reference << 12.0, 12.0, 6.0, 12.0, 12.0, 6.0;
  task.weights.bias = task.weights.reference;
  task.weights.velocity = 3.0;
  task.weights.velocity_yaw = 1.5;
  task.weights.height = 30.0;
  task.weights.limit = 300.0;
  task.weights.clearance = 300.0;
  task.scenarios = {{1.0, 1.0, {}}};
  task.rounds = 3;
  task.first_iterations = 60;
  task.later_iterations = 20;
  return task;
}

/// The channel's part of a person's velocity, 0 to 1; turning counts as the speed of a foot at a leg's length.
double kept_share(const RetargetedClip& made) {
  const Eigen::Vector3d speed =
      made.human.mean_velocity.cwiseAbs().cwiseProduct(Eigen::Vector3d(1.0, 1.0, made.human.leg_length_m));
  const Eigen::Vector3d kept = (made.wanted_velocity.array() != 0.0).select(speed, 0.0);
  return kept.sum() / speed.sum();
}

/// What a library promises beside likeness: velocity, clearance of feet, smooth curves.
void weigh_promises(generator::GaitWeights& weights) {
  weights.velocity = 9.0;
  weights.velocity_yaw = 6.0;
  weights.step_height = 2400.0;
  weights.above_ground = 1800.0;
  weights.foot_gap = 600.0;
  weights.smooth = kSmooth;
}

/// Of the clip at full gain alone, as a library is accepted with it (generator/clip_report.hpp).
GaitTask full_gain_task(const RetargetedClip& made) {
  GaitTask task = made.gait.task;
  task.clearance_m = 0.030;
  task.landing = 1.0;
  task.weights.reference << 48.0, 48.0, 24.0, 48.0, 48.0, 24.0;
  task.weights.bias = task.weights.reference;
  const double kept = kept_share(made);
  task.weights.reference *= kept;
  task.weights.bias *= kept;
  weigh_promises(task.weights);
  task.weights.slip = 30.0;
  task.weights.clearance = 1200.0;
  return task;
}

/// A clip at this gain as part of a mixture: q_stand + g (2 g - 1) d + 4 g (1 - g) h.
generator::Addition at_gain(const generator::Making& making, const RetargetedClip& clip, double gain, double period_s) {
  if (!clip.half) return generator::clip_addition(making, clip.gait.legs, clip.gait.task, gain, period_s);
  return generator::together(
      generator::clip_addition(making, clip.gait.legs, clip.gait.task, gain * (2.0 * gain - 1.0), period_s),
      generator::clip_addition(making, clip.half->legs, clip.half->task, 4.0 * gain * (1.0 - gain), period_s));
}

/// The velocity channel of a clip.
Eigen::Index channel_of(const RetargetedClip& clip) {
  Eigen::Index channel = 0;
  clip.wanted_velocity.cwiseAbs().maxCoeff(&channel);
  return channel;
}

GaitTask half_gain_task(const generator::Making& making, const std::vector<const RetargetedClip*>& others,
                        const RetargetedClip& made) {
  GaitTask task = made.gait.task;
  task.velocity *= 0.5;
  task.sway_m *= 0.5;
  task.hike_rad *= 0.5;
  task.height_m *= 0.5;
  task.clearance_m = 0.030;
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    for (const Foot foot : {kLeft, kRight})
      task.reference[k][foot] = 0.5 * (making.legs.stand[foot] + made.gait.legs.q[k][foot]);
  }
  task.weights.reference = generator::LegVector<double>::Constant(4.0);
  task.weights.bias = task.weights.reference;
  weigh_promises(task.weights);
  task.weights.clearance = 400.0;
  task.scenarios.clear();
  const auto scenario = [&](double gain, double weight) {
    generator::Scenario s;
    s.gain = 4.0 * gain * (1.0 - gain);
    s.weight = weight;
    s.lift = gain;
    s.promised = true;
    s.addition =
        generator::clip_addition(making, made.gait.legs, made.gait.task, gain * (2.0 * gain - 1.0), task.period_s);
    return s;
  };
  for (const double gain : {0.12, 0.3, 0.55, 0.8}) task.scenarios.push_back(scenario(gain, 1.0));
  for (const auto& [gain, channel, command] :
       {std::tuple{0.3, kHeight, -0.09}, std::tuple{0.6, kHeight, -0.09}, std::tuple{0.5, kRoll, 0.12}}) {
    generator::Scenario s = scenario(gain, kPostureWeight);
    s.addition = generator::together(s.addition, generator::posture_addition(making, channel, command));
    s.promised = false;
    task.scenarios.push_back(s);
  }
  const auto add_mixture = [&](double gain, double others_gain, const std::vector<const RetargetedClip*>& with) {
    generator::Scenario s = scenario(gain, 1.0);
    s.lift = std::max(gain, others_gain);
    for (const RetargetedClip* other : with)
      s.addition = generator::together(s.addition, at_gain(making, *other, others_gain, task.period_s));
    task.scenarios.push_back(s);
  };
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (const auto& [gain, others_gain] : kPairs) add_mixture(gain, others_gain, {others[i]});
    for (std::size_t j = i + 1; j < others.size(); ++j) {
      if (channel_of(*others[i]) == channel_of(*others[j])) continue;
      add_mixture(1.0 / 3.0, 1.0 / 3.0, {others[i], others[j]});
    }
  }
  return task;
}

DynamicClip whole_body(const generator::Making& making, const GaitTask& task, const LegTrajectory& legs,
                       const HumanCycle& human, const generator::GroundMeasure& ground) {
  DynamicClip clip;
  clip.period_s = task.period_s;
  const GaitTiming when = generator::timing(task.period_s, task.duty_factor);
  clip.contact_center = when.contact_center;
  clip.duty_factor = when.duty_factor;
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const double phase = static_cast<double>(k) / static_cast<double>(kClipSamples);
    JointVector q = making.robot.q_stand();
    imitate_upper_body(making.robot, making.roles, human, k, generator::hike(task, phase).angle_rad, kLimitMargin_rad,
                       q);
    for (const Foot foot : {kLeft, kRight}) {
      for (std::size_t role = 0; role < generator::kLegJoints; ++role)
        q[making.roles.leg[foot][role]] = legs.q[k][foot][static_cast<Eigen::Index>(role)];
    }
    clip.q.push_back(q);
  }
  clip.dq_dphi = periodic_spline_slopes(clip.q);
  for (Eigen::Index i = 0; i < 3; ++i) clip.mean_velocity[static_cast<std::size_t>(i)] = ground.mean_velocity[i];
  return clip;
}

void measure_joints(const model::RobotModel& robot, RetargetedClip& made) {
  const DynamicClip& clip = made.clip;
  std::vector<std::vector<double>> curves(robot.joints.size());
  made.limit_margin_rad = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const model::Joint& joint = robot.joints[j];
      const auto i = static_cast<Eigen::Index>(j);
      curves[j].push_back(clip.q[k][i]);
      made.limit_margin_rad =
          std::min({made.limit_margin_rad, clip.q[k][i] - joint.lower_rad, joint.upper_rad - clip.q[k][i]});
      made.joint_speed_share =
          std::max(made.joint_speed_share, std::abs(clip.dq_dphi[k][i]) / clip.period_s / joint.velocity_limit_rad_s);
    }
  }
  made.seam = mocap::seam_jump(curves, clip.period_s);
}

/// Solves the task and takes the clip and its measures from the result.
void make_clip(const generator::Making& making, GaitTask task, const work::Progress& progress, RetargetedClip& made) {
  made.gait.task = std::move(task);
  made.gait.legs = generator::optimize_gait(making.legs, made.gait.task, progress).legs;
  const GaitTask& asked = made.gait.task;
  const LegTrajectory& legs = made.gait.legs;
  const std::vector<generator::BaseMotion> base = generator::hiking_base(asked, 1.0);
  made.ground = generator::measure(making.legs, legs, generator::timing(asked.period_s, asked.duty_factor), base);
  made.clip = whole_body(making, asked, legs, made.human, made.ground);
  made.likeness = imitation(leg_angles(making.legs, legs.q, base), leg_angles(made.human));
  made.joint_speed_share = 0.0;
  measure_joints(making.robot, made);
}

}  // namespace

RetargetedClip retarget(const generator::Making& making, const mocap::Recording& recording, const mocap::GaitCycle& cut,
                        Channel channel, std::optional<double> duty_factor, const work::Progress& progress) {
  const double begin_s = thread_cpu_s();
  RetargetedClip made;
  made.human = human_cycle(recording, cut, duty_factor);
  made.length_ratio = leg_length_m(making.legs.geometry[kLeft]) / made.human.leg_length_m;
  made.froude_ratio = std::sqrt(made.length_ratio);
  const auto component = static_cast<Eigen::Index>(channel);
  const double human_speed = made.human.mean_velocity[component];
  // The rate of turning is 1 / time; speeds are length / time.
  made.wanted_velocity[component] =
      channel == kOmega ? human_speed / made.froude_ratio : human_speed * made.froude_ratio;
  make_clip(making, retargeting_task(making, made), progress, made);
  made.retarget_s = thread_cpu_s() - begin_s;
  made.frames_per_s = static_cast<double>(kClipSamples) / made.retarget_s;
  return made;
}

void fit_full_gain(const generator::Making& making, RetargetedClip& made, const work::Progress& progress) {
  const double begin_s = thread_cpu_s();
  made.unmended = {made.likeness, made.ground};
  make_clip(making, full_gain_task(made), progress, made);
  imitate_arms(making.robot, making.roles, made.human, kLimitMargin_rad, made.clip);
  made.joint_speed_share = 0.0;
  measure_joints(making.robot, made);
  made.fit_s = thread_cpu_s() - begin_s;
}

void fit_half_gain(const generator::Making& making, const std::vector<const RetargetedClip*>& others,
                   RetargetedClip& made, const work::Progress& progress) {
  const double begin_s = thread_cpu_s();
  generator::MadeGait half;
  half.task = half_gain_task(making, others, made);
  half.legs = generator::optimize_gait(making.legs, half.task, progress).legs;
  made.half = std::move(half);
  made.clip.half_q.clear();
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    JointVector q = 0.5 * (making.robot.q_stand() + made.clip.q[k]);
    for (const Foot foot : {kLeft, kRight}) {
      for (std::size_t role = 0; role < generator::kLegJoints; ++role)
        q[making.roles.leg[foot][role]] = made.half->legs.q[k][foot][static_cast<Eigen::Index>(role)];
    }
    made.clip.half_q.push_back(q);
  }
  made.clip.half_dq_dphi = periodic_spline_slopes(made.clip.half_q);
  made.fit_s += thread_cpu_s() - begin_s;
}

}  // namespace pmg::retargeting
