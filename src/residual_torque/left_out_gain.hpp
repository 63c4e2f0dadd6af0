// How much better a model predicts what was left out.
#pragma once

#include "fitting/folds.hpp"

namespace pmg::residual_torque {

/// A cause's gain is measured in logarithms, so that few blocks never decide a name. A residual torque names nothing;
/// it is to make the simulation's error smaller, and that error counts the blocks as they are.
struct LeftOutGain {
  double error_rad = 0.0;   ///< mean over blocks of the rms error without it less that with it
  double deviations = 0.0;  ///< the same over its standard error, blocks as observations
  double folds_won = 0.0;   ///< share of the folds whose blocks' mean is better with it
};

/// (blocks, folds, squares by block without it and with it, each by fits that leave the block's fold out) => (gain).
LeftOutGain left_out_gain(const fitting::Blocks& blocks, const std::vector<fitting::Fold>& folds,
                          const fitting::HeldOut& without, const fitting::HeldOut& with);

}  // namespace pmg::residual_torque
