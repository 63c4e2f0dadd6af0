#include "calib/joint_runs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace pmg::calib {

std::vector<SingleJoint> read_joints(const bench::Bench& bench, const std::string& filter, double step_s,
                                     const work::Progress& progress) {
  std::vector<SingleJoint> joints;
  for (bench::BenchRun& run : bench.read_runs(bench::RowFilter(filter), progress))
    joints.emplace_back(bench, std::move(run), step_s);
  return joints;
}

std::vector<SingleJoint> spread(const std::vector<SingleJoint>& runs, std::size_t most) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  if (runs.size() <= most) return runs;
  std::vector<bool> taken(runs.size(), false);
  std::vector<SingleJoint> found;
  for (double position = 0.5; found.size() < most; position = std::fmod(position + kGoldenRatio, 1.0)) {
    const auto index = static_cast<std::size_t>(position * static_cast<double>(runs.size()));
    if (!taken[index]) found.push_back(runs[index]);
    taken[index] = true;
  }
  return found;
}

void expect_apart(const std::vector<SingleJoint>& fitted, const std::vector<SingleJoint>& scored) {
  std::set<std::string> files;
  for (const SingleJoint& joint : fitted) files.insert(joint.run().file);
  for (const SingleJoint& joint : scored) {
    if (!files.contains(joint.run().file)) continue;
    throw std::invalid_argument(
        fmt::format("{} is both in --fit and in --score; expected different runs", joint.run().file));
  }
}

}  // namespace pmg::calib
