// A film of a library: the robot kinematically beside the stick figure of the person that each clip came from.
#pragma once

#include <filesystem>

#include "model/robot_model.hpp"
#include "retargeting/library_review.hpp"
#include "work/progress.hpp"

namespace pmg::library_film {

/// Each clip for `seconds_each` at the robot's pace, 25 pictures a second. The figure, its limbs scaled by leg length,
/// is carried along beside the robot and turns with it. Throws std::runtime_error without ffmpeg or OSMesa, or where
/// the film can't be written; work::Interrupted, after which the film ends early.
void write_film(const model::RobotModel& robot, const retargeting::LibraryReview& review,
                const std::filesystem::path& file, double seconds_each = 6.0, const work::Progress& progress = {});

}  // namespace pmg::library_film
