#include "generator/gait_norms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <optional>

#include "files/csv_table.hpp"
#include "generator/published_gait.hpp"
#include "pmg/types.hpp"

namespace pmg::generator {

namespace {

constexpr std::size_t kFewestRows = 11;  // steps of 10 %

/// Degrees of the column whose name begins with `begin` and ends with _mean; between them a source may state its sign.
std::vector<double> means(const files::CsvTable& table, const std::string& begin) {
  for (const std::string& name : table.header) {
    if (name.starts_with(begin) && name.ends_with("_mean")) return table.numbers(name);
  }
  files::raise({table.file.string(), table.header_line}, begin + "..._mean", "is missing", "a column of that name");
}

/// rms of the column whose name begins with `begin` and ends with _sd; nothing without one.
std::optional<double> deviation(const files::CsvTable& table, const std::string& begin) {
  for (const std::string& name : table.header) {
    if (!name.starts_with(begin) || !name.ends_with("_sd")) continue;
    const std::vector<double> sd = table.numbers(name);
    return std::sqrt(std::inner_product(sd.begin(), sd.end(), sd.begin(), 0.0) / static_cast<double>(sd.size()));
  }
  return std::nullopt;
}

/// Linear interpolation of equal steps from 0 to 100 % of the cycle at kCyclePoints.
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
  const PublishedGait& gait = published_gait();
  GaitNorms norms{.source = "CGM2.3 adults at spontaneous speed (Leboeuf et al. 2019)",
                  .deg = {},
                  .pelvic_tilt_deg = std::vector(kCyclePoints, gait.pelvic_tilt_deg),
                  .deviation_deg = {gait.hip_deviation_deg, gait.knee_deviation_deg, gait.ankle_deviation_deg}};
  for (std::size_t k = 0; k < kCyclePoints; ++k) {
    const double phase = static_cast<double>(k) / kCyclePoints;
    norms.deg[kHip].push_back(gait.hip_flexion.at_rad(phase) / kRadPerDegree - gait.pelvic_tilt_deg);
    norms.deg[kKneeFlexion].push_back(gait.knee_flexion.at_rad(phase) / kRadPerDegree);
    norms.deg[kAnkle].push_back(gait.ankle_dorsiflexion.at_rad(phase) / kRadPerDegree);
  }
  return norms;
}

GaitNorms load_norms(const std::filesystem::path& file) {
  const files::CsvTable table = files::read_csv(file);
  if (table.rows.size() < kFewestRows) {
    files::raise({file.string()}, "", fmt::format("{} rows", table.rows.size()),
                 fmt::format("at least {}, from 0 to 100 % of the cycle", kFewestRows));
  }
  GaitNorms norms{.source = file.filename().string(),
                  .deg = {},
                  .pelvic_tilt_deg = resampled(means(table, "pelvis_tilt")),
                  .deviation_deg = built_in_norms().deviation_deg};
  norms.deg[kHip] = resampled(means(table, "hip_flexion"));
  norms.deg[kKneeFlexion] = resampled(means(table, "knee_flexion"));
  norms.deg[kAnkle] = resampled(means(table, "ankle_dorsiflexion"));
  constexpr std::array<const char*, kGaitJoints> kColumns = {"hip_flexion", "knee_flexion", "ankle_dorsiflexion"};
  for (std::size_t joint = 0; joint < kGaitJoints; ++joint)
    norms.deviation_deg[joint] = deviation(table, kColumns[joint]).value_or(norms.deviation_deg[joint]);
  for (std::size_t k = 0; k < kCyclePoints; ++k) norms.deg[kHip][k] -= norms.pelvic_tilt_deg[k];
  return norms;
}

GaitNorms norms_of(const std::filesystem::path& file) { return file.empty() ? built_in_norms() : load_norms(file); }

std::array<double, kGaitJoints> flexions_deg(const JointVector& q, const std::array<int, kLegJoints>& leg,
                                             double pelvis_pitch_rad) {
  return {(-q[leg[kHipPitch]] - pelvis_pitch_rad) / kRadPerDegree, q[leg[kKnee]] / kRadPerDegree,
          -q[leg[kAnklePitch]] / kRadPerDegree};
}

CurveAgreement agreement(const std::vector<double>& ours, const std::vector<double>& published) {
  const auto n = static_cast<Eigen::Index>(ours.size());
  const Eigen::Map<const Eigen::ArrayXd> a(ours.data(), n), b(published.data(), n);
  const Eigen::ArrayXd da = a - a.mean(), db = b - b.mean();
  return {.correlation = (da * db).sum() / std::sqrt(da.square().sum() * db.square().sum()),
          .rms_deg = std::sqrt((a - b).square().mean()),
          .shape_rms_deg = std::sqrt((da - db).square().mean())};
}

}  // namespace pmg::generator
