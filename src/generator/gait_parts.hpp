// Shared by all dynamic clips: the mixtures in which a clip must work, and the step from legs to a whole body.
#pragma once

#include <array>
#include <vector>

#include "generator/gait_optimization.hpp"
#include "generator/gait_task.hpp"
#include "generator/joint_roles.hpp"
#include "generator/upper_body.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"

namespace pmg::generator {

struct Making {
  const model::RobotModel& robot;
  JointRoles roles;
  RobotLegs legs;
  std::array<StaticClip, 3> posture;  ///< pitch, roll, height
};

/// A finished gait: its task and its result.
struct MadeGait {
  GaitTask task;
  LegTrajectory legs;
  UpperBody body;
};

/// A posture command as part of a mixture.
Addition posture_addition(const Making& making, Channel channel, double command);

/// A finished clip as part of a mixture whose cycle lasts period_s.
Addition clip_addition(const Making& making, const LegTrajectory& legs, const GaitTask& task, double gain,
                       double period_s);

/// The sum of both, sample by sample; a has kClipSamples entries, b those or one.
Addition together(Addition a, const Addition& b);

/// Gains from 0.12 to 1, and some with postures. posture_weight: weight of walking in a posture; plain walking has 1.
std::vector<Scenario> scenarios(const Making& making, double posture_weight);

/// (task, legs, upper body) => (clip).
DynamicClip assemble(const Making& making, const GaitTask& task, const LegTrajectory& legs, UpperBody body);

}  // namespace pmg::generator
