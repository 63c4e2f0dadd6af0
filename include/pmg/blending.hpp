// The gains of the clips for a command, and the gait timing of the mixture.
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

/// Each velocity channel has one clip per sign: vx+, vx-, vy+, vy-, omega+, omega-.
inline constexpr std::size_t kDirections = 2 * kVelocityChannels;
constexpr std::size_t direction_of(std::size_t channel, bool negative) noexcept {
  return 2 * channel + (negative ? 1 : 0);
}

/// One value per direction.
template <typename T>
using PerDirection = std::array<T, kDirections>;

/// A point of the normalised command box that can have a clip: -1, 0 or 1 for each of vx, vy and omega, not all 0.
struct Corner {
  std::array<int, kVelocityChannels> sign{};
  friend constexpr bool operator==(const Corner&, const Corner&) = default;
};

/// Six directions, twelve pairs and eight triples, in this sequence. The directions keep their own order, so a
/// direction has the same index as its corner.
inline constexpr std::size_t kCorners = 26;
inline constexpr std::array<Corner, kCorners> kCornerTable = [] {
  std::array<Corner, kCorners> table{};
  std::size_t next = 0;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    for (const int sign : {1, -1}) table[next++].sign[channel] = sign;
  }
  for (const int channels : {2, 3}) {
    for (const int x : {1, -1, 0}) {
      for (const int y : {1, -1, 0}) {
        for (const int w : {1, -1, 0}) {
          if (x * x + y * y + w * w == channels) table[next++].sign = {x, y, w};
        }
      }
    }
  }
  return table;
}();

/// (three signs, not all 0) => (index in kCornerTable).
constexpr std::size_t corner_of(const Corner& corner) noexcept {
  constexpr auto code = [](const Corner& c) {
    return static_cast<std::size_t>(9 * (c.sign[0] + 1) + 3 * (c.sign[1] + 1) + c.sign[2] + 1);
  };
  constexpr std::array<std::size_t, 27> index = [code] {
    std::array<std::size_t, 27> table{};
    for (std::size_t c = 0; c < kCorners; ++c) table[code(kCornerTable[c])] = c;
    return table;
  }();
  return index[code(corner)];
}

/// One value per corner.
template <typename T>
using PerCorner = std::array<T, kCorners>;

struct Mixture {
  /// All gains and weights of the rule's corners are 0.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): those behind them are never read, and zeroing costs time
  explicit Mixture(std::size_t corners) noexcept : size(corners) {
    std::fill_n(gain.begin(), size, 0.0);
    std::fill_n(weight.begin(), size, 0.0);
  }

  std::size_t size;          ///< corners that the rule uses; gains and weights behind them have no value
  PerCorner<double> gain;    ///< g: q_d = sum g q(phi) + (1 - sum g) q_stand
  PerCorner<double> weight;  ///< for T, mu and r; sums to 1, or all 0 for a zero command
  double gain_sum = 0.0;     ///< at most 1
  bool normalised = false;   ///< the command asks for more than the clips give together
};

/// kCorners: largest sum of the amplitudes n_i = |u_i| / u_max_i. 1.8 is two channels at 90 % of their ranges or three
/// at 60 %. A person's hips do not allow a full stride, sidestep and turn at once.
inline constexpr double kCornerReach = 1.8;

/// (command, u_max) => (gains, weights). Multilinear between rest (q_stand), the clips of single directions and those
/// of their combinations. With n_i in [0, 1] and the commanded channels C, the corner that uses the channels A has the
/// gain
///   prod over A of n_i * prod over C \ A of (1 - n_i).
/// This is a convex combination, as the paper's; one channel alone gives the paper's formula. Before, all amplitudes
/// are scaled by one factor until each is at most 1 and their sum at most kCornerReach, so the command keeps its
/// direction.
inline Mixture mix_corners(const Command& command, const PerDirection<double>& scale) noexcept {
  Mixture mixture(kCorners);
  std::array<double, kVelocityChannels> amplitude{};
  Corner sign;
  double sum = 0.0, largest = 0.0;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const double u = command.u[channel];
    if (u == 0.0) continue;
    sign.sign[channel] = u < 0.0 ? -1 : 1;
    amplitude[channel] = std::abs(u) / scale[direction_of(channel, u < 0.0)];
    sum += amplitude[channel];
    largest = std::max(largest, amplitude[channel]);
  }
  if (sum == 0.0) return mixture;
  const double excess = std::max(largest, sum / kCornerReach);
  mixture.normalised = excess > 1.0;
  if (mixture.normalised) {
    for (double& n : amplitude) n /= excess;
  }
  for (unsigned used = 1; used < (1U << kVelocityChannels); ++used) {
    Corner corner;
    double gain = 1.0;
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      const bool uses = ((used >> channel) & 1U) != 0;
      if (uses) corner.sign[channel] = sign.sign[channel];
      gain *= uses ? amplitude[channel] : 1.0 - amplitude[channel];
    }
    if (gain == 0.0) continue;
    mixture.gain[corner_of(corner)] = gain;
    mixture.gain_sum += gain;
  }
  for (std::size_t c = 0; c < kCorners; ++c) mixture.weight[c] = mixture.gain[c] / mixture.gain_sum;
  return mixture;
}

/// (rule, command, u_max) => (gains, weights) over the single directions:
///   kGain   n_i = |u_i| / u_max_i, g_i = n_i / max(1, sum n), weights g_i / sum g. Mixtures keep their amplitude.
///   kPaper  alpha_i = clip(|u_i| / u_max_i, 0, 1) (eq. 4), w_i = |u_i| / (sum |u| + 1e-6) (eq. 6), and with eq. 5 in
///           eq. 7: q_d = sum w_i (alpha_i q_i + (1 - alpha_i) q_stand), so g_i = w_i alpha_i. The paper's weights sum
///           to a little less than 1, and to 0 at rest, where its q_d is the zero posture. Here the missing share goes
///           to q_stand. T, mu and r use w_i / sum w for the same reason.
inline Mixture mix_directions(Blend blend, const Command& command, const PerDirection<double>& scale) noexcept {
  constexpr double kEpsilon = 1e-6;  // the paper's epsilon (eq. 6), for which it gives no value
  Mixture mixture(kDirections);
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
  const bool paper = blend == Blend::kPaper;
  const double whole = 1.0 / std::max(1.0, amplitude_sum);
  for (std::size_t d = 0; d < kDirections; ++d) {
    if (speed[d] == 0.0) continue;
    mixture.weight[d] = paper ? speed[d] / speed_sum : amplitude[d] / amplitude_sum;
    mixture.gain[d] = amplitude[d] * (paper ? speed[d] / (speed_sum + kEpsilon) : whole);
    mixture.gain_sum += mixture.gain[d];
  }
  return mixture;
}

/// (rule, command, u_max) => (gains, weights). Every rule gives q_d = sum g_i q_i + (1 - sum g_i) q_stand.
inline Mixture mix(Blend blend, const Command& command, const PerDirection<double>& scale) noexcept {
  return blend == Blend::kCorners ? mix_corners(command, scale) : mix_directions(blend, command, scale);
}

/// T, mu and r of one clip or of a mixture.
struct GaitTiming {
  double period_s = 1.0;
  PerFoot<double> contact_center{};
  PerFoot<double> duty_factor{1.0, 1.0};
};

/// The clips' timings and their weighted averages (paper eq. 8, 9 and 12). mu is averaged on the circle, as differences
/// from one clip's mu.
class GaitTimings {
 public:
  GaitTimings() = default;
  explicit GaitTimings(const PerCorner<std::optional<DynamicClip>>& clips) {
    for (std::size_t d = kCorners; d-- > 0;) {
      if (!clips[d]) continue;
      origin_ = {clips[d]->period_s, clips[d]->contact_center, clips[d]->duty_factor};  // ends as the first clip's
    }
    for (std::size_t d = 0; d < kCorners; ++d) {
      if (!clips[d]) continue;
      from_origin_[d] = {clips[d]->period_s, {}, clips[d]->duty_factor};
      for (const Foot foot : {kLeft, kRight}) {
        from_origin_[d].contact_center[foot] =
            wrap_half_cycle(clips[d]->contact_center[foot] - origin_.contact_center[foot]);
      }
    }
  }

  /// Timing of the first clip; in force until the robot first walks.
  const GaitTiming& first() const noexcept { return origin_; }

  /// (weights) => (T, mu, r) = sum of weight * the clip's value. The weights sum to 1 over corners that have a clip.
  GaitTiming average(const PerCorner<double>& weight, std::size_t size = kCorners) const noexcept {
    GaitTiming mean{0.0, origin_.contact_center, {}};
    for (std::size_t d = 0; d < size; ++d) {
      if (weight[d] == 0.0) continue;
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
  PerCorner<GaitTiming> from_origin_;  ///< contact centres as differences from origin_
};

}  // namespace pmg
