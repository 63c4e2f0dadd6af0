// One joint that rubs more than the robot's model says, and a diagnosis that names it and nothing else.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "robot_diagnosis/robot_diagnosis.hpp"
#include "robot_diagnosis/robot_report.hpp"
#include "sim/motor_file.hpp"

namespace pmg::robot_diagnosis {

inline sim::ActuatorsByJoint rubbing(const std::string& joint, double coulomb_Nm, double viscous_Nm_s_per_rad) {
  sim::ActuatorsByJoint motors;
  motors[joint].friction.coulomb_Nm = coulomb_Nm;
  motors[joint].friction.viscous_Nm_s_per_rad = viscous_Nm_s_per_rad;
  return motors;
}

/// Three times its own dry friction.
inline sim::ActuatorsByJoint rubbing_elbow() { return rubbing("left_elbow", 0.6, 0.1); }

inline void expect_only_friction(const RobotDiagnosis& found, const std::string& joint) {
  ASSERT_EQ(found.causes.size(), 1U) << robot_diagnosis_text(found);
  EXPECT_EQ(found.causes.front().effect, "coulomb");
  EXPECT_EQ(found.causes.front().place, joint);
}

/// And its dry friction beyond its own [Nm].
inline void expect_only_friction(const RobotDiagnosis& found, const std::string& joint, double beyond_Nm,
                                 double tolerance_Nm) {
  ASSERT_NO_FATAL_FAILURE(expect_only_friction(found, joint));
  EXPECT_NEAR(found.causes.front().parameters.front().estimate.value, beyond_Nm, tolerance_Nm);
}

}  // namespace pmg::robot_diagnosis
