#include "generator/static_clips.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "generator/center_of_mass.hpp"
#include "generator/gait_reference.hpp"

namespace pmg::generator {
namespace {

constexpr double kAngleStep_rad = 0.02;
constexpr double kHeightStep_m = 0.005;
constexpr double kStraightKnee_rad = 0.06;  // least knee angle of the highest squat row

constexpr double kLeanCompensation = 0.4;      // share of the lean's shift of mass that the pelvis undoes
constexpr double kSquatArms_rad_per_m = 1.75;  // arms forward as a counterweight

/// Moves the base while both feet stay in place. base: deviation from its standing place (x forward, y left, z up);
/// R_WB: its attitude. Sets the legs of q.
void place_base(const JointRoles& roles, const RobotLegs& legs, const Eigen::Matrix3d& R_WB,
                const Eigen::Vector3d& base, JointVector& q) {
  for (const Foot foot : {kLeft, kRight}) {
    LegVector<double> start;
    for (std::size_t role = 0; role < kLegJoints; ++role) {
      start[static_cast<Eigen::Index>(role)] = q[roles.leg[foot][role]];
    }
    const FootMotion<double> standing =
        foot_motion<double>(legs.geometry[foot], legs.stand[foot], LegVector<double>::Zero());
    const LegVector<double> leg =
        reach(legs.geometry[foot], R_WB.transpose() * standing.R_BF, R_WB.transpose() * (standing.p_BF - base), start);
    for (std::size_t role = 0; role < kLegJoints; ++role) {
      q[roles.leg[foot][role]] = leg[static_cast<Eigen::Index>(role)];
    }
  }
}

/// Moves the base along `direction` until the centre of mass is `target_m` along it, measured from the standing base
/// (secant method).
JointVector balance(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs,
                    const Eigen::Matrix3d& R_WB, const Eigen::Vector3d& base, const Eigen::Vector3d& direction,
                    double target_m, const JointVector& start) {
  JointVector q = start;
  const auto excess = [&](double shift) {
    place_base(roles, legs, R_WB, base + shift * direction, q);
    return direction.dot(base + shift * direction + R_WB * center_of_mass(robot, q)) - target_m;
  };
  double before = 0.0;
  double excess_before = excess(before);
  double shift = -excess_before;
  for (int i = 0; i < 20; ++i) {
    const double e = excess(shift);
    if (std::abs(e) < 1e-9) {
      break;
    }
    const double next = shift - e * (shift - before) / (e - excess_before);
    before = shift;
    excess_before = e;
    shift = next;
  }
  return q;
}

/// Rows outward from standing in both directions; each one starts from its neighbour's posture.
StaticClip rows(double lower, double upper, const std::function<double(double)>& step, const JointVector& q_stand,
                const std::function<JointVector(double, const JointVector&)>& posture) {
  StaticClip clip;
  clip.command = {0.0};
  clip.q = {q_stand};
  for (const double end : {lower, upper}) {
    JointVector q = q_stand;
    double command = 0.0;
    while (std::abs(command - end) > 1e-9) {
      const double next = command + std::copysign(step(command), end);
      // grid values, not sums of steps; the last row is exactly the end of the range
      command = std::abs(end - next) < 1e-9 || std::abs(next) > std::abs(end) ? end : std::round(next * 1e6) / 1e6;
      q = posture(command, q);
      if (end < 0.0) {
        clip.command.insert(clip.command.begin(), command);
        clip.q.insert(clip.q.begin(), q);
      } else {
        clip.command.push_back(command);
        clip.q.push_back(q);
      }
    }
  }
  return clip;
}

Eigen::Matrix3d pitched(double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix(); }

}  // namespace

StaticClip make_bend(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs) {
  const JointVector q_stand = robot.q_stand();
  const double pelvis_share = roles.waist_pitch ? kPelvisShareOfPitch : 1.0;
  return rows(
      robot.command_limits.lower[kPitch], robot.command_limits.upper[kPitch], [](double) { return kAngleStep_rad; },
      q_stand,
      [&](double pitch, const JointVector& near) {
        JointVector q = near;
        if (roles.waist_pitch) {
          q[*roles.waist_pitch] = q_stand[*roles.waist_pitch] + (1.0 - pelvis_share) * pitch;
        }
        // About the hips' own axis, so the legs keep their posture. Moving the hips back would turn both legs equally,
        // and in a stride it would lift one foot off the ground. The centre of mass stays well over the feet.
        place_base(roles, legs, pitched(pelvis_share * pitch), Eigen::Vector3d::Zero(), q);
        return q;
      });
}

StaticClip make_lean(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs) {
  const JointVector q_stand = robot.q_stand();
  return rows(
      robot.command_limits.lower[kRoll], robot.command_limits.upper[kRoll], [](double) { return kAngleStep_rad; },
      q_stand,
      [&](double roll, const JointVector& near) {
        JointVector q = near;
        if (roles.waist_roll) {
          q[*roles.waist_roll] = q_stand[*roles.waist_roll] + roll;
        }
        const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
        const double com_y = (1.0 - kLeanCompensation) * center_of_mass(robot, q).y();
        return balance(robot, roles, legs, level, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitY(), com_y, q);
      });
}

StaticClip make_squat(const model::RobotModel& robot, const JointRoles& roles, const RobotLegs& legs) {
  const JointVector q_stand = robot.q_stand();
  const double com_x = center_of_mass(robot, q_stand).x();
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  const auto posture = [&](double height, const JointVector& near) {
    JointVector q = near;
    for (const Foot foot : {kLeft, kRight}) {
      if (roles.shoulder_pitch[foot]) {
        const int shoulder = *roles.shoulder_pitch[foot];
        q[shoulder] = q_stand[shoulder] + kSquatArms_rad_per_m * std::min(height, 0.0);
      }
    }
    return balance(robot, roles, legs, level, Eigen::Vector3d(0.0, 0.0, height), Eigen::Vector3d::UnitX(), com_x, q);
  };
  // The highest row: the knees nearly straight, or the end of the range.
  constexpr double kFineStep_m = 0.001;
  double highest = 0.0;
  JointVector q = q_stand;
  while (highest + kFineStep_m <= robot.command_limits.upper[kHeight] + 1e-9) {
    try {
      q = posture(highest + kFineStep_m, q);
    } catch (const std::runtime_error&) {
      break;
    }
    if (q[roles.leg[kLeft][kKnee]] < kStraightKnee_rad) {
      break;
    }
    highest += kFineStep_m;
  }
  // Near the straight leg the knee angle is steep over the height: finer rows.
  return rows(
      robot.command_limits.lower[kHeight], highest,
      [](double height) { return height > -0.01 ? kFineStep_m : kHeightStep_m; }, q_stand, posture);
}

LegPose leg_offset(const StaticClip& clip, const JointRoles& roles, const RobotLegs& legs, double command) {
  const auto above = std::lower_bound(clip.command.begin(), clip.command.end(), command);
  const auto row = std::clamp<std::ptrdiff_t>(above - clip.command.begin(), 1, std::ssize(clip.command) - 1);
  const auto hi = static_cast<std::size_t>(row);
  const double t = std::clamp((command - clip.command[hi - 1]) / (clip.command[hi] - clip.command[hi - 1]), 0.0, 1.0);
  LegPose offset;
  for (const Foot foot : {kLeft, kRight}) {
    for (std::size_t role = 0; role < kLegJoints; ++role) {
      const int joint = roles.leg[foot][role];
      const auto i = static_cast<Eigen::Index>(role);
      offset[foot][i] = (1.0 - t) * clip.q[hi - 1][joint] + t * clip.q[hi][joint] - legs.stand[foot][i];
    }
  }
  return offset;
}

}  // namespace pmg::generator
