#include "assembly/level_test.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fitting/covariance.hpp"
#include "fitting/f_distribution.hpp"

namespace pmg::assembly {

namespace {

constexpr std::size_t kFolds = 4;

/// Information and gradient of the last effect's levels, beyond all other unknowns.
struct BeyondOthers {
  Eigen::VectorXd eigenvalues, gradient;  ///< gradient in the eigenvectors' directions
};

BeyondOthers beyond_others(const LevelModel& model, double told_share) {
  const fitting::NormalEquations all = model.sum();
  const std::size_t last = model.effects().size() - 1;
  const Eigen::Index first = model.first_level(last), levels = std::ssize(model.effects()[last].grouping.levels);
  std::vector<Eigen::Index> of, other;
  for (Eigen::Index i = 0; i < model.unknowns(); ++i) (i >= first && i < first + levels ? of : other).push_back(i);
  const Eigen::MatrixXd mixed = all.information(other, of), inner = all.information(other, other);
  const Eigen::MatrixXd taken = fitting::solved(inner, mixed);
  const Eigen::MatrixXd information = all.information(of, of) - mixed.transpose() * taken;
  const Eigen::VectorXd gradient = all.gradient(of) - taken.transpose() * all.gradient(other);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (information + information.transpose()));
  const double least = told_share * all.information.diagonal().segment(first, levels).mean();
  BeyondOthers found;
  std::vector<Eigen::Index> told;
  for (Eigen::Index i = 0; i < levels; ++i) {
    if (solver.eigenvalues()[i] > least) told.push_back(i);
  }
  found.eigenvalues = solver.eigenvalues()(told);
  found.gradient = (solver.eigenvectors().transpose() * gradient)(told);
  return found;
}

/// phi: of runs, and no less than of blocks.
double unit_squares(const RunEquations& equations, const LevelModel& model, double& freedom) {
  const LevelEffect& effect = model.effects().back();
  const Eigen::VectorXd z = model.solution();
  const auto share = [&](const fitting::NormalEquations& part, std::size_t run) {
    const double slope = part.gradient[effect.column] + part.information.row(effect.column).dot(model.step_of(z, run));
    const double information = part.information(effect.column, effect.column);
    return information > fitting::kUnseen_rad2 ? slope * slope / information : 0.0;
  };
  double runs = 0.0, of_runs = 0.0, blocks = 0.0, of_blocks = 0.0;
  for (std::size_t r = 0; r < equations.runs(); ++r) {
    if (effect.grouping.level_of_run[r] < 0) continue;
    runs += 1.0;
    of_runs += share(equations.of_run[r], r);
  }
  for (std::size_t b = 0; b < equations.of_block.size(); ++b) {
    if (effect.grouping.level_of_run[equations.run_of_block[b]] < 0) continue;
    blocks += 1.0;
    of_blocks += share(equations.of_block[b], equations.run_of_block[b]);
  }
  const auto levels = static_cast<double>(effect.grouping.levels.size());
  freedom = runs - levels;
  if (freedom <= 0.0) return 0.0;
  return std::max(of_runs / freedom, of_blocks / std::max(1.0, blocks - levels));
}

/// tau of the largest marginal likelihood; 0 if none is better than no spread.
double most_likely_spread(const BeyondOthers& levels, double unit_squares) {
  const auto twice_log_likelihood = [&](double spread) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < levels.eigenvalues.size(); ++i) {
      const double information = levels.eigenvalues[i] / unit_squares, gradient = levels.gradient[i] / unit_squares;
      sum += gradient * gradient / (information + 1.0 / (spread * spread)) - std::log1p(spread * spread * information);
    }
    return sum;
  };
  // The unit is that in which the runs tell a level to one standard deviation.
  const double unit = std::sqrt(unit_squares / levels.eigenvalues.maxCoeff());
  constexpr double kFinest = 1e-2, kFactor = 1.02;
  constexpr int kSteps = 1000;  // up to 4e6 units
  double best = 0.0, most = 0.0, spread = kFinest * unit;
  for (int i = 0; i < kSteps; ++i, spread *= kFactor) {
    const double now = twice_log_likelihood(spread);
    if (now > most) most = now, best = spread;
  }
  return best;
}

LevelModel model_of(const RunEquations& equations, const TestedBeside& beside, const LevelEffect& candidate,
                    bool levels) {
  std::vector<LevelEffect> effects = beside.effects;
  if (levels) effects.push_back(candidate);
  LevelModel model(equations, std::move(effects));
  for (const Eigen::Index column : beside.held) model.hold(column);
  if (!beside.load_of_run.empty()) model.add_slope(candidate.column, beside.load_of_run);
  return model;
}

}  // namespace

LevelEvidence level_evidence(const RunEquations& equations, const TestedBeside& beside, const LevelEffect& candidate,
                             const AssemblyOptions& options) {
  LevelEvidence found;
  LevelEffect free = candidate;
  free.penalty = 0.0;
  const LevelModel model = model_of(equations, beside, free, true);
  found.unit_squares = unit_squares(equations, model, found.freedom);
  if (!(found.unit_squares > 0.0)) return found;
  const BeyondOthers levels = beyond_others(model, options.told_share);
  const auto rank = static_cast<double>(levels.eigenvalues.size());
  if (rank == 0.0) return found;
  found.ratio = levels.gradient.cwiseAbs2().cwiseQuotient(levels.eigenvalues).sum() / (rank * found.unit_squares);
  found.chance = fitting::f_tail(found.ratio, rank, found.freedom);
  found.spread = most_likely_spread(levels, found.unit_squares);
  return found;
}

double chance_without_a_run(const RunEquations& equations, const TestedBeside& beside, const LevelEffect& candidate,
                            const AssemblyOptions& options) {
  double largest = 0.0;
  for (std::size_t run = 0; run < equations.runs(); ++run) {
    if (candidate.grouping.level_of_run[run] < 0) continue;
    RunEquations others = equations;
    others.leave_out(run);
    LevelEffect of_others = candidate;
    of_others.grouping.level_of_run[run] = -1;
    largest = std::max(largest, level_evidence(others, beside, of_others, options).chance);
    if (largest > options.chance_without_a_run) break;
  }
  return largest;
}

std::vector<fitting::Fold> level_folds(const Grouping& grouping, const std::vector<std::size_t>& run_of_block) {
  std::vector<std::size_t> seen(grouping.levels.size(), 0), fold_of_run;
  for (const int level : grouping.level_of_run)
    fold_of_run.push_back(level < 0 ? 0 : seen[static_cast<std::size_t>(level)]++ % kFolds);
  std::vector<fitting::Fold> folds(kFolds, fitting::Fold{"run", {}});
  for (std::size_t b = 0; b < run_of_block.size(); ++b) {
    if (grouping.level_of_run[run_of_block[b]] >= 0)
      folds[fold_of_run[run_of_block[b]]].blocks.push_back(static_cast<Eigen::Index>(b));
  }
  std::erase_if(folds, [](const fitting::Fold& fold) { return fold.blocks.empty(); });
  return folds;
}

fitting::HeldOut level_held_out(const RunEquations& equations, const TestedBeside& beside, const LevelEffect& candidate,
                                bool levels, const std::vector<fitting::Fold>& folds) {
  const LevelModel model = model_of(equations, beside, candidate, levels);
  Eigen::VectorXd squares = model.squares(model.solution());
  for (const fitting::Fold& fold : folds) {
    std::vector<bool> left_out(equations.runs(), false);
    for (const Eigen::Index b : fold.blocks) left_out[equations.run_of_block[static_cast<std::size_t>(b)]] = true;
    const Eigen::VectorXd without = model.squares(model.solution(left_out));
    squares(fold.blocks) = without(fold.blocks);
  }
  return {squares};
}

}  // namespace pmg::assembly
