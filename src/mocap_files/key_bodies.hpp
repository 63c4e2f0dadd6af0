// The bodies of a human that gait and retargeting need, and the table of names under which motion files have them.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace pmg::mocap {

// NOLINTBEGIN(readability-identifier-naming): named as in config/mocap/names.yaml
/// Joint centres where a file has them; heel, toe and the iliac spines are points on the body.
enum class KeyBody : std::size_t {
  pelvis,
  neck,
  head,
  left_hip,
  right_hip,
  left_knee,
  right_knee,
  left_ankle,
  right_ankle,
  left_heel,
  right_heel,
  left_toe,
  right_toe,
  left_shoulder,
  right_shoulder,
  left_elbow,
  right_elbow,
  left_wrist,
  right_wrist,
  left_asis,
  right_asis,
  left_psis,
  right_psis,
  count
};
inline constexpr std::size_t kKeyBodies = static_cast<std::size_t>(KeyBody::count);
extern const std::array<const char*, kKeyBodies> kKeyBodyNames;  ///< as the enumerators

enum class Side : std::size_t { left, right };
// NOLINTEND(readability-identifier-naming)

/// The body of this side; body is one of the left.
constexpr KeyBody of_side(KeyBody left, Side side) {
  return static_cast<KeyBody>(static_cast<std::size_t>(left) + static_cast<std::size_t>(side));
}

/// For each key body the names that files use, the preferred first. A name "A + B" is the middle of the points A and B.
using NameTable = std::array<std::vector<std::string>, kKeyBodies>;

/// Reads the table: one key a body, a list of names each. Throws ConfigError.
NameTable read_name_table(const std::filesystem::path& file);

/// config/mocap/names.yaml, where files::config_file finds it. Throws ConfigError if it is nowhere.
std::filesystem::path default_name_table();

/// Names compare without case, blanks and punctuation, and without what stands before a colon: "mixamorig:LeftUpLeg" is
/// "left_up_leg".
std::string plain_name(const std::string& name);

}  // namespace pmg::mocap
