#include "diagnosis/nested_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "calib/fit_problem.hpp"
#include "calib/parallel.hpp"

namespace pmg::diagnosis {

namespace {

constexpr double kRelativeTolerance = 1e-5;  // of the squares: well below what a fold can see
constexpr int kMostTries = 6;

double lower(const Unknown& u) { return u.logarithmic ? std::log(u.lower) : u.lower; }
double upper(const Unknown& u) { return u.logarithmic ? std::log(u.upper) : u.upper; }

}  // namespace

Eigen::VectorXd bounded_step(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                             const std::vector<Unknown>& unknowns, const Eigen::VectorXd& coordinates, double damping) {
  const Eigen::Index count = coordinates.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
  const double largest = information.diagonal().maxCoeff();
  std::vector<bool> held(static_cast<std::size_t>(count), false);
  // Whoever would leave its range stays at its edge, and the others make up for it.
  for (Eigen::Index round = 0; round <= count; ++round) {
    Eigen::MatrixXd a = information;
    Eigen::VectorXd b = -gradient;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (held[static_cast<std::size_t>(i)]) b -= information.col(i) * step[i];
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool unseen = !(information(i, i) > 1e-14 * largest);
      if (held[static_cast<std::size_t>(i)] || unseen) {
        a.row(i).setZero();
        a.col(i).setZero();
        a(i, i) = 1.0;
        b[i] = held[static_cast<std::size_t>(i)] ? step[i] : 0.0;
      } else {
        a(i, i) *= 1.0 + damping;
      }
    }
    const Eigen::VectorXd weight = a.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = weight.asDiagonal() * a * weight.asDiagonal();
    const Eigen::MatrixXd ridge = 1e-9 * Eigen::MatrixXd::Identity(count, count);
    const Eigen::VectorXd solved = weight.asDiagonal() * (scaled + ridge).ldlt().solve(weight.asDiagonal() * b);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!held[static_cast<std::size_t>(i)]) step[i] = solved[i];
    }
    // One at a time, whoever is furthest out: with it held, another may want to stay inside.
    Eigen::Index furthest = -1;
    double most = 1e-12;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Unknown& u = unknowns[static_cast<std::size_t>(i)];
      const double there = coordinates[i] + step[i], low = lower(u), high = upper(u);
      const double out = std::abs(there - std::clamp(there, low, high)) / (high - low);
      if (held[static_cast<std::size_t>(i)] || out <= most) continue;
      furthest = i;
      most = out;
    }
    if (furthest < 0) break;
    const Unknown& u = unknowns[static_cast<std::size_t>(furthest)];
    held[static_cast<std::size_t>(furthest)] = true;
    step[furthest] = std::clamp(coordinates[furthest] + step[furthest], lower(u), upper(u)) - coordinates[furthest];
  }
  return step;
}

calib::JointModel model_at(const NestedModel& model, const Eigen::VectorXd& coordinates) {
  calib::JointModel changed = model.model;
  for (std::size_t i = 0; i < model.unknowns.size(); ++i) {
    const Unknown& u = model.unknowns[i];
    calib::set(changed, u.name, u.value(coordinates[static_cast<Eigen::Index>(i)]));
  }
  return changed;
}

BlockNormal prior(const NestedModel& model) {
  const Eigen::Index count = model.coordinates.size();
  BlockNormal found{Eigen::MatrixXd::Zero(count, count), Eigen::VectorXd::Zero(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Unknown& u = model.unknowns[static_cast<std::size_t>(i)];
    if (!(u.deviation > 0.0)) continue;
    const double off = (model.coordinates[i] - u.expected) / u.deviation;
    found.information(i, i) = model.prior_weight / (u.deviation * u.deviation);
    found.gradient[i] = model.prior_weight * off / u.deviation;
    found.squares += model.prior_weight * off * off;
  }
  return found;
}

NestedFit::NestedFit(std::vector<calib::SingleJoint> runs, unsigned threads)
    : runs_(std::move(runs)), threads_(threads) {
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const bench::Recording& r = runs_[i].run().recording;
    std::vector<Eigen::Index> starts{0};
    double ends_s = r.t_s.front() + kBlock_s;
    for (std::size_t k = 0; k < r.t_s.size(); ++k) {
      samples_ += r.valid[k] ? 1.0 : 0.0;
      const bool room = r.t_s.back() - r.t_s[k] >= 0.5 * kBlock_s;  // no block of a few samples at the end
      if (r.t_s[k] < ends_s || !room) continue;
      starts.push_back(static_cast<Eigen::Index>(k));
      ends_s += kBlock_s;
    }
    starts.push_back(static_cast<Eigen::Index>(r.t_s.size()));
    run_of_block_.insert(run_of_block_.end(), starts.size() - 1, i);
    block_starts_.push_back(starts);
  }
}

Misses NestedFit::misses(const calib::JointModel& model) const {
  Misses found(runs_.size());
  ++evaluations_;
  try {
    calib::for_each_in_parallel(runs_.size(), threads_, [&](std::size_t i) {
      const bench::Recording& r = runs_[i].run().recording;
      const std::vector<double> reading = runs_[i].rollout(model);
      found[i].resize(static_cast<Eigen::Index>(reading.size()));
      for (std::size_t k = 0; k < reading.size(); ++k) {
        found[i][static_cast<Eigen::Index>(k)] = r.valid[k] ? reading[k] - r.q_rad[k] : 0.0;
      }
    });
  } catch (const std::invalid_argument&) {  // the actuator model refuses the combination
    return {};
  }
  return found;
}

double NestedFit::squares(const Misses& misses) const {
  if (misses.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Eigen::VectorXd& run : misses) sum += run.squaredNorm();
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

double BlockErrors::mean() const {
  return std::accumulate(absolutes.begin(), absolutes.end(), 0.0) /
         std::max(1.0, std::accumulate(samples.begin(), samples.end(), 0.0));
}

std::vector<double> NestedFit::samples_by_block() const {
  std::vector<double> found;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    for (std::size_t s = 0; s + 1 < block_starts_[i].size(); ++s) found.push_back(valid_samples(i, s));
  }
  return found;
}

Eigen::VectorXd NestedFit::squares_by_block(const Misses& misses) const {
  Eigen::VectorXd found(static_cast<Eigen::Index>(run_of_block_.size()));
  Eigen::Index block = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const auto& starts = block_starts_[i];
    for (std::size_t s = 0; s + 1 < starts.size(); ++s) {
      found[block++] = misses[i].segment(starts[s], starts[s + 1] - starts[s]).squaredNorm();
    }
  }
  return found;
}

BlockErrors NestedFit::absolutes_by_block(const Misses& misses) const {
  BlockErrors found{{}, samples_by_block()};
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const auto& starts = block_starts_[i];
    for (std::size_t s = 0; s + 1 < starts.size(); ++s) {
      found.absolutes.push_back(misses[i].segment(starts[s], starts[s + 1] - starts[s]).cwiseAbs().sum());
    }
  }
  return found;
}

double NestedFit::valid_samples(std::size_t run, std::size_t block) const {
  const std::vector<bool>& valid = runs_[run].run().recording.valid;
  const auto from = valid.begin() + block_starts_[run][block], to = valid.begin() + block_starts_[run][block + 1];
  return static_cast<double>(std::count(from, to, true));
}

/// To the side that has room.
Slopes NestedFit::slopes(const NestedModel& model, const Misses& misses, const Slopes* borrowed) const {
  const auto count = static_cast<Eigen::Index>(model.unknowns.size());
  Slopes found{model.unknowns, std::vector<Eigen::MatrixXd>(runs_.size())};
  for (std::size_t i = 0; i < runs_.size(); ++i) found.of_run[i].setZero(misses[i].size(), count);
  for (Eigen::Index d = 0; d < count; ++d) {
    const Unknown& u = model.unknowns[static_cast<std::size_t>(d)];
    if (borrowed != nullptr) {
      const auto there = std::find(borrowed->unknowns.begin(), borrowed->unknowns.end(), u);
      if (there != borrowed->unknowns.end()) {
        const Eigen::Index column = there - borrowed->unknowns.begin();
        for (std::size_t i = 0; i < runs_.size(); ++i) found.of_run[i].col(d) = borrowed->of_run[i].col(column);
        continue;
      }
    }
    Eigen::VectorXd moved = model.coordinates;
    double step = u.step();
    if (moved[d] + step > upper(u)) step = -step;
    if (moved[d] + step < lower(u)) step = 0.5 * (upper(u) - lower(u));
    moved[d] += step;
    const Misses there = this->misses(model_at(model, moved));
    if (there.empty()) continue;
    for (std::size_t i = 0; i < runs_.size(); ++i) found.of_run[i].col(d) = (there[i] - misses[i]) / step;
  }
  return found;
}

void NestedFit::linearise(NestedModel& model, const Slopes* borrowed) const {
  const Misses misses = this->misses(model.model);
  const Slopes slopes = this->slopes(model, misses, borrowed);
  model.blocks.clear();
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const auto& starts = block_starts_[i];
    for (std::size_t s = 0; s + 1 < starts.size(); ++s) {
      const Eigen::Index length = starts[s + 1] - starts[s];
      const auto slope = slopes.of_run[i].middleRows(starts[s], length);
      const auto miss = misses[i].segment(starts[s], length);
      model.blocks.push_back(
          {slope.transpose() * slope, slope.transpose() * miss, miss.squaredNorm(), valid_samples(i, s)});
    }
  }
}

NestedModel NestedFit::fit(const calib::JointModel& start, const std::vector<Unknown>& unknowns, int most_iterations,
                           const Slopes* borrowed, double prior_weight) const {
  const auto count = static_cast<Eigen::Index>(unknowns.size());
  NestedModel best{start, unknowns, Eigen::VectorXd(count), 0.0, {}, prior_weight};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Unknown& u = unknowns[static_cast<std::size_t>(i)];
    best.coordinates[i] = u.coordinate(calib::value(start, u.name));
  }
  best.model = model_at(best, best.coordinates);
  Misses misses = this->misses(best.model);
  best.squares = squares(misses);
  if (misses.empty() || unknowns.empty()) return best;
  double damping = 1e-3;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Slopes slopes = this->slopes(best, misses, borrowed);
    const BlockNormal known = prior(best);
    Eigen::MatrixXd information = known.information;
    Eigen::VectorXd gradient = known.gradient;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      information += slopes.of_run[i].transpose() * slopes.of_run[i];
      gradient += slopes.of_run[i].transpose() * misses[i];
    }
    const double before = best.squares + known.squares;
    double now = before;
    for (int attempt = 0; attempt < kMostTries; ++attempt) {
      NestedModel there = best;
      there.coordinates += bounded_step(information, gradient, unknowns, best.coordinates, damping);
      there.model = model_at(best, there.coordinates);
      Misses missed = this->misses(there.model);
      there.squares = squares(missed);
      const double then = there.squares + prior(there).squares;
      if (then < before) {
        best = there;
        now = then;
        misses = std::move(missed);
        damping = std::max(1e-6, 0.2 * damping);
        break;
      }
      damping *= 6.0;
    }
    if (before - now <= kRelativeTolerance * before) break;
  }
  return best;
}

}  // namespace pmg::diagnosis
