// The CSV of a clip: a header of column names, then rows of finite numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "files/config_error.hpp"
#include "model/joint_index.hpp"
#include "pmg/types.hpp"

namespace pmg::model {

struct ClipTable {
  std::filesystem::path file;
  std::vector<double> command;  ///< the column `command`, one per row; empty without that column
  std::vector<JointVector> q;   ///< one per row, in the robot's joint order [rad]
  std::vector<int> line;        ///< line number of each row

  files::Place place(std::size_t row) const { return {file.string(), line[row]}; }
};

/// The columns are every joint by name and, if with_command, `command`, in any order. Throws ConfigError on a missing,
/// unknown or repeated column, a row of another length, and a cell that isn't a finite number.
ClipTable read_clip_table(const std::filesystem::path& file, const JointIndex& joints, bool with_command);

/// The text from which read_clip_table reads the same numbers. command: empty, or one per row.
std::string format_clip_table(const JointIndex& joints, const std::vector<double>& command,
                              const std::vector<JointVector>& q);

}  // namespace pmg::model
