#include "mocap/signals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pmg::mocap {
namespace {

/// The sample at any index, by point reflection at the ends.
template <typename T>
T reflected(const std::vector<T>& samples, std::ptrdiff_t i) {
  const auto last = static_cast<std::ptrdiff_t>(samples.size()) - 1;
  if (i < 0) return 2.0 * samples.front() - samples[static_cast<std::size_t>(std::min(-i, last))];
  if (i > last)
    return 2.0 * samples.back() - samples[static_cast<std::size_t>(std::max<std::ptrdiff_t>(2 * last - i, 0))];
  return samples[static_cast<std::size_t>(i)];
}

template <typename T>
std::vector<T> gaussian(const std::vector<T>& samples, double rate_hz, double sigma_s) {
  const double sigma = sigma_s * rate_hz;  // in samples
  const auto reach =
      std::min(static_cast<std::ptrdiff_t>(std::ceil(4.0 * sigma)), static_cast<std::ptrdiff_t>(samples.size()));
  std::vector<double> weights;
  double sum = 0.0;
  for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
    weights.push_back(sigma > 0.0 ? std::exp(-0.5 * std::pow(static_cast<double>(k) / sigma, 2)) : 1.0);
    sum += weights.back();
  }
  std::vector<T> result;
  result.reserve(samples.size());
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(samples.size()); ++i) {
    T value = 0.0 * samples.front();
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      value += weights[static_cast<std::size_t>(k + reach)] / sum * reflected(samples, i + k);
    }
    result.push_back(value);
  }
  return result;
}

}  // namespace

int finer_factor(double rate_hz, double wanted_hz) {
  constexpr double kMost = 20.0;
  return static_cast<int>(std::ceil(std::clamp(wanted_hz / rate_hz, 1.0, kMost)));
}

Positions finer(const Positions& samples, int factor) {
  if (factor <= 1 || samples.size() < 2) return samples;
  Positions result;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const auto n = static_cast<std::ptrdiff_t>(i);
    const Eigen::Vector3d a = reflected(samples, n - 1), d = reflected(samples, n + 2);
    const Eigen::Vector3d &b = samples[i], &c = samples[i + 1];
    for (int k = 0; k < factor; ++k) {
      const double t = static_cast<double>(k) / factor;
      result.emplace_back(b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a))));
    }
  }
  result.push_back(samples.back());
  return result;
}

Positions smoothed(const Positions& samples, double rate_hz, double sigma_s) {
  return gaussian(samples, rate_hz, sigma_s);
}
std::vector<double> smoothed(const std::vector<double>& samples, double rate_hz, double sigma_s) {
  return gaussian(samples, rate_hz, sigma_s);
}

Positions velocity(const Positions& samples, double rate_hz) {
  Positions result(samples.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, samples.size() - 1);
    if (after > before)
      result[i] = (samples[after] - samples[before]) * (rate_hz / static_cast<double>(after - before));
  }
  return result;
}

void unwrap(std::vector<double>& angles_rad) {
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    angles_rad[i] = angles_rad[i - 1] + std::remainder(angles_rad[i] - angles_rad[i - 1], 2.0 * std::numbers::pi);
  }
}

}  // namespace pmg::mocap
