#include "assembly/level_model.hpp"

#include "fitting/covariance.hpp"

namespace pmg::assembly {

LevelModel::LevelModel(const RunEquations& equations, std::vector<LevelEffect> effects)
    : equations_(equations), effects_(std::move(effects)) {
  const auto columns = static_cast<Eigen::Index>(equations_.columns.size());
  count_ = columns;
  for (const LevelEffect& effect : effects_) {
    first_level_.push_back(count_);
    count_ += std::ssize(effect.grouping.levels);
  }
  for (std::size_t r = 0; r < equations_.runs(); ++r) {
    Eigen::MatrixXd map = Eigen::MatrixXd::Zero(columns, count_);
    map.leftCols(columns).setIdentity();
    for (std::size_t e = 0; e < effects_.size(); ++e) {
      const int level = effects_[e].grouping.level_of_run[r];
      if (level < 0) continue;
      map(effects_[e].column, first_level_[e] + level) = equations_.per_value(effects_[e].column);
    }
    maps_.push_back(std::move(map));
  }
  held_.assign(static_cast<std::size_t>(count_), false);
}

void LevelModel::add_slope(Eigen::Index column, const std::vector<double>& quantity_of_run) {
  for (std::size_t r = 0; r < maps_.size(); ++r) {
    maps_[r].conservativeResize(Eigen::NoChange, count_ + 1);
    maps_[r].col(count_).setZero();
    maps_[r](column, count_) = quantity_of_run[r] * equations_.per_value(column);
  }
  held_.push_back(false);
  ++count_;
}

void LevelModel::hold(Eigen::Index column) { held_[static_cast<std::size_t>(column)] = true; }

fitting::NormalEquations LevelModel::sum(const std::vector<bool>& left_out) const {
  fitting::NormalEquations all = fitting::NormalEquations::zero(count_);
  const Eigen::Index columns = equations_.prior.gradient.size();
  all.information.topLeftCorner(columns, columns) = equations_.prior.information;
  all.gradient.head(columns) = equations_.prior.gradient;
  for (std::size_t r = 0; r < maps_.size(); ++r) {
    if (!left_out.empty() && left_out[r]) continue;
    const fitting::NormalEquations& run = equations_.of_run[r];
    all.information += maps_[r].transpose() * run.information * maps_[r];
    all.gradient += maps_[r].transpose() * run.gradient;
    all.squares += run.squares;
    all.samples += run.samples;
  }
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    const Eigen::Index levels = std::ssize(effects_[e].grouping.levels);
    all.information.diagonal().segment(first_level_[e], levels).array() += effects_[e].penalty;
  }
  for (Eigen::Index i = 0; i < count_; ++i) {
    if (!held_[static_cast<std::size_t>(i)]) continue;
    all.information.row(i).setZero();
    all.information.col(i).setZero();
    all.gradient[i] = 0.0;
  }
  return all;
}

Eigen::VectorXd LevelModel::solution(const std::vector<bool>& left_out) const {
  const fitting::NormalEquations all = sum(left_out);
  return -fitting::solved(all.information, all.gradient);
}

Eigen::VectorXd LevelModel::squares(const Eigen::VectorXd& z) const {
  Eigen::VectorXd found(std::ssize(equations_.of_block));
  for (std::size_t b = 0; b < equations_.of_block.size(); ++b)
    found[static_cast<Eigen::Index>(b)] =
        std::max(0.0, equations_.of_block[b].squares_after(step_of(z, equations_.run_of_block[b])));
  return found;
}

}  // namespace pmg::assembly
