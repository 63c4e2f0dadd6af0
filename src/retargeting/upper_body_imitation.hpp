// Waist, head and arms of a clip whose legs imitate a human.
#pragma once

#include "generator/joint_roles.hpp"
#include "pmg/types.hpp"
#include "retargeting/human_cycle.hpp"

namespace pmg::retargeting {

/// Sets waist, head and arms of q, the standing posture, for one sample of the cycle. The torso stays upright over a
/// pelvis of this roll, as generator and optimisation take it, and turns as the shoulders do, to whose mean the head
/// looks. Arms swing in the sagittal plane: shoulder pitch and elbow about their standing angles by the human's
/// deviations from its mean. Angles end at the joints' limits less margin_rad.
void imitate_upper_body(const model::RobotModel& robot, const generator::JointRoles& roles, const HumanCycle& cycle,
                        std::size_t sample, double pelvis_roll_rad, double margin_rad, JointVector& q);

}  // namespace pmg::retargeting
