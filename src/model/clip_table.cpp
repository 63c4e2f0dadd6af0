#include "model/clip_table.hpp"

#include "files/number_table.hpp"

namespace pmg::model {
namespace {

constexpr const char* kCommandColumn = "command";

std::vector<std::string> clip_columns(const JointIndex& joints, bool with_command) {
  std::vector<std::string> names = joints.names();
  if (with_command) names.insert(names.begin(), kCommandColumn);
  return names;
}

}  // namespace

ClipTable read_clip_table(const std::filesystem::path& file, const JointIndex& joints, bool with_command) {
  const files::NumberTable numbers = files::read_number_table(
      file, clip_columns(joints, with_command),
      with_command ? "`command` and every joint of the robot" : "every joint of the robot, by its name");
  ClipTable table{numbers.file, {}, {}, numbers.line};
  for (const std::vector<double>& row : numbers.rows) {
    JointVector q(joints.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (const std::optional<int> joint = joints.find(numbers.columns[i])) {
        q[*joint] = row[i];
      } else {
        table.command.push_back(row[i]);
      }
    }
    table.q.push_back(q);
  }
  return table;
}

std::string format_clip_table(const JointIndex& joints, const std::vector<double>& command,
                              const std::vector<JointVector>& q) {
  std::vector<std::vector<double>> rows;
  for (std::size_t row = 0; row < q.size(); ++row) {
    rows.emplace_back(q[row].data(), q[row].data() + q[row].size());
    if (!command.empty()) rows.back().insert(rows.back().begin(), command[row]);
  }
  return files::format_number_table(clip_columns(joints, !command.empty()), rows);
}

}  // namespace pmg::model
