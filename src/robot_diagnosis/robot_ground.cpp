#include "robot_diagnosis/robot_ground.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pmg::robot_diagnosis {

namespace {

/// Between the two soles. MuJoCo's soft contacts creep under a force that would hold on a real ground and have their
/// whole friction from some 0.1 m/s a foot on.
constexpr double kSlipping_m_s = 0.24, kSticking_m_s = 0.08;
constexpr double kOfSlipping = 0.75;  // quantile: soles that begin or end to slip, or hop, show less than what is there
constexpr double kLeastLoad = 0.25;   // of the weight on each foot
constexpr std::size_t kFewest = 8;    // samples

double ratio(const FootForce& foot) { return foot.tangential_N / foot.normal_N; }

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

}  // namespace

GroundFriction ground_friction(RobotEquations& equations, std::span<const RobotSample> samples, double weight_N) {
  std::vector<double> slipping, sticking;
  for (const RobotSample& sample : samples) {
    const PerFoot<FootForce> feet = equations.foot_forces(sample);
    const double sum_N = feet[kLeft].normal_N + feet[kRight].normal_N;
    if (std::min(feet[kLeft].normal_N, feet[kRight].normal_N) < kLeastLoad * weight_N || sum_N > 1.4 * weight_N)
      continue;
    // the foot that slips has the larger share: the other still holds
    const double larger = std::max(ratio(feet[kLeft]), ratio(feet[kRight]));
    const double speed_m_s = equations.foot_separation_speed_m_s(sample);
    if (speed_m_s > kSlipping_m_s) slipping.push_back(larger);
    if (speed_m_s < kSticking_m_s) sticking.push_back(larger);
  }
  GroundFriction ground;
  ground.slipping_samples = static_cast<int>(slipping.size());
  if (!sticking.empty()) ground.at_least = quantile(sticking, 0.99);
  if (slipping.size() < kFewest) return ground;
  ground.observable = true;
  ground.value = quantile(slipping, kOfSlipping);
  const double spread = 0.5 * (quantile(slipping, 0.84) - quantile(slipping, 0.16));
  constexpr double kSystematic = 0.03;  // of leg friction and gains within what is normal
  const double half =
      1.96 *
      std::hypot(spread / std::sqrt(static_cast<double>(slipping.size()) / static_cast<double>(kFewest)), kSystematic);
  ground.low = std::max(0.0, ground.value - half);
  ground.high = ground.value + half;
  return ground;
}

}  // namespace pmg::robot_diagnosis
