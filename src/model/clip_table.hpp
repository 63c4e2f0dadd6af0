// The CSV of a clip: a header of column names, then rows of finite numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/config_error.hpp"
#include "model/joint_index.hpp"
#include "pmg/types.hpp"

namespace pmg::model {

struct ClipTable {
  std::filesystem::path file;
  std::vector<double> command;  ///< of the column `command`, one a row; empty without that column
  std::vector<JointVector> q;   ///< one a row, in the robot's joint order [rad]
  std::vector<int> line;        ///< of each row

  Place place(std::size_t row) const { return {file.string(), line[row]}; }
};

/// The columns are every joint by name and, where it is asked for, `command`, in any order. Throws ConfigError on
/// a missing, unknown or repeated column, a row of another length, and what isn't a finite number.
ClipTable read_clip_table(const std::filesystem::path& file, const JointIndex& joints, bool with_command);

/// The text that read_clip_table reads back to the same numbers. command: empty, or one a row.
std::string format_clip_table(const JointIndex& joints, const std::vector<double>& command,
                              const std::vector<JointVector>& q);

}  // namespace pmg::model
