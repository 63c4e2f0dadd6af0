// A descriptor of test/data/policies/linear.onnx as if it came from another project: 264 numbers seen, 12 joints.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "policy/linear_policy.hpp"
#include "temporary_folder.hpp"

namespace pmg::test {

/// policies/foreign.yaml and its network in a folder of their own, for as long as this object lives.
class DescriptorFile {
 public:
  explicit DescriptorFile(const std::filesystem::path& folder = {}) {
    const std::filesystem::path place = folder.empty() ? own_.path() : folder;
    file_ = place / "foreign.yaml";
    std::filesystem::copy(kLinearPolicy, place / "foreign.onnx");
    save();
  }
  void exchange(const std::string& text, const std::string& instead) {
    const std::size_t at = text_.find(text);
    if (at == std::string::npos) throw std::invalid_argument(text);
    text_.replace(at, text.size(), instead);
    save();
  }
  void append(const std::string& lines) {
    text_ += lines;
    save();
  }
  const std::filesystem::path& file() const { return file_; }

 private:
  void save() const { std::ofstream(file_) << text_; }

  TemporaryFolder own_;
  std::filesystem::path file_;
  // Right legs first: another order than the robot's.
  std::string text_ = R"(format: 1
source: a test
network: foreign.onnx
input: observation
output: action
rate_Hz: 50
joints: [right_hip_pitch, right_hip_roll, right_hip_yaw, right_knee, right_ankle_pitch, right_ankle_roll, left_hip_pitch, left_hip_roll, left_hip_yaw, left_knee, left_ankle_pitch, left_ankle_roll]
default_rad: [-0.2, 0, 0, 0.4, -0.2, 0, -0.2, 0, 0, 0.4, -0.2, 0]
action_scale_rad: [0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5]
kp_Nm_per_rad: [101, 102, 103, 104, 105, 106, 107, 108, 109, 110, 111, 112]
kd_Nm_s_per_rad: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]
command: {vx_m_s: [-0.3, 0.6], vy_m_s: [-0.2, 0.2], omega_rad_s: [-3, 3]}
frames: by_term
first_frame: oldest
observation:
  - {term: gyro, scale: [0.2], history: 5}
  - {term: gravity_direction, scale: [1], history: 5}
  - {term: command, scale: [2, 2, 0.25], history: 5}
  - {term: joint_position, scale: [1], history: 5}
  - {term: joint_velocity, scale: [0.05], clip: 10, history: 5}
  - {term: last_action, scale: [1], history: 5}
  - {term: joint_position, scale: [1]}
  - {term: joint_velocity, scale: [1]}
  - {term: last_action, scale: [1]}
  - {term: command_linear, scale: [1]}
  - {term: command_angular, scale: [1]}
)";
};

}  // namespace pmg::test
