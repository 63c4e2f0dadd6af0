#include "robot_diagnosis/robot_ground.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fitting/statistics.hpp"

namespace pmg::robot_diagnosis {

namespace {

double ratio(const FootForce& foot) { return foot.tangential_N / foot.normal_N; }

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

}  // namespace

GroundFriction ground_friction(RobotEquations& equations, std::span<const RobotSample> samples, double weight_N,
                               const GroundOptions& options) {
  std::vector<double> slipping, sticking;
  for (const RobotSample& sample : samples) {
    const PerFoot<FootForce> feet = equations.foot_forces(sample);
    const double sum_N = feet[kLeft].normal_N + feet[kRight].normal_N;
    if (std::min(feet[kLeft].normal_N, feet[kRight].normal_N) < options.least_load * weight_N ||
        sum_N > options.most_weight * weight_N)
      continue;
    // The slipping foot has the larger ratio: the other one still sticks.
    const double larger = std::max(ratio(feet[kLeft]), ratio(feet[kRight]));
    const double speed_m_s = equations.foot_separation_speed_m_s(sample);
    if (speed_m_s > options.slipping_m_s) slipping.push_back(larger);
    if (speed_m_s < options.sticking_m_s) sticking.push_back(larger);
  }
  GroundFriction ground;
  ground.slipping_samples = static_cast<int>(slipping.size());
  if (!sticking.empty()) ground.at_least = quantile(sticking, options.quantile_of_sticking);
  if (static_cast<double>(slipping.size()) < options.fewest_samples) return ground;
  ground.observable = true;
  ground.value = quantile(slipping, options.quantile_of_slipping);
  const double spread = 0.5 * (quantile(slipping, 0.84) - quantile(slipping, 0.16));
  const double half =
      fitting::kNormal95 *
      std::hypot(spread / std::sqrt(static_cast<double>(slipping.size()) / options.fewest_samples), options.systematic);
  ground.low = std::max(0.0, ground.value - half);
  ground.high = ground.value + half;
  return ground;
}

}  // namespace pmg::robot_diagnosis
