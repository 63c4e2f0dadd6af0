#include "diagnosis/folds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>

namespace pmg::diagnosis {

namespace {

constexpr std::size_t kMostFolds = 8;  // of a kind; more groups are left out together
constexpr double kKept = 0.05;         // of a fold's weight

}  // namespace

std::vector<Fold> folds(const NestedFit& fit) {
  const auto& run_of_block = fit.run_of_block();
  std::vector<Fold> found;
  const auto add = [&](const char* kind, const std::function<std::string(std::size_t block)>& group_of) {
    std::map<std::string, std::size_t> number;
    for (std::size_t b = 0; b < run_of_block.size(); ++b) number.emplace(group_of(b), number.size());
    if (number.size() < 2) return;
    const std::size_t count = std::min(number.size(), kMostFolds);
    std::vector<Fold> kind_of(count, Fold{kind, {}});
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

std::vector<Eigen::VectorXd> steps_without(const NestedModel& model, const std::vector<Fold>& folds) {
  const Eigen::Index count = model.coordinates.size();
  if (count == 0) return std::vector<Eigen::VectorXd>(folds.size());
  BlockNormal all = prior(model);
  for (const BlockNormal& block : model.blocks) {
    all.information += block.information;
    all.gradient += block.gradient;
  }
  std::vector<Eigen::VectorXd> steps;
  for (const Fold& fold : folds) {
    Eigen::MatrixXd rest = all.information;
    Eigen::VectorXd slope = all.gradient;
    for (const Eigen::Index b : fold.blocks) {
      rest -= (1.0 - kKept) * model.blocks[static_cast<std::size_t>(b)].information;
      slope -= (1.0 - kKept) * model.blocks[static_cast<std::size_t>(b)].gradient;
    }
    steps.push_back(bounded_step(rest, slope, model.unknowns, model.coordinates, 1e-6));
  }
  return steps;
}

Eigen::VectorXd held_out_squares(const NestedFit& fit, const NestedModel& model, const std::vector<Fold>& folds) {
  const std::vector<Eigen::VectorXd> steps = steps_without(model, folds);
  Eigen::VectorXd at_all(static_cast<Eigen::Index>(model.blocks.size()));
  for (Eigen::Index b = 0; b < at_all.size(); ++b) at_all[b] = model.blocks[static_cast<std::size_t>(b)].squares;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(at_all.size());
  Eigen::VectorXd times = squares;
  for (std::size_t f = 0; f < folds.size(); ++f) {
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(at_all.size());
    for (const Eigen::Index b : folds[f].blocks) weight[b] = kKept;
    Eigen::VectorXd found = at_all;
    for (double share = 1.0; steps[f].size() > 0 && share > 0.05; share *= 0.3) {
      NestedModel there = model;
      there.coordinates += share * steps[f];
      const Misses misses = fit.misses(model_at(model, there.coordinates));
      if (misses.empty()) continue;
      const Eigen::VectorXd by_block = fit.squares_by_block(misses);
      const double change = weight.dot(by_block - at_all) + prior(there).squares - prior(model).squares;
      if (!(change < 0.0)) continue;  // also where the rollout diverged
      found = by_block;
      break;
    }
    for (const Eigen::Index b : folds[f].blocks) {
      squares[b] += found[b];
      times[b] += 1.0;
    }
  }
  return squares.cwiseQuotient(times.cwiseMax(1.0));
}

BlockComparison::BlockComparison(const NestedFit& fit, std::vector<Fold> folds, double floor_squares)
    : folds_(std::move(folds)), floor_squares_(floor_squares) {
  const std::vector<double> samples = fit.samples_by_block();
  samples_ = Eigen::Map<const Eigen::VectorXd>(samples.data(), static_cast<Eigen::Index>(samples.size()));
}

Eigen::VectorXd BlockComparison::logarithms(const Eigen::VectorXd& squares) const {
  return (squares.array() / samples_.array().max(1.0) + floor_squares_ + 1e-300).log();
}

double BlockComparison::score(const Eigen::VectorXd& squares) const { return logarithms(squares).mean(); }

Comparison BlockComparison::operator()(const Eigen::VectorXd& first, const Eigen::VectorXd& second) const {
  Comparison found;
  found.gain = (first - second).sum() / samples_.sum();
  const Eigen::VectorXd difference = logarithms(first) - logarithms(second);
  const auto count = static_cast<double>(difference.size());
  found.log_gain = difference.mean();
  found.usual_gain = std::exp(score(first)) - std::exp(score(second));
  const double variance = (difference.array() - found.log_gain).square().sum() / std::max(1.0, count - 1.0);
  found.deviations = found.log_gain / std::sqrt(variance / count + 1e-300);
  double won = 0.0;
  for (const Fold& fold : folds_) {
    double sum = 0.0;
    for (const Eigen::Index b : fold.blocks) sum += difference[b];
    won += sum > 0.0 ? 1.0 : 0.0;
  }
  found.folds_won = folds_.empty() ? 0.0 : won / static_cast<double>(folds_.size());
  return found;
}

}  // namespace pmg::diagnosis
