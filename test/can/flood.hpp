// A bus that says anything, and what may become of it: no motor is commanded beyond its limits.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "drives/message.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::test {

/// Any bytes, mostly 8 of them. Every second frame begins with first_byte: what makes it a message of a drive.
inline drives::Message any_frame(std::mt19937_64& random, std::uint32_t id, std::uint8_t first_byte) {
  drives::Message frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 256 : 8);
  for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random());
  if (random() % 2 == 0) frame.data[0] = first_byte;
  return frame;
}

/// What the drives act on lies within the joints' ranges, or at zero, and within their efforts.
inline void expect_within_limits(const model::JointCommand& acting, const model::RobotModel& robot) {
  constexpr double kRounding = 1e-9;
  for (int j = 0; j < acting.q.size(); ++j) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(j)];
    ASSERT_GE(acting.q[j], std::min(joint.lower_rad, 0.0) - kRounding) << joint.name;
    ASSERT_LE(acting.q[j], std::max(joint.upper_rad, 0.0) + kRounding) << joint.name;
    ASSERT_LE(std::abs(acting.tau_ff[j]), joint.effort_limit_Nm + kRounding) << joint.name;
  }
}

}  // namespace pmg::test
