#include "generator/clip_report.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "files/bounded_file.hpp"
#include "files/config_error.hpp"
#include "generator/joint_roles.hpp"
#include "generator/published_gait.hpp"
#include "model/leg_kinematics.hpp"
#include "pmg/half_gain.hpp"

namespace pmg::generator {
namespace {

/// Two stance feet may differ in height by a centimetre. When the lower one lifts off, the base sinks onto the other.
/// At small gains the foot that has just lifted off is then below the ground for the first ticks of its swing.
constexpr double kSwingBelowGround_m = 0.006;

LegTrajectory leg_trajectory(const DynamicClip& clip, const JointRoles& roles) {
  LegTrajectory legs;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    LegPose q;
    LegPose dq;
    for (const Foot foot : {kLeft, kRight}) {
      for (std::size_t role = 0; role < kLegJoints; ++role) {
        const int joint = roles.leg[foot][role];
        const auto i = static_cast<Eigen::Index>(role);
        q[foot][i] = clip.q[k][joint];
        dq[foot][i] = clip.dq_dphi[k][joint];
      }
    }
    legs.q.push_back(q);
    legs.dq_dphi.push_back(dq);
  }
  return legs;
}

/// The base's mean pitch [rad] under an upright torso.
double pelvis_tilt(const DynamicClip& clip, const JointRoles& roles, double gain, const JointVector& q_stand) {
  if (!roles.waist_pitch) {
    return 0.0;
  }
  double mean = 0.0;
  for (const JointVector& q : clip.q) {
    mean += q[*roles.waist_pitch] / static_cast<double>(clip.q.size());
  }
  return -gain * (mean - q_stand[*roles.waist_pitch]);
}

/// The base's attitude and rate under an upright torso, one per sample.
std::vector<BaseMotion> base_of(const model::RobotModel& robot, const DynamicClip& clip) {
  model::BaseAttitude attitude(robot);
  std::vector<BaseMotion> base;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    const JointVector dq = 1.0 / clip.period_s * clip.dq_dphi[k];
    const model::BaseAttitude::Result at = attitude.compute(clip.q[k], dq, 0.0, 0.0, 0.0, 0.0);
    base.push_back({at.R_HB, at.omega_HB_H});
  }
  return base;
}

constexpr double kClearance_m = 0.025;  // for a floor that isn't quite flat
// At 0.7 to 0.85 of the swing. A forward clip with 8 mm there landed 5 % of a cycle early in the simulation, which took
// the knee's correlation with the published mean from 0.97 to 0.78; with 15 mm feet landed in time.
constexpr double kLanding_m = 0.010;

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
  if (clip.gains.back().ground.landing_m < kLanding_m) {
    return "a foot is near the ground too long before it lands";
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
    const DynamicClip blended = at_gain(clip, q_stand, at.gain);
    at.ground = measure(legs, leg_trajectory(blended, roles), when, base_of(robot, blended));
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

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell);
  }
  return cells;
}

/// One column of a norms file without its last row, because 100 % is 0 % again.
std::vector<double> read_column(const std::filesystem::path& file, const std::string& name) {
  std::istringstream in(files::read_bounded_text(file, files::kLargestTable_bytes, "a file of norms"));
  std::vector<double> values;
  std::ptrdiff_t column = -1;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const std::vector<std::string> cells = split(line);
    if (column < 0) {
      column = std::find(cells.begin(), cells.end(), name) - cells.begin();
    } else if (column < std::ssize(cells)) {
      values.push_back(std::strtod(cells[static_cast<std::size_t>(column)].c_str(), nullptr));
    }
  }
  if (values.size() != 101) {
    throw files::ConfigError(file.string() + ": " + name + ": " + std::to_string(values.size()) +
                             " values; expected a column of 101, 0 to 100 % of the cycle");
  }
  values.pop_back();
  return values;
}

NormReport compare(const std::string& curve, const std::vector<double>& ours, const std::vector<double>& published) {
  const auto n = static_cast<Eigen::Index>(ours.size());
  const Eigen::Map<const Eigen::ArrayXd> a(ours.data(), n);
  const Eigen::Map<const Eigen::ArrayXd> b(published.data(), n);
  const Eigen::ArrayXd da = a - a.mean();
  const Eigen::ArrayXd db = b - b.mean();
  return {curve, (da * db).sum() / std::sqrt(da.square().sum() * db.square().sum()), std::sqrt((a - b).square().mean()),
          a[0]};
}

constexpr std::size_t kNormPoints = 100;  // 0 to 99 % of the cycle

// Where people's feet lie flat [kNormPoints]: the published curves turn the sole by less than 3 degrees there.
constexpr std::size_t kFlatFrom = 10, kFlatTo = 30;

/// Published means [deg] at kNormPoints.
struct NormCurves {
  std::vector<double> hip, tilt, knee, ankle;
};

/// The left leg's flexion [deg] at kNormPoints.
struct LegCurves {
  std::vector<double> hip, thigh, knee, ankle;

  /// Mean rise of the toes where people's feet lie flat.
  double toes_up_deg() const {
    double sum = 0.0;
    for (std::size_t k = kFlatFrom; k <= kFlatTo; ++k) sum += thigh[k] - knee[k] + ankle[k];
    return sum / static_cast<double>(kFlatTo - kFlatFrom + 1);
  }
};

LegCurves curves_of(const model::RobotModel& robot, const DynamicClip& forward) {
  const JointRoles roles = find_joint_roles(robot);
  const double tilt_deg = pelvis_tilt(forward, roles, 1.0, robot.q_stand()) / kRadPerDegree;
  LegCurves curves;
  const std::size_t n = forward.q.size();
  for (std::size_t k = 0; k < kNormPoints; ++k) {
    const JointVector& q = forward.q[k * n / kNormPoints];
    curves.hip.push_back(-q[roles.leg[kLeft][kHipPitch]] / kRadPerDegree);
    curves.thigh.push_back(curves.hip.back() - tilt_deg);
    curves.knee.push_back(q[roles.leg[kLeft][kKnee]] / kRadPerDegree);
    curves.ankle.push_back(-q[roles.leg[kLeft][kAnklePitch]] / kRadPerDegree);
  }
  return curves;
}

LegCurves curves_of(const NormCurves& norms) {
  LegCurves curves{.hip = norms.hip, .thigh = norms.hip, .knee = norms.knee, .ankle = norms.ankle};
  for (std::size_t k = 0; k < kNormPoints; ++k) curves.thigh[k] -= norms.tilt[k];
  return curves;
}

/// Of generator/published_gait.hpp.
NormCurves published_norms() {
  const PublishedGait& gait = published_gait();
  NormCurves norms;
  for (std::size_t k = 0; k < kNormPoints; ++k) {
    const double phase = static_cast<double>(k) / static_cast<double>(kNormPoints);
    norms.hip.push_back(gait.hip_flexion.at_rad(phase) / kRadPerDegree);
    norms.tilt.push_back(gait.pelvic_tilt_deg);
    norms.knee.push_back(gait.knee_flexion.at_rad(phase) / kRadPerDegree);
    norms.ankle.push_back(gait.ankle_dorsiflexion.at_rad(phase) / kRadPerDegree);
  }
  return norms;
}

/// norms: as of compare_with_norms.
NormCurves read_norms(const std::filesystem::path& norms) {
  if (norms.empty()) return published_norms();
  return {.hip = read_column(norms, "hip_flexion_mean"),
          .tilt = read_column(norms, "pelvis_tilt_ant+_mean"),
          .knee = read_column(norms, "knee_flexion_mean"),
          .ankle = read_column(norms, "ankle_dorsiflexion_mean")};
}

}  // namespace

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
                                           const std::filesystem::path& norms) {
  const LegCurves ours = curves_of(robot, forward), published = curves_of(read_norms(norms));
  return {compare("hip", ours.hip, published.hip), compare("thigh", ours.thigh, published.thigh),
          compare("knee", ours.knee, published.knee), compare("ankle", ours.ankle, published.ankle)};
}

SoleReport compare_sole_with_norms(const model::RobotModel& robot, const DynamicClip& forward,
                                   const std::filesystem::path& norms) {
  return {curves_of(robot, forward).toes_up_deg(), curves_of(read_norms(norms)).toes_up_deg()};
}

}  // namespace pmg::generator
