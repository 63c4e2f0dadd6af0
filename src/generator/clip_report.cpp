#include "generator/clip_report.hpp"

#include <algorithm>
#include <cmath>

#include "generator/joint_roles.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::generator {
namespace {

/// Two stance feet may differ in height by a centimetre. When the lower one lifts off, the base sinks onto the other.
/// At small gains the foot that has just lifted off is then below the ground for the first ticks of its swing.
constexpr double kSwingBelowGround_m = 0.006;

/// The base's mean pitch [rad] under an upright torso, forward positive.
double pelvis_tilt_rad(const model::RobotModel& robot, const JointRoles& roles, const DynamicClip& clip) {
  if (!roles.waist_pitch) return 0.0;
  double mean = 0.0;
  for (const JointVector& q : clip.q) mean += q[*roles.waist_pitch] / static_cast<double>(clip.q.size());
  return robot.q_stand()[*roles.waist_pitch] - mean;
}

constexpr double kClearance_m = 0.025;  // for a floor that isn't quite flat

std::string judge(const ClipReport& clip) {
  for (const GainReport& at : clip.gains) {
    const std::string where = " at gain " + std::to_string(at.gain).substr(0, 4);
    if (at.ground.slip_mean_m_s > 0.03 || at.ground.slip_p95_m_s > 0.10) {
      return "feet slip in double support" + where;
    }
    if (at.ground.other_foot_height_m > 0.01) {
      return "stance feet differ in height" + where;
    }
    if (at.velocity_error.cwiseAbs().maxCoeff() > 0.05) {
      return "mean velocity is off" + where;
    }
    if (at.ground.lowest_swing_m < -kSwingBelowGround_m) {
      return "a swinging foot goes through the ground" + where;
    }
    if (at.ground.foot_gap_m < 0.02) {
      return "feet come too close" + where;
    }
  }
  if (clip.gains.back().ground.clearance_m < kClearance_m) {
    return "feet are hardly lifted at full gain";
  }
  return clip.joint_speed_share > 0.6 ? "a joint is too fast" : "";
}

ClipReport report_clip(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs,
                       const std::string& name, const DynamicClip& clip) {
  ClipReport out;
  out.name = name;
  out.period_s = clip.period_s;
  out.duty_factor = clip.duty_factor[kLeft];
  const JointVector q_stand = robot.q_stand();
  const GaitTiming when{clip.period_s, clip.contact_center, clip.duty_factor};
  const Eigen::Vector3d full(clip.mean_velocity[0], clip.mean_velocity[1], clip.mean_velocity[2]);
  for (int tenth = 1; tenth <= 10; ++tenth) {
    GainReport at;
    at.gain = 0.1 * tenth;
    at.ground = measure(legs, leg_trajectory(clip, roles, at.gain, q_stand), when, base_of(robot, clip, at.gain));
    at.velocity_error = at.ground.mean_velocity - at.gain * full;
    out.gains.push_back(at);
  }
  out.limit_margin_rad = 1e9;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      const model::Joint& joint = robot.joints[j];
      out.limit_margin_rad =
          std::min({out.limit_margin_rad, clip.q[k][i] - joint.lower_rad, joint.upper_rad - clip.q[k][i]});
      out.joint_speed_share =
          std::max(out.joint_speed_share, std::abs(clip.dq_dphi[k][i]) / clip.period_s / joint.velocity_limit_rad_s);
    }
  }
  out.failure = judge(out);
  return out;
}

// Where people's feet lie flat [% of the cycle]: the published curves turn the sole by less than 3 degrees there.
constexpr std::size_t kFlatFrom = 10, kFlatTo = 30;

/// A leg's flexions as norms have them [deg at kCyclePoints].
using LegCurves = std::array<std::vector<double>, kGaitJoints>;

/// Of the left leg, under an upright torso.
LegCurves curves_of(const model::RobotModel& robot, const DynamicClip& forward) {
  const JointRoles roles = find_joint_roles(robot);
  const double tilt_rad = pelvis_tilt_rad(robot, roles, forward);
  LegCurves curves;
  for (std::size_t k = 0; k < kCyclePoints; ++k) {
    const auto flexed = flexions_deg(forward.q[k * forward.q.size() / kCyclePoints], roles.leg[kLeft], tilt_rad);
    for (std::size_t joint = 0; joint < kGaitJoints; ++joint) curves[joint].push_back(flexed[joint]);
  }
  return curves;
}

/// Mean rise of the toes where people's feet lie flat.
double toes_up_deg(const LegCurves& curves) {
  double sum = 0.0;
  for (std::size_t k = kFlatFrom; k <= kFlatTo; ++k)
    sum += curves[kHip][k] - curves[kKneeFlexion][k] + curves[kAnkle][k];
  return sum / static_cast<double>(kFlatTo - kFlatFrom + 1);
}

/// The thigh against the pelvis.
std::vector<double> hip_flexion(std::vector<double> thigh_deg, const std::vector<double>& pelvic_tilt_deg) {
  for (std::size_t k = 0; k < thigh_deg.size(); ++k) thigh_deg[k] += pelvic_tilt_deg[k];
  return thigh_deg;
}

NormReport compare(const std::string& curve, const std::vector<double>& ours, const std::vector<double>& published) {
  return {curve, agreement(ours, published), ours.front()};
}

}  // namespace

LegTrajectory leg_trajectory(const DynamicClip& clip, const JointRoles& roles, double gain,
                             const JointVector& q_stand) {
  LegTrajectory legs;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    LegPose q;
    LegPose dq;
    for (const Foot foot : {kLeft, kRight}) {
      for (std::size_t role = 0; role < kLegJoints; ++role) {
        const int joint = roles.leg[foot][role];
        const auto i = static_cast<Eigen::Index>(role);
        q[foot][i] = q_stand[joint] + gain * (clip.q[k][joint] - q_stand[joint]);
        dq[foot][i] = gain * clip.dq_dphi[k][joint];
      }
    }
    legs.q.push_back(q);
    legs.dq_dphi.push_back(dq);
  }
  return legs;
}

std::vector<BaseMotion> base_of(const model::RobotModel& robot, const DynamicClip& clip, double gain) {
  model::BaseAttitude attitude(robot);
  const JointVector q_stand = robot.q_stand();
  std::vector<BaseMotion> base;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    const JointVector q = q_stand + gain * (clip.q[k] - q_stand);
    const JointVector dq = gain / clip.period_s * clip.dq_dphi[k];
    const model::BaseAttitude::Result at = attitude.compute(q, dq, 0.0, 0.0, 0.0, 0.0);
    base.push_back({at.R_HB, at.omega_HB_H});
  }
  return base;
}

std::vector<ClipReport> report(const model::RobotModel& robot, const ClipLibrary& library) {
  const JointRoles roles = find_joint_roles(robot);
  const RobotLegs legs = robot_legs(robot, roles);
  constexpr std::array<const char*, kVelocityChannels> kPositive = {"forward", "lateral", "turn"};
  constexpr std::array<const char*, kVelocityChannels> kNegative = {"backward", "lateral_right", "turn_right"};
  std::vector<ClipReport> reports;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    if (library.positive[channel]) {
      reports.push_back(report_clip(robot, roles, legs, kPositive[channel], *library.positive[channel]));
    }
    if (library.negative[channel]) {
      reports.push_back(report_clip(robot, roles, legs, kNegative[channel], *library.negative[channel]));
    }
  }
  return reports;
}

std::vector<NormReport> compare_with_norms(const model::RobotModel& robot, const DynamicClip& forward,
                                           const GaitNorms& norms) {
  const LegCurves ours = curves_of(robot, forward), &published = norms.deg;
  const std::vector<double> tilt_deg(kCyclePoints,
                                     pelvis_tilt_rad(robot, find_joint_roles(robot), forward) / kRadPerDegree);
  return {compare("hip", hip_flexion(ours[kHip], tilt_deg), hip_flexion(published[kHip], norms.pelvic_tilt_deg)),
          compare("thigh", ours[kHip], published[kHip]), compare("knee", ours[kKneeFlexion], published[kKneeFlexion]),
          compare("ankle", ours[kAnkle], published[kAnkle])};
}

SoleReport compare_sole_with_norms(const model::RobotModel& robot, const DynamicClip& forward, const GaitNorms& norms) {
  return {toes_up_deg(curves_of(robot, forward)), toes_up_deg(norms.deg)};
}

}  // namespace pmg::generator
