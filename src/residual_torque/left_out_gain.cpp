#include "residual_torque/left_out_gain.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::residual_torque {

LeftOutGain left_out_gain(const fitting::Blocks& blocks, const std::vector<fitting::Fold>& folds,
                          const fitting::HeldOut& without, const fitting::HeldOut& with) {
  const Eigen::VectorXd before = without.mean(), after = with.mean();
  const auto samples = Eigen::Map<const Eigen::VectorXd>(blocks.samples().data(), std::ssize(blocks.samples()));
  const Eigen::VectorXd better =
      (before.cwiseQuotient(samples.cwiseMax(1.0)).cwiseSqrt() - after.cwiseQuotient(samples.cwiseMax(1.0)).cwiseSqrt())
          .eval();
  const auto count = static_cast<double>(std::max<Eigen::Index>(1, better.size()));
  LeftOutGain gain;
  gain.error_rad = better.sum() / count;
  const double squares = (better.array() - gain.error_rad).square().sum();
  gain.deviations = gain.error_rad / std::max(1e-300, std::sqrt(squares / std::max(1.0, count - 1.0) / count));
  for (const fitting::Fold& fold : folds) {
    double sum = 0.0;
    for (const Eigen::Index b : fold.blocks) sum += better[b];
    if (sum > 0.0) gain.folds_won += 1.0 / static_cast<double>(folds.size());
  }
  return gain;
}

}  // namespace pmg::residual_torque
