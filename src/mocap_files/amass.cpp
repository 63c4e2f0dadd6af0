#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "files/config_error.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/npz.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace {

struct SmplJoint {
  const char* name;
  int parent;
};
/// The body joints of SMPL, SMPL-H and SMPL-X, in the order of their parameters: M. Loper et al., "SMPL: A Skinned
/// Multi-Person Linear Model", ACM Trans. Graphics 34(6), 2015.
constexpr std::array<SmplJoint, 22> kSmplJoints = {
    {{"pelvis", -1},        {"left_hip", 0},        {"right_hip", 0},    {"spine1", 0},
     {"left_knee", 1},      {"right_knee", 2},      {"spine2", 3},       {"left_ankle", 4},
     {"right_ankle", 5},    {"spine3", 6},          {"left_foot", 7},    {"right_foot", 8},
     {"neck", 9},           {"left_collar", 9},     {"right_collar", 9}, {"head", 12},
     {"left_shoulder", 13}, {"right_shoulder", 14}, {"left_elbow", 16},  {"right_elbow", 17},
     {"left_wrist", 18},    {"right_wrist", 19}}};

/// Positions of the joints at rest [m], by the CSV's names: lines of joint,x,y,z; a first line without numbers is a
/// header; further joints (hands, face) are ignored.
std::array<Eigen::Vector3d, kSmplJoints.size()> smpl_rest(const std::string& file, const std::string& text) {
  std::array<Eigen::Vector3d, kSmplJoints.size()> rest;
  std::array<bool, kSmplJoints.size()> known{};
  int line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, stop - at);
    at = stop + 1;
    ++line_number;
    std::ranges::replace(line, ',', ' ');
    Words words(file, line);
    if (words.end()) continue;
    const std::string name(words.next("a joint"));
    Eigen::Vector3d position;
    int numbers = 0;
    for (double value = 0.0; numbers < 3 && !words.end() && to_number(words.peek(), value); ++numbers) {
      position[numbers] = value;
      words.next("");
    }
    if (numbers == 0 && line_number == 1) continue;
    if (numbers != 3 || !words.end()) files::raise({file, line_number}, "", "is no joint's line", "joint,x,y,z");
    for (std::size_t j = 0; j < rest.size(); ++j) {
      if (name != kSmplJoints[j].name) continue;
      rest[j] = position;
      known[j] = true;
    }
  }
  for (std::size_t j = 0; j < rest.size(); ++j) {
    if (!known[j]) files::raise({file}, kSmplJoints[j].name, "is missing", "a line for each of SMPL's 22 body joints");
  }
  return rest;
}

Eigen::Quaterniond smpl_rotation(const double* axis_angle) {
  const Eigen::Vector3d v(axis_angle[0], axis_angle[1], axis_angle[2]);
  const double angle = v.norm();
  return angle < 1e-12 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

const NpyArray& amass_array(const std::string& file, const std::map<std::string, NpyArray>& arrays,
                            const std::string& name, std::size_t columns) {
  constexpr double kLargest = 1e6;  // rad and m; squares of much larger ones overflow
  const auto found = arrays.find(name);
  if (found == arrays.end() || found->second.shape.size() != 2 || found->second.values.empty() ||
      found->second.shape[1] < columns) {
    files::raise({file}, name, "is missing or has another shape",
                 fmt::format("an array of numbers, one row a frame of {} columns or more", columns));
  }
  for (std::size_t i = 0; i < found->second.values.size(); ++i) {
    if (!(std::abs(found->second.values[i]) <= kLargest))  // nor NaN
      files::raise({file}, name, fmt::format("row {} is {}", i / found->second.shape[1], found->second.values[i]),
                   fmt::format("numbers within +-{:g}", kLargest));
  }
  return found->second;
}

}  // namespace

Motion parse_amass(const std::string& file, const std::string& bytes, const std::string& rest_pose_file,
                   const std::string& rest_pose) {
  const std::map<std::string, NpyArray> arrays = parse_npz(file, bytes);
  constexpr std::size_t kJoints = kSmplJoints.size();
  const NpyArray& poses = amass_array(file, arrays, "poses", 3 * kJoints);
  const NpyArray& trans = amass_array(file, arrays, "trans", 3);
  if (poses.shape[0] != trans.shape[0])
    files::raise({file}, "trans", fmt::format("has {} rows", trans.shape[0]),
                 fmt::format("{} as poses", poses.shape[0]));
  Motion motion;
  motion.format = "AMASS";
  motion.unit_m = 1.0;
  motion.unit_name = "m";
  motion.frames = poses.shape[0];
  for (const char* key : {"mocap_framerate", "mocap_frame_rate"}) {
    if (arrays.contains(key) && arrays.at(key).values.size() == 1) motion.rate_hz = arrays.at(key).values[0];
  }
  if (!motion.rate_hz || !(*motion.rate_hz > 0.1 && *motion.rate_hz < 1e5))
    files::raise({file}, "mocap_framerate", "is missing or out of range", "0.1 to 1e5 Hz");
  const bool whole = !rest_pose.empty();
  const std::size_t count = whole ? kJoints : 1;
  expect_bounded_samples(file + ": poses", motion.frames, kJoints);
  const auto rest = whole ? smpl_rest(rest_pose_file, rest_pose) : std::array<Eigen::Vector3d, kJoints>{};
  if (!whole)
    motion.notes.emplace_back("without a rest pose (--rest-pose) only the root is placed; the joints are angles alone");
  for (std::size_t j = 0; j < count; ++j) motion.points.push_back({kSmplJoints[j].name, kSmplJoints[j].parent, {}, {}});
  for (std::size_t j = 1; j < kJoints; ++j) {
    for (const char axis : {'x', 'y', 'z'}) motion.joints.push_back(fmt::format("{}.{}", kSmplJoints[j].name, axis));
  }
  for (std::size_t f = 0; f < motion.frames; ++f) {
    const double* row = &poses.values[f * poses.shape[1]];
    motion.joint_rad.emplace_back(row + 3, row + 3 * kJoints);
    const Eigen::Vector3d shift(trans.values[f * trans.shape[1]], trans.values[f * trans.shape[1] + 1],
                                trans.values[f * trans.shape[1] + 2]);
    for (std::size_t j = 0; j < count; ++j) {
      Point& joint = motion.points[j];
      const Eigen::Quaterniond local = smpl_rotation(row + 3 * j);
      if (joint.parent < 0) {
        joint.position.emplace_back(shift + (whole ? rest[0] : Eigen::Vector3d(Eigen::Vector3d::Zero())));
        joint.orientation.push_back(local);
      } else {
        const auto p = static_cast<std::size_t>(joint.parent);
        const Eigen::Quaterniond& turn = motion.points[p].orientation.back();
        joint.position.emplace_back(motion.points[p].position.back() + turn * (rest[j] - rest[p]));
        joint.orientation.push_back((turn * local).normalized());
      }
    }
  }
  return motion;
}

}  // namespace pmg::mocap
