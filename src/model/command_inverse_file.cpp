#include "model/command_inverse_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "files/number_table.hpp"

namespace pmg::model {
namespace {

constexpr std::size_t kAxes = CommandInverse::kAxes.size();

/// Names of the columns: the commands, then the corrections.
std::vector<std::string> inverse_columns() {
  std::vector<std::string> names;
  for (const char* prefix : {"", "correction_"}) {
    for (const Channel channel : CommandInverse::kAxes) names.push_back(std::string(prefix) + kChannelNames[channel]);
  }
  return names;
}

/// For each of inverse_columns(), its position in the file.
std::array<std::size_t, 2 * kAxes> places(const files::NumberTable& table) {
  std::array<std::size_t, 2 * kAxes> place{};
  const std::vector<std::string> names = inverse_columns();
  for (std::size_t i = 0; i < names.size(); ++i) {
    place[i] = static_cast<std::size_t>(std::ranges::find(table.columns, names[i]) - table.columns.begin());
  }
  return place;
}

std::array<double, kAxes> node_at(const std::array<std::vector<double>, kAxes>& axis, std::size_t index) {
  std::array<double, kAxes> node{};
  for (std::size_t a = kAxes; a-- > 0;) {
    node[a] = axis[a][index % axis[a].size()];
    index /= axis[a].size();
  }
  return node;
}

}  // namespace

std::filesystem::path command_inverse_file(const std::filesystem::path& directory) { return directory / "inverse.csv"; }

CommandInverse read_command_inverse(const std::filesystem::path& directory) {
  const files::NumberTable table =
      files::read_number_table(command_inverse_file(directory), inverse_columns(),
                               "each of " + std::to_string(kAxes) + " commands and of their corrections");
  const auto place = places(table);
  std::array<std::vector<double>, kAxes> axis;
  for (std::size_t a = 0; a < kAxes; ++a) {
    for (const std::vector<double>& row : table.rows) axis[a].push_back(row[place[a]]);
    std::ranges::sort(axis[a]);
    axis[a].erase(std::ranges::unique(axis[a]).begin(), axis[a].end());
  }
  std::size_t nodes = 1;
  for (const std::vector<double>& values : axis) nodes = std::min(nodes * values.size(), table.rows.size() + 1);
  if (nodes != table.rows.size() || nodes == 0) {
    files::raise({table.file.string()}, "", fmt::format("has {} rows", table.rows.size()),
                 "one for every combination of its commands");
  }
  std::vector<CommandInverse::Node> correction(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto node = node_at(axis, i);
    for (std::size_t a = 0; a < kAxes; ++a) {
      if (table.rows[i][place[a]] != node[a]) {
        files::raise(table.place(i), inverse_columns()[a], fmt::format("is {}", table.rows[i][place[a]]),
                     fmt::format("{}: the full grid, sorted", node[a]));
      }
      correction[i][a] = table.rows[i][place[kAxes + a]];
    }
  }
  return {axis, correction};
}

void write_command_inverse(const std::filesystem::path& directory, const CommandInverse& inverse) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < inverse.correction().size(); ++i) {
    const auto node = node_at(inverse.axis(), i);
    std::vector<double>& row = rows.emplace_back(node.begin(), node.end());
    row.insert(row.end(), inverse.correction()[i].begin(), inverse.correction()[i].end());
  }
  const std::filesystem::path file = command_inverse_file(directory);
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream << files::format_number_table(inverse_columns(), rows);
  stream.close();
  if (!stream) files::raise({file.string()}, "", fmt::format("cannot be written ({})", std::strerror(errno)), "");
}

}  // namespace pmg::model
