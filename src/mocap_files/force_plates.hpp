// Force plates beside a recording: when each foot really carried.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "mocap_files/key_bodies.hpp"

namespace pmg::mocap {

/// A stretch in which a plate carries a foot. An end at which the plates' recording begins or ends is no event.
struct PlateContact {
  std::optional<double> contact_s, off_s;
};

struct ForcePlates {
  std::array<std::vector<PlateContact>, 2> contacts;  ///< by Side, in the order of time
  double from_s = 0.0, to_s = 0.0;                    ///< of the recording
};

/// More vertical force than this is contact: common in gait laboratories, 3 % of an adult's weight.
inline constexpr double kPlateContact_N = 20.0;

/// Reads an OpenSim table (.mot) with the columns time, ground_force_l_vy and ground_force_r_vy [s, N], on the
/// recording's clock. Throws files::ConfigError with file, line and what was expected.
ForcePlates read_force_plates(const std::filesystem::path& file);

}  // namespace pmg::mocap
