// A trained policy in ONNX Runtime: residual actions on the policy joints (paper III-B).
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "policy/policy.hpp"
#include "policy/policy_metadata.hpp"

namespace pmg::policy {

class OnnxPolicy final : public Policy {
 public:
  /// Loads the network, checks its metadata (policy_metadata.hpp) and shapes against the robot, and replays the golden
  /// pairs. Throws std::invalid_argument "FILE: what differs; expected what".
  OnnxPolicy(const std::filesystem::path& file, const model::RobotModel& robot, const std::string& clip_library_sha256,
             double control_rate_Hz = 100.0);
  ~OnnxPolicy() override;

  const PolicyMetadata& metadata() const;
  Variant variant() const override;
  std::optional<DriveGains> gains() const override;
  std::optional<double> action_bound_rad() const override;
  void reset() noexcept override;
  void unsent() noexcept override;  ///< the last action that the network sees is none

  /// One thread, no lock, inputs and outputs bound at construction. ONNX Runtime makes the same number of heap
  /// allocations in each call.
  Status act(const model::RobotState& state, const Reference& reference, const Command& observed,
             JointVector& q_des) noexcept override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::policy
