// Stick figures of people and robots over one cycle, by the same bodies: for pictures beside each other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "mocap_files/key_bodies.hpp"
#include "mocap_files/recording.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "retargeting/human_cycle.hpp"

namespace pmg::retargeting {

/// Where the key bodies are [m]: x forward and y to the left of the pelvis, in its heading frame averaged over the
/// cycle; z above the ground. Bodies that are not known are empty.
using Figure = std::array<std::optional<Eigen::Vector3d>, mocap::kKeyBodies>;

/// The pairs of bodies that a figure's lines join.
const std::vector<std::pair<mocap::KeyBody, mocap::KeyBody>>& figure_bones();

/// One per sample of the cycle, as recorded: neither closed at the seam nor levelled.
std::vector<Figure> figures_of(const mocap::Recording& recording, const HumanCycle& human);

/// One per sample of the clip, the torso upright and the lowest sole point on the ground. Heel and toe are the middles
/// of the sole's edges; the wrist is the end of the chain of links below the elbow.
std::vector<Figure> figures_of(const model::RobotModel& robot, const DynamicClip& clip);

}  // namespace pmg::retargeting
