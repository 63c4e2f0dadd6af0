// An ONNX policy's metadata (key "pmg_policy", JSON), checked against the robot that it shall drive.
#pragma once

#include <string>
#include <vector>

#include "model/robot_model.hpp"
#include "policy/golden_pairs.hpp"
#include "policy/policy.hpp"

namespace pmg::policy {

struct PolicyMetadata {
  std::string robot;
  Variant variant = Variant::kPmg;
  double action_scale = 0.0;  ///< q_des = q_ref + action_scale * action on the policy joints [rad]
  double action_limit = 0.0;  ///< the network's outputs are clamped to +- this
  DriveGains gains;
  double golden_tolerance = 0.0;
  std::vector<GoldenPair> golden;  ///< at least one
};

/// Parses and checks. clip_library_sha256: of the library that the generator plays. Throws std::invalid_argument with
/// the difference and the expected value: format, robot, variant, joints in and out, observation layout (term by term),
/// standing posture, gains, rate, clip library, golden pairs.
PolicyMetadata parse_policy_metadata(const std::string& json, const model::RobotModel& robot,
                                     const std::string& clip_library_sha256, double control_rate_Hz);

}  // namespace pmg::policy
