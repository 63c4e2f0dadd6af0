#include "fitting/blocks.hpp"

#include <algorithm>
#include <numeric>

namespace pmg::fitting {

double BlockSums::mean() const {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         std::max(1.0, std::accumulate(samples.begin(), samples.end(), 0.0));
}

void Blocks::add_run(const std::vector<double>& t_s, const std::vector<bool>& valid) {
  std::vector<Eigen::Index> starts{0};
  double ends_s = t_s.front() + kLength_s;
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    const bool room = t_s.back() - t_s[k] >= 0.5 * kLength_s;
    if (t_s[k] < ends_s || !room) continue;
    starts.push_back(static_cast<Eigen::Index>(k));
    ends_s += kLength_s;
  }
  starts.push_back(static_cast<Eigen::Index>(t_s.size()));
  for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
    samples_.push_back(static_cast<double>(std::count(valid.begin() + starts[b], valid.begin() + starts[b + 1], true)));
    all_samples_ += samples_.back();
    run_of_block_.push_back(starts_.size());
  }
  starts_.push_back(std::move(starts));
}

Eigen::VectorXd Blocks::squares(const Residuals& residuals) const {
  Eigen::VectorXd found(static_cast<Eigen::Index>(count()));
  Eigen::Index block = 0;
  for (std::size_t run = 0; run < starts_.size(); ++run) {
    const auto& starts = starts_[run];
    for (std::size_t b = 0; b + 1 < starts.size(); ++b)
      found[block++] = residuals[run].segment(starts[b], starts[b + 1] - starts[b]).squaredNorm();
  }
  return found;
}

BlockSums Blocks::absolutes(const Residuals& residuals) const {
  BlockSums found{{}, samples_};
  for (std::size_t run = 0; run < starts_.size(); ++run) {
    const auto& starts = starts_[run];
    for (std::size_t b = 0; b + 1 < starts.size(); ++b)
      found.values.push_back(residuals[run].segment(starts[b], starts[b + 1] - starts[b]).cwiseAbs().sum());
  }
  return found;
}

std::vector<NormalEquations> Blocks::normal_equations(const Residuals& residuals, const Jacobian& jacobian) const {
  std::vector<NormalEquations> found;
  for (std::size_t run = 0; run < starts_.size(); ++run) {
    const auto& starts = starts_[run];
    for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
      const Eigen::Index length = starts[b + 1] - starts[b];
      const auto slope = jacobian[run].middleRows(starts[b], length);
      const auto residual = residuals[run].segment(starts[b], length);
      found.push_back(
          {slope.transpose() * slope, slope.transpose() * residual, residual.squaredNorm(), samples_[found.size()]});
    }
  }
  return found;
}

}  // namespace pmg::fitting
