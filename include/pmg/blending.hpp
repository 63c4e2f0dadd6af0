// How much of each clip: the gains of the six directions, and the gait timing they give.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "pmg/clip.hpp"
#include "pmg/command.hpp"
#include "pmg/phase.hpp"

namespace pmg {

enum class Blend {
  kGain,   ///< g_i = n_i / max(1, sum n), q_d = sum g_i q_i + (1 - sum g_i) q_stand
  kPaper,  ///< the paper's w and alpha literally
};

/// Each velocity channel has a clip a sign: vx+, vx-, vy+, vy-, omega+, omega-.
inline constexpr std::size_t kDirections = 2 * kVelocityChannels;
constexpr std::size_t direction_of(std::size_t channel, bool negative) noexcept {
  return 2 * channel + (negative ? 1 : 0);
}

/// One value a direction.
template <typename T>
using PerDirection = std::array<T, kDirections>;

struct Mixture {
  PerDirection<double> gain{};    ///< g: q_d = sum g q(phi) + (1 - sum g) q_stand
  PerDirection<double> weight{};  ///< for T, mu and r; sums to 1, or all 0 for a zero command
  double gain_sum = 0.0;          ///< at most 1
  bool normalised = false;        ///< the amplitudes asked for were more than one whole gait
};

/// The gains of a velocity command. Either rule ends in the same form q_d = sum g q + (1 - sum g) q_stand:
///  kGain   n_i = |u_i| / u_max_i, g_i = n_i / max(1, sum n), weights g_i / sum g. Mixtures keep their amplitude.
///  kPaper  alpha_i = clip(|u_i| / u_max_i, 0, 1), w_i = |u_i| / (sum |u| + 1e-6), q_d = sum w_i (alpha_i q_i +
///          (1 - alpha_i) q_stand), hence g_i = w_i alpha_i. The weights sum to a little less than 1, and to 0 at rest,
///          where the paper's sum would be the zero posture: what is missing goes to q_stand. T, mu and r take w_i /
///          sum w for the same reason.
inline Mixture mix(Blend blend, const Command& command, const PerDirection<double>& scale) noexcept {
  constexpr double kEpsilon = 1e-6;  // the paper's, for numerical stability
  Mixture mixture;
  double amplitude_sum = 0.0, speed_sum = 0.0;
  PerDirection<double> amplitude{}, speed{};
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    if (command.u[channel] == 0.0) continue;
    const std::size_t d = direction_of(channel, command.u[channel] < 0.0);
    speed[d] = std::abs(command.u[channel]);
    amplitude[d] = speed[d] / scale[d];
    if (blend == Blend::kPaper) {
      mixture.normalised = mixture.normalised || amplitude[d] > 1.0;
      amplitude[d] = std::min(amplitude[d], 1.0);
    }
    amplitude_sum += amplitude[d];
    speed_sum += speed[d];
  }
  if (speed_sum == 0.0) return mixture;
  if (blend == Blend::kGain) mixture.normalised = amplitude_sum > 1.0;
  for (std::size_t d = 0; d < kDirections; ++d) {
    const bool paper = blend == Blend::kPaper;
    mixture.weight[d] = paper ? speed[d] / speed_sum : amplitude[d] / amplitude_sum;
    mixture.gain[d] = amplitude[d] * (paper ? speed[d] / (speed_sum + kEpsilon) : 1.0 / std::max(1.0, amplitude_sum));
    mixture.gain_sum += mixture.gain[d];
  }
  return mixture;
}

/// T, mu and r of one clip or of a mixture.
struct GaitTiming {
  double period_s = 1.0;
  PerFoot<double> contact_center{};
  PerFoot<double> duty_factor{1.0, 1.0};
};

/// The clips' timings and their weighted averages (paper III-A.2: r_d, mu_d, T_u). mu is averaged on the circle, as the
/// way from one clip's mu to the others'.
class GaitTimings {
 public:
  GaitTimings() = default;
  explicit GaitTimings(const PerDirection<std::optional<DynamicClip>>& clips) {
    for (std::size_t d = kDirections; d-- > 0;) {
      if (!clips[d]) continue;
      origin_ = {clips[d]->period_s, clips[d]->contact_center, clips[d]->duty_factor};  // ends as the first there is
    }
    for (std::size_t d = 0; d < kDirections; ++d) {
      if (!clips[d]) continue;
      from_origin_[d] = {clips[d]->period_s, {}, clips[d]->duty_factor};
      for (const Foot foot : {kLeft, kRight}) {
        from_origin_[d].contact_center[foot] =
            wrap_half_cycle(clips[d]->contact_center[foot] - origin_.contact_center[foot]);
      }
    }
  }

  /// Of the first clip there is: what a robot has that never walked.
  const GaitTiming& first() const noexcept { return origin_; }

  /// weight: sums to 1 over directions that have a clip.
  GaitTiming average(const PerDirection<double>& weight) const noexcept {
    GaitTiming mean{0.0, origin_.contact_center, {}};
    for (std::size_t d = 0; d < kDirections; ++d) {
      mean.period_s += weight[d] * from_origin_[d].period_s;
      for (const Foot foot : {kLeft, kRight}) {
        mean.contact_center[foot] += weight[d] * from_origin_[d].contact_center[foot];
        mean.duty_factor[foot] += weight[d] * from_origin_[d].duty_factor[foot];
      }
    }
    for (double& mu : mean.contact_center) mu = wrap_cycle(mu);
    return mean;
  }

 private:
  GaitTiming origin_;
  PerDirection<GaitTiming> from_origin_;  ///< contact centres as differences from origin_
};

}  // namespace pmg
