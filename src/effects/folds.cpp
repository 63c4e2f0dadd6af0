#include "effects/folds.hpp"

#include <fmt/format.h>

#include <functional>
#include <map>

namespace pmg::effects {

namespace {

constexpr std::size_t kMostFolds = 8;  // of a kind; with more groups, several share a fold

}  // namespace

std::vector<fitting::Fold> folds(const NestedFit& fit) {
  const auto& run_of_block = fit.blocks().run_of_block();
  std::vector<fitting::Fold> found;
  const auto add = [&](const char* kind, const std::function<std::string(std::size_t block)>& group_of) {
    std::map<std::string, std::size_t> number;
    for (std::size_t b = 0; b < run_of_block.size(); ++b) number.emplace(group_of(b), number.size());
    if (number.size() < 2) return;
    const std::size_t count = std::min(number.size(), kMostFolds);
    std::vector<fitting::Fold> kind_of(count, fitting::Fold{kind, {}});
    for (std::size_t b = 0; b < run_of_block.size(); ++b) {
      kind_of[number.at(group_of(b)) % count].blocks.push_back(static_cast<Eigen::Index>(b));
    }
    found.insert(found.end(), kind_of.begin(), kind_of.end());
  };
  const auto run = [&](std::size_t b) -> const bench::BenchRun& { return fit.runs()[run_of_block[b]].run(); };
  add("gain", [&](std::size_t b) { return fmt::format("{} {}", run(b).kp, run(b).kd); });
  add("load", [&](std::size_t b) { return fmt::format("{} {}", run(b).load.inertia_kg_m2, run(b).load.gravity_Nm); });
  add("trajectory", [&](std::size_t b) { return run(b).trajectory; });
  if (!found.empty()) return found;
  std::map<std::size_t, std::size_t> blocks_of_run;
  for (const std::size_t r : run_of_block) ++blocks_of_run[r];
  std::map<std::size_t, std::size_t> seen;
  std::vector<std::size_t> stretch;
  for (const std::size_t r : run_of_block) stretch.push_back(4 * seen[r]++ / blocks_of_run[r]);
  add("time", [&](std::size_t b) { return fmt::format("{}", stretch[b]); });
  return found;
}

}  // namespace pmg::effects
