#include "excitation/robot_excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/constants.hpp"
#include "model/hanging_load.hpp"
#include "pmg/posture.hpp"

namespace pmg::excitation {

namespace {

model::JointCommand robot_gains(const model::RobotModel& robot) {
  const int n = robot.joint_index.size();
  model::JointCommand command;
  command.q = robot.q_stand();
  command.dq = command.tau_ff = JointVector::Zero(n);
  command.kp.resize(n);
  command.kd.resize(n);
  for (int j = 0; j < n; ++j) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(j)];
    command.kp[j] = joint.kp_Nm_per_rad;
    command.kd[j] = joint.kd_Nm_s_per_rad;
  }
  return command;
}

double smooth(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// Outward motion of what each joint moves, away from the median plane [m/rad]; 0 for joints in that plane.
JointVector outward_m_per_rad(const model::RobotModel& robot) {
  constexpr double kMedian_m = 0.02;  // of the median plane, either side
  JointVector outward = JointVector::Zero(robot.joint_index.size());
  for (int j = 0; j < outward.size(); ++j) {
    const model::HangingLoad moved = model::hanging_load(robot, robot.joint_index.name(j));
    if (std::abs(moved.center_m.y()) < kMedian_m) continue;
    outward[j] = std::copysign(1.0, moved.center_m.y()) * moved.center_m_per_rad.y();
  }
  return outward;
}

/// Sum of three sines of a joint: slow ones for gravity and friction, fast ones for inertia.
struct Swing {
  double center_rad = 0.0;
  std::array<double, 3> amplitude_rad{}, frequency_Hz{}, phase_rad{};

  double at(double t_s) const {
    double q = center_rad;
    for (std::size_t i = 0; i < 3; ++i) q += amplitude_rad[i] * std::sin(argument(i, t_s));
    return q;
  }
  double speed_at(double t_s) const {
    double dq = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      dq += 2.0 * std::numbers::pi * frequency_Hz[i] * amplitude_rad[i] * std::cos(argument(i, t_s));
    return dq;
  }

 private:
  double argument(std::size_t i, double t_s) const {
    return 2.0 * std::numbers::pi * frequency_Hz[i] * t_s + phase_rad[i];
  }
};

/// Legs slightly, arms further, so that hands and thighs never collide.
double spread_rad(const model::RobotModel& robot, const JointVector& outward_m_per_rad, int joint) {
  constexpr double kSpreading_m_per_rad = 0.15, kLeg_rad = 0.2, kArm_rad = 0.6;
  if (std::abs(outward_m_per_rad[joint]) < kSpreading_m_per_rad) return 0.0;
  const auto in = [joint](const std::vector<int>& leg) { return std::ranges::find(leg, joint) != leg.end(); };
  const bool of_leg = in(robot.leg_joints[kLeft]) || in(robot.leg_joints[kRight]);
  return std::copysign(of_leg ? kLeg_rad : kArm_rad, outward_m_per_rad[joint]);
}

std::vector<Swing> swings(const model::RobotModel& robot) {
  constexpr std::array<double, 3> kAmplitude_rad{0.16, 0.09, 0.04}, kSlowest_Hz{0.20, 0.50, 1.30},
      kFastest_Hz{0.40, 0.95, 2.10};
  constexpr double kGolden = 0.6180339887498949;  // golden ratio: spreads frequencies and phases evenly over joints
  constexpr double kMargin_rad = 0.03;
  const JointVector outward = outward_m_per_rad(robot);
  std::vector<Swing> all;
  for (int j = 0; j < robot.joint_index.size(); ++j) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(j)];
    const double largest_rad = kAmplitude_rad[0] + kAmplitude_rad[1] + kAmplitude_rad[2];
    const double room_rad = 0.5 * (joint.upper_rad - joint.lower_rad) - kMargin_rad;
    const double scale = std::min(1.0, room_rad / largest_rad);
    Swing swing;
    for (std::size_t i = 0; i < 3; ++i) {
      double share = kGolden * static_cast<double>(j + 1) + 0.37 * static_cast<double>(i);
      share -= std::floor(share);
      swing.amplitude_rad[i] = scale * kAmplitude_rad[i];
      swing.frequency_Hz[i] = kSlowest_Hz[i] + share * (kFastest_Hz[i] - kSlowest_Hz[i]);
      swing.phase_rad[i] = 2.0 * std::numbers::pi * (kGolden * static_cast<double>(7 * j) + share);
    }
    const double center_rad = joint.stand_rad + spread_rad(robot, outward, j);
    const double reach_rad = scale * largest_rad + kMargin_rad;
    swing.center_rad =
        std::clamp(center_rad, std::min(joint.lower_rad + reach_rad, 0.5 * (joint.lower_rad + joint.upper_rad)),
                   std::max(joint.upper_rad - reach_rad, 0.5 * (joint.lower_rad + joint.upper_rad)));
    all.push_back(swing);
  }
  return all;
}

}  // namespace

std::vector<model::JointCommand> hanging_excitation(const model::RobotModel& robot,
                                                    std::span<const std::string> own_gains) {
  constexpr double kStretch_s = 14.0, kRamp_s = 2.0;
  const std::vector<Swing> all = swings(robot);
  const model::JointCommand stand = robot_gains(robot);
  std::vector<model::JointCommand> commands;
  for (double t_s = 0.0; t_s < 3.0 * kStretch_s; t_s += model::kControlPeriod_s) {
    const auto stretch = static_cast<int>(t_s / kStretch_s);
    // Gains change over half a second, without a jerk.
    const double half = smooth(2.0 * (t_s - kStretch_s)) - smooth(2.0 * (t_s - 2.0 * kStretch_s));
    const double share = smooth(t_s / kRamp_s);
    model::JointCommand command = stand;
    command.kp *= 1.0 - 0.5 * half;
    command.kd *= 1.0 - 0.5 * half;
    for (int j = 0; j < command.q.size(); ++j) {
      const Swing& swing = all[static_cast<std::size_t>(j)];
      command.q[j] += share * (swing.at(t_s) - command.q[j]);
      if (stretch == 2) command.dq[j] = swing.speed_at(t_s);
    }
    for (const std::string& joint : own_gains) {
      const int j = robot.joint_index.at(joint);
      command.kp[j] = stand.kp[j];
      command.kd[j] = stand.kd[j];
      command.dq[j] = 0.0;
    }
    commands.push_back(command);
  }
  return commands;
}

namespace {

/// A posture on a smooth path without rests, and the time to reach it.
struct Waypoint {
  double pitch_rad, roll_rad, height_m, for_s;
};
constexpr std::array<Waypoint, 15> kWaypoints{{{0.0, 0.0, 0.0, 1.0},
                                               {0.0, 0.0, -0.15, 3.0},
                                               {0.0, 0.0, 0.0, 3.0},
                                               {0.35, 0.0, -0.02, 3.0},
                                               {-0.1, 0.0, -0.04, 3.0},
                                               {0.0, 0.2, -0.04, 3.0},
                                               {0.0, -0.2, -0.04, 4.0},
                                               {0.25, 0.15, -0.10, 4.0},
                                               {0.25, -0.15, -0.02, 4.0},
                                               {0.0, 0.0, -0.15, 3.0},
                                               {0.4, 0.0, -0.08, 3.0},
                                               {0.0, 0.2, -0.02, 3.0},
                                               {0.3, 0.0, -0.15, 3.0},
                                               {0.0, -0.2, -0.06, 3.0},
                                               {0.0, 0.0, -0.18, 3.0}}};
constexpr double kPush_rad = 0.33;  // 100 Nm of hips with 300 Nm/rad
constexpr double kPush_s = 0.8;     // 0.2 m/s: slower, MuJoCo's soft contacts only creep; faster, the feet hop
constexpr int kPushes = 3;

/// Turns the hips outwards, and the ankles so that the soles stay flat.
void push_apart(const model::RobotModel& robot, const JointVector& outward, double share, JointVector& q) {
  for (const Foot foot : {kLeft, kRight}) {
    int hip = -1;
    for (const int j : robot.leg_joints[foot]) {
      if (std::abs(robot.joints[static_cast<std::size_t>(j)].axis.x()) < 0.9) continue;
      if (hip < 0 || std::abs(outward[j]) > std::abs(outward[hip])) hip = j;
    }
    if (hip < 0 || outward[hip] == 0.0) continue;
    const int ankle = robot.leg_joints[foot].back();
    const double push_rad = std::copysign(kPush_rad * share, outward[hip]);
    q[hip] += push_rad;
    const auto axis_x = [&](int j) { return robot.joints[static_cast<std::size_t>(j)].axis.x(); };
    if (ankle != hip && std::abs(axis_x(ankle)) > 0.9) q[ankle] -= push_rad * axis_x(hip) / axis_x(ankle);
  }
}

}  // namespace

std::vector<model::JointCommand> standing_excitation(const model::RobotModel& robot, const ClipLibrary& clips) {
  std::array<PostureCurve, 3> curves;
  for (std::size_t i = 0; i < 3; ++i) curves[i] = PostureCurve(clips.posture[i], clips.q_stand);
  const JointVector outward = outward_m_per_rad(robot);
  const model::JointCommand stand = robot_gains(robot);
  std::vector<model::JointCommand> commands;
  const auto add = [&](double pitch_rad, double roll_rad, double height_m, double push) {
    model::JointCommand command = stand;
    JointVector offset = JointVector::Zero(command.q.size());
    curves[0].add(pitch_rad, offset);
    curves[1].add(roll_rad, offset);
    curves[2].add(height_m, offset);
    command.q += offset;
    push_apart(robot, outward, push, command.q);
    command.q = command.q.cwiseMax(robot.q_lower()).cwiseMin(robot.q_upper());
    commands.push_back(command);
  };
  Waypoint from{0.0, 0.0, 0.0, 0.0};
  for (const Waypoint& to : kWaypoints) {
    for (double t_s = 0.0; t_s < to.for_s; t_s += model::kControlPeriod_s) {
      const double s = smooth(t_s / to.for_s);
      add(from.pitch_rad + s * (to.pitch_rad - from.pitch_rad), from.roll_rad + s * (to.roll_rad - from.roll_rad),
          from.height_m + s * (to.height_m - from.height_m), 0.0);
    }
    from = to;
  }
  // apart, wait, together, wait
  for (double t_s = 0.0; t_s < 4.0 * kPush_s * kPushes; t_s += model::kControlPeriod_s) {
    const double phase = std::fmod(t_s / kPush_s, 4.0);
    add(from.pitch_rad, from.roll_rad, from.height_m, std::clamp(std::min(phase, 3.0 - phase), 0.0, 1.0));
  }
  return commands;
}

}  // namespace pmg::excitation
