#include "evaluation/gait_norms.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>

#include "generator/published_gait.hpp"
#include "model/config_error.hpp"

namespace pmg::evaluation {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

std::size_t column(const std::filesystem::path& file, const std::vector<std::string>& header,
                   const std::string& begin) {
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i].starts_with(begin) && header[i].ends_with("_mean")) return i;
  }
  throw model::ConfigError(fmt::format("{}: no column {}..._mean in the header", file.string(), begin));
}

/// Equal steps from 0 to 100 % of the cycle, linearly onto kCyclePoints.
std::vector<double> resampled(const std::vector<double>& values) {
  std::vector<double> out(kCyclePoints);
  for (std::size_t k = 0; k < kCyclePoints; ++k) {
    const double at = static_cast<double>(k) / kCyclePoints * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    out[k] = std::lerp(values[below], values[below + 1], at - static_cast<double>(below));
  }
  return out;
}

}  // namespace

GaitNorms built_in_norms() {
  const generator::PublishedGait& gait = generator::published_gait();
  GaitNorms norms{.source = "CGM2.3 adults at spontaneous speed (Leboeuf et al. 2019)", .deg = {}};
  for (std::size_t k = 0; k < kCyclePoints; ++k) {
    const double phase = static_cast<double>(k) / kCyclePoints;
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    norms.deg[kHip].push_back(kDegrees * gait.hip_flexion.at_rad(phase) - gait.pelvic_tilt_deg);
    norms.deg[kKneeFlexion].push_back(kDegrees * gait.knee_flexion.at_rad(phase));
    norms.deg[kAnkle].push_back(kDegrees * gait.ankle_dorsiflexion.at_rad(phase));
  }
  return norms;
}

GaitNorms load_norms(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw model::ConfigError(file.string() + ": can't be read");
  std::array<std::size_t, 4> columns{};  // hip, knee, ankle, pelvic tilt
  std::array<std::vector<double>, 4> values;
  bool header_seen = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> cells = split(line);
    if (!header_seen) {
      columns = {column(file, cells, "hip_flexion"), column(file, cells, "knee_flexion"),
                 column(file, cells, "ankle_dorsiflexion"), column(file, cells, "pelvis_tilt")};
      header_seen = true;
      continue;
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      double value = 0.0;
      const std::string cell = columns[c] < cells.size() ? cells[columns[c]] : "";
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value)) {
        throw model::ConfigError(
            fmt::format("{}:{}: \"{}\" in column {}; expected a number", file.string(), number, cell, columns[c] + 1));
      }
      values[c].push_back(value);
    }
  }
  if (values[0].size() < 11) {
    throw model::ConfigError(fmt::format("{}: {} rows; expected at least 11, from 0 to 100 % of the cycle",
                                         file.string(), values[0].size()));
  }
  GaitNorms norms{.source = file.filename().string(), .deg = {}};
  for (std::size_t joint = 0; joint < kGaitJoints; ++joint) norms.deg[joint] = resampled(values[joint]);
  const std::vector<double> tilt = resampled(values[3]);
  for (std::size_t k = 0; k < kCyclePoints; ++k) norms.deg[kHip][k] -= tilt[k];
  return norms;
}

}  // namespace pmg::evaluation
