// A recording as a BVH file: the joints hang on the hips, and each has its position in channels of its own.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "mocap_files/recording.hpp"

namespace pmg::mocap::test {

/// In centimetres, y up.
inline std::string bvh_of(const Recording& recording) {
  const std::vector<std::pair<KeyBody, std::string>> joints = {{KeyBody::neck, "Neck"},
                                                               {KeyBody::left_hip, "LeftUpLeg"},
                                                               {KeyBody::right_hip, "RightUpLeg"},
                                                               {KeyBody::left_knee, "LeftLeg"},
                                                               {KeyBody::right_knee, "RightLeg"},
                                                               {KeyBody::left_ankle, "LeftFoot"},
                                                               {KeyBody::right_ankle, "RightFoot"},
                                                               {KeyBody::left_toe, "LeftToeBase"},
                                                               {KeyBody::right_toe, "RightToeBase"}};
  const std::string channels = "{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n";
  std::string text = "HIERARCHY\nROOT Hips\n" + channels;
  for (const auto& [key, name] : joints) text += fmt::format("JOINT {}\n{}}}\n", name, channels);
  text += fmt::format("}}\nMOTION\nFrames: {}\nFrame Time: {:.9f}\n", recording.frames, 1.0 / recording.rate_hz);
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const auto add = [&text](const Eigen::Vector3d& m) {
      text += fmt::format("{:.5f} {:.5f} {:.5f} ", 100.0 * m.y(), 100.0 * m.z(), 100.0 * m.x());
    };
    const Eigen::Vector3d& root = recording.body(KeyBody::pelvis).position_m[f];
    add(root);
    for (const auto& [key, name] : joints) add(recording.body(key).position_m[f] - root);
    text += '\n';
  }
  return text;
}

}  // namespace pmg::mocap::test
