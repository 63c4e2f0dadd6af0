// Extends a model that no effect mends by a residual torque, if that predicts recordings left out better.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evidence/verdict.hpp"
#include "residual_torque/left_out_gain.hpp"
#include "residual_torque/rollout_fit.hpp"
#include "work/progress.hpp"

namespace pmg::residual_torque {

/// What an extension starts from.
struct Unexplained {
  const bench::Bench& bench;
  const effects::NestedFit& fit;      ///< the runs of the search
  const effects::NestedFit& all;      ///< all fitted runs
  const effects::NestedModel& model;  ///< fitted to the runs of the search
  const fitting::HeldOut& held_out;   ///< its squares by block, by fits without the block's fold
  const effects::BenchScale& scale;
};

/// Held-out errors [rad; m on a linear axis] are the caller's to measure, on the runs that it judges by.
struct Extension {
  bool kept = false;
  std::string why_not;       ///< if it isn't kept
  calib::JointModel model;   ///< with the term where it is kept, else without
  model::ResidualTerm term;  ///< the best that was fitted
  LeftOutGain gain;          ///< on blocks left out, by gain, load and trajectory
  evidence::Interval held_out_before, held_out_after;
};

/// (unexplained model, options) => (extension). Costs a hundred to two hundred rollouts of every run.
Extension extend(const Unexplained& from, const Options& options, const work::Progress& progress = {});

}  // namespace pmg::residual_torque
