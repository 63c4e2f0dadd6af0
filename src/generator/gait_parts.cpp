#include "generator/gait_parts.hpp"

#include "generator/gait_measure.hpp"
#include "generator/static_clips.hpp"

namespace pmg::generator {

Addition posture_addition(const Making& making, Channel channel, double command) {
  Addition addition;
  const StaticClip& clip = making.posture[channel - kPitch];
  addition.q = {leg_offset(clip, making.roles, making.legs, command)};
  if (channel == kPitch) {
    // The optimisation's base doesn't pitch. So the hips, the chain's first joints, undo the pelvis' part of the pitch.
    const double pelvis_pitch = kPelvisShareOfPitch * command;
    for (const Foot foot : {kLeft, kRight}) {
      addition.q[0][foot][kHipPitch] += pelvis_pitch;
    }
  }
  addition.height_m = channel == kHeight ? command : 0.0;
  return addition;
}

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
  addition.sway_m = gain * task.sway_m;
  addition.height_m = gain * task.height_m;
  return addition;
}

Addition together(Addition a, const Addition& b) {
  for (std::size_t k = 0; k < a.q.size(); ++k) {
    for (const Foot foot : {kLeft, kRight}) {
      a.q[k][foot] += b.q[k % b.q.size()][foot];
      if (!b.dq_dphi.empty()) a.dq_dphi[k][foot] += b.dq_dphi[k % b.dq_dphi.size()][foot];
    }
    if (!b.roll.empty()) {
      a.roll[k].angle_rad += b.roll[k].angle_rad;
      a.roll[k].slope_rad += b.roll[k].slope_rad;
    }
  }
  a.velocity += b.velocity;
  a.sway_m += b.sway_m;
  a.height_m += b.height_m;
  return a;
}

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
    constexpr double kStep = 1e-5;  // [cycles]: the upper body's curves are smooth
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

}  // namespace pmg::generator
