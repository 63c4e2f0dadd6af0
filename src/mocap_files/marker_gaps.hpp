// Frames in which a marker was not seen.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace pmg::mocap {

/// Replaces positions that aren't finite: a straight line between the frames around a gap, the nearest seen position at
/// the ends. At least one position must be finite. A gap is reported in notes.
void fill_gaps(std::vector<Eigen::Vector3d>& positions, const std::string& name, double rate_hz,
               std::vector<std::string>& notes);

}  // namespace pmg::mocap
