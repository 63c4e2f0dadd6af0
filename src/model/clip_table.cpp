#include "model/clip_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

namespace pmg::model {
namespace {

constexpr int kCommandColumn = -1;

struct Cell {
  std::string_view text;
  int column = 1;  ///< of its first character, from 1
};

std::vector<Cell> split(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t start = 0;;) {
    const std::size_t comma = std::min(line.find(',', start), line.size());
    cells.push_back({line.substr(start, comma - start), static_cast<int>(start) + 1});
    if (comma == line.size()) return cells;
    start = comma + 1;
  }
}

/// What each column is: a joint's index, or kCommandColumn.
std::vector<int> read_header(const std::string& file, std::string_view line, const JointIndex& joints,
                             bool with_command) {
  std::vector<int> columns;
  for (const Cell& cell : split(line)) {
    const Place place{file, 1, cell.column};
    const std::string name(cell.text);
    const std::optional<int> joint = joints.find(name);
    const bool command = with_command && columns.empty() && name == "command";
    if (!joint && !command) {
      raise(place, name, "is an unknown column",
            columns.empty() && with_command ? "`command`" : "the name of one of the robot's joints");
    }
    const int what = command ? kCommandColumn : *joint;
    if (std::find(columns.begin(), columns.end(), what) != columns.end())
      raise(place, name, "is there twice", "it once");
    columns.push_back(what);
  }
  if (with_command && columns.front() != kCommandColumn)
    raise({file, 1, 1}, "command", "is missing", "it as the first column");
  for (int joint = 0; joint < joints.size(); ++joint) {
    if (std::find(columns.begin(), columns.end(), joint) == columns.end()) {
      raise({file, 1}, joints.name(joint), "is missing", "a column for every joint of the robot");
    }
  }
  return columns;
}

double read_number(const Place& place, const std::string& column, std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    raise(place, column, fmt::format("is '{}'", text), "a finite number");
  }
  return value;
}

}  // namespace

ClipTable read_clip_table(const std::filesystem::path& file, const JointIndex& joints, bool with_command) {
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line)) {
    raise({file.string()}, "", fmt::format("cannot be read ({})", errno != 0 ? std::strerror(errno) : "it is empty"),
          "a CSV file with a header");
  }
  const auto strip = [](std::string& text) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
  };
  strip(line);
  ClipTable table;
  table.file = file;
  const std::vector<int> columns = read_header(file.string(), line, joints, with_command);
  for (int number = 2; std::getline(stream, line); ++number) {
    strip(line);
    if (line.empty()) continue;
    const std::vector<Cell> cells = split(line);
    if (cells.size() != columns.size()) {
      raise({file.string(), number}, "", fmt::format("has {} columns", cells.size()),
            fmt::format("{}", columns.size()));
    }
    JointVector q(joints.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool command = columns[i] == kCommandColumn;
      const double value = read_number({file.string(), number, cells[i].column},
                                       command ? "command" : joints.name(columns[i]), cells[i].text);
      if (command) {
        table.command.push_back(value);
      } else {
        q[columns[i]] = value;
      }
    }
    table.q.push_back(q);
    table.line.push_back(number);
  }
  return table;
}

std::string format_clip_table(const JointIndex& joints, const std::vector<double>& command,
                              const std::vector<JointVector>& q) {
  std::string text = command.empty() ? "" : "command,";
  for (int joint = 0; joint < joints.size(); ++joint) {
    text += joints.name(joint);
    text += joint + 1 < joints.size() ? "," : "\n";
  }
  for (std::size_t row = 0; row < q.size(); ++row) {
    if (!command.empty()) text += fmt::format("{},", command[row]);
    for (int joint = 0; joint < joints.size(); ++joint) {
      text += fmt::format("{}{}", q[row][joint], joint + 1 < joints.size() ? "," : "\n");
    }
  }
  return text;
}

}  // namespace pmg::model
