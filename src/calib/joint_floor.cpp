#include "calib/joint_floor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/noise_floor.hpp"

namespace pmg::calib {

namespace {

constexpr std::size_t kMostTold = 6;  // the others are in diagnosis.json

}  // namespace

JointFloor joint_floor(const bench::Bench& bench, const std::vector<SingleJoint>& fitted,
                       const bench::OddRunOptions& options) {
  const std::vector<bench::BenchRun> all = bench.read_runs(bench::RowFilter(""));
  std::vector<const bench::BenchRun*> runs;
  for (const bench::BenchRun& run : all) runs.push_back(&run);
  bench::NoiseFloor found = bench::noise_floor(runs, options);
  if (!found.pairs.empty()) {
    return {found.mean_absolute_rad, found.rms_rad, true,
            fmt::format("{} pairs of repeats, each about what both have in common; the median over conditions",
                        found.pairs.size()),
            std::move(found.odd_runs)};
  }
  double squares = 0.0;
  for (const SingleJoint& joint : fitted) squares += std::pow(bench::sensor_noise_rad(joint.run().recording), 2);
  const double rms_rad = std::sqrt(squares / static_cast<double>(fitted.size()));
  return {std::sqrt(2.0 / std::numbers::pi) * rms_rad, rms_rad, false,
          "nothing was repeated: the sensor's own noise, from sixth differences of its readings",
          std::move(found.odd_runs)};
}

void leave_out_odd_runs(JointFloor& floor, std::vector<SingleJoint>& fitted) {
  const auto left_out = [&](const SingleJoint& joint) {
    return std::any_of(floor.odd_runs.begin(), floor.odd_runs.end(),
                       [&](const bench::OddRun& odd) { return odd.left_out && odd.run == joint.run().file; });
  };
  if (std::all_of(fitted.begin(), fitted.end(), left_out)) {
    for (bench::OddRun& odd : floor.odd_runs) {
      if (odd.left_out) odd.why += "; it stays in the fit, which would have no run without it";
    }
    return;
  }
  std::vector<SingleJoint> kept;
  for (SingleJoint& joint : fitted) {
    if (!left_out(joint)) kept.push_back(std::move(joint));
  }
  fitted = std::move(kept);
}

JointFloor with_integration_error(JointFloor floor, double error_rms_rad) {
  if (!std::isfinite(error_rms_rad)) return floor;
  const double both_rad = std::hypot(floor.rms_rad, error_rms_rad);
  if (floor.rms_rad > 0.0)
    floor.mean_absolute_rad *= both_rad / floor.rms_rad;
  else
    floor.mean_absolute_rad = std::sqrt(2.0 / std::numbers::pi) * both_rad;
  floor.rms_rad = both_rad;
  return floor;
}

std::string odd_runs_text(const std::vector<bench::OddRun>& odd_runs) {
  if (odd_runs.empty()) return "";
  const auto left_out = std::count_if(odd_runs.begin(), odd_runs.end(), [](const auto& odd) { return odd.left_out; });
  std::string text = fmt::format("{} odd run{}, {} left out of fit and noise floor:", odd_runs.size(),
                                 odd_runs.size() == 1 ? "" : "s", left_out);
  for (std::size_t i = 0; i < std::min(odd_runs.size(), kMostTold); ++i)
    text += fmt::format("{} {} {}{}", i == 0 ? "" : ";", odd_runs[i].run, odd_runs[i].why,
                        odd_runs[i].left_out ? " (left out)" : "");
  if (odd_runs.size() > kMostTold) text += fmt::format("; and {} more in diagnosis.json", odd_runs.size() - kMostTold);
  return text + ". The score keeps all its runs";
}

}  // namespace pmg::calib
