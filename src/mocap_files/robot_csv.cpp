#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "files/config_error.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace {

/// Columns of a row: the root's pose, and where the joints stand.
struct RobotColumns {
  std::array<std::size_t, 3> position{};
  std::array<std::size_t, 4> quaternion{};  ///< w, x, y, z
  std::vector<std::size_t> joints;
  std::vector<std::string> names;  ///< of the joints
  std::size_t count = 0;
};

std::vector<std::string_view> csv_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    std::string_view cell = line.substr(at, comma - at);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '"')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\r' || cell.back() == '"')) cell.remove_suffix(1);
    cells.push_back(cell);
    at = comma + 1;
  }
  return cells;
}

/// "root_pos_x", "base_x", "root_translateX" and "x" are the same column.
std::string root_column(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    if ((lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9')) plain += lower;
  }
  for (const std::string_view front : {"root", "base", "pelvis"}) {
    if (plain.starts_with(front)) plain = plain.substr(front.size());
  }
  for (const std::string_view front : {"translate", "position", "pos", "quaternion", "quat", "rot"}) {
    if (plain.starts_with(front)) return (front[0] == 'q' || front[0] == 'r' ? "q" : "") + plain.substr(front.size());
  }
  return plain;
}

RobotColumns named_columns(const files::Place& place, const std::vector<std::string_view>& header) {
  constexpr std::array<std::string_view, 7> kRoot = {"x", "y", "z", "qw", "qx", "qy", "qz"};
  RobotColumns columns;
  columns.count = header.size();
  std::array<bool, kRoot.size()> found{};
  for (std::size_t c = 0; c < header.size(); ++c) {
    const auto known = std::ranges::find(kRoot, root_column(header[c]));
    const auto k = static_cast<std::size_t>(known - kRoot.begin());
    if (known == kRoot.end()) {
      if (same_word(header[c], "time") || same_word(header[c], "frame") || same_word(header[c], "time_s")) continue;
      columns.joints.push_back(c);
      columns.names.emplace_back(header[c]);
      continue;
    }
    if (found[k])
      files::raise({place.file, place.line, static_cast<int>(c) + 1}, std::string(kRoot[k]), "is there twice",
                   "it once");
    found[k] = true;
    (k < 3 ? columns.position[k] : columns.quaternion[k - 3]) = c;
  }
  for (std::size_t k = 0; k < kRoot.size(); ++k) {
    if (!found[k])
      files::raise(place, std::string(kRoot[k]), "is missing",
                   "columns of the root's position x, y, z and quaternion qw, qx, qy, qz, then joints");
  }
  return columns;
}

RobotColumns plain_columns(const files::Place& place, std::size_t count) {
  if (count < 8)
    files::raise(place, "", fmt::format("has {} columns", count), "x, y, z, a quaternion and joints: 8 or more");
  RobotColumns columns;
  columns.count = count;
  columns.position = {0, 1, 2};
  columns.quaternion = {6, 3, 4, 5};  // x, y, z, w: decided later by the tilt
  for (std::size_t c = 7; c < count; ++c) {
    columns.joints.push_back(c);
    columns.names.push_back(fmt::format("joint {}", c - 6));
  }
  return columns;
}

/// The angle between the root's z axis and the vertical, mean over the frames.
double mean_tilt(const std::vector<std::vector<double>>& rows, const std::array<std::size_t, 4>& q) {
  double sum = 0.0;
  for (const std::vector<double>& row : rows) {
    const Eigen::Quaterniond turn(row[q[0]], row[q[1]], row[q[2]], row[q[3]]);
    sum += std::acos(std::clamp((turn.normalized() * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  }
  return sum / static_cast<double>(rows.size());
}

}  // namespace

Motion parse_robot_csv(const std::string& file, const std::string& text) {
  RobotColumns columns;
  std::vector<std::vector<double>> rows;
  bool header = false;
  int line_number = 0, first_line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, stop - at);
    at = stop + 1;
    ++line_number;
    const std::vector<std::string_view> cells = csv_cells(line);
    if (cells.size() == 1 && cells[0].empty()) continue;
    double ignored = 0.0;
    if (columns.count == 0) {
      header = std::ranges::none_of(cells, [&](std::string_view cell) { return to_number(cell, ignored); });
      columns = header ? named_columns({file, line_number}, cells) : plain_columns({file, line_number}, cells.size());
      first_line = line_number;
      if (header) continue;
    }
    expect_bounded_samples(fmt::format("{}:{}", file, line_number), rows.size() + 1, columns.count);
    if (cells.size() != columns.count)
      files::raise({file, line_number}, "", fmt::format("has {} columns", cells.size()),
                   fmt::format("{} as in line {}", columns.count, first_line));
    std::vector<double> row(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (!to_number(cells[c], row[c]))
        files::raise({file, line_number}, fmt::format("column {}", c + 1), fmt::format("is '{}'", shown_word(cells[c])),
                     "a finite number");
    }
    const auto& q = columns.quaternion;
    const double norm =
        std::sqrt(row[q[0]] * row[q[0]] + row[q[1]] * row[q[1]] + row[q[2]] * row[q[2]] + row[q[3]] * row[q[3]]);
    if (std::abs(norm - 1.0) > 0.01)
      files::raise({file, line_number}, "the root's quaternion", fmt::format("has the length {:.3g}", norm), "1");
    rows.push_back(std::move(row));
  }
  if (rows.empty()) files::raise({file, line_number + 1}, "", "has no frames", "a row for each frame");
  Motion motion;
  motion.format = "robot CSV";
  motion.unit_m = 1.0;
  motion.unit_name = "m";
  motion.frames = rows.size();
  motion.joints = columns.names;
  if (!header) {  // public data sets have either order; a robot is upright most of the time
    const std::array<std::size_t, 4> w_first = {3, 4, 5, 6};
    const bool w_last = mean_tilt(rows, columns.quaternion) <= mean_tilt(rows, w_first);
    if (!w_last) columns.quaternion = w_first;
    motion.notes.push_back(
        fmt::format("no header: columns are x, y, z, quaternion {} (the order with less tilt), joints",
                    w_last ? "x, y, z, w" : "w, x, y, z"));
  }
  Point root{"pelvis", -1, {}, {}};
  for (const std::vector<double>& row : rows) {
    const auto& q = columns.quaternion;
    root.position.emplace_back(row[columns.position[0]], row[columns.position[1]], row[columns.position[2]]);
    root.orientation.push_back(Eigen::Quaterniond(row[q[0]], row[q[1]], row[q[2]], row[q[3]]).normalized());
    std::vector<double>& joints = motion.joint_rad.emplace_back();
    for (const std::size_t c : columns.joints) joints.push_back(row[c]);
  }
  motion.points.push_back(std::move(root));
  return motion;
}

}  // namespace pmg::mocap
