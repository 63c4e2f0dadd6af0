// What went in a while ago.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace pmg::actuator {

inline double between(double later, double earlier, double share) noexcept { return later + share * (earlier - later); }

/// By how much what comes out after a delay of so many steps changes with what goes in within the same step.
inline double share_within_step(double delay_steps) noexcept { return std::max(0.0, 1.0 - delay_steps); }

/// Interpolates linearly between two stored steps. The result is the mean of a held value over the step, and smooth in
/// the delay. T needs between(later, earlier, share).
template <typename T>
class DelayLine {
 public:
  static constexpr int kSteps = 512;  ///< the longest delay: 64 ms of the finest step, 0.125 ms

  /// As if this had come in at all times.
  void fill(const T& value) noexcept { past_.fill(value); }

  void push(const T& now) noexcept {
    newest_ = newest_ + 1 == kSize ? 0 : newest_ + 1;
    past_[static_cast<std::size_t>(newest_)] = now;
  }

  /// What came in so many steps before the newest; from 0 to kSteps.
  T at(double steps) const noexcept {
    const int whole = static_cast<int>(steps);
    int later = newest_ - whole;
    if (later < 0) later += kSize;
    const T& a = past_[static_cast<std::size_t>(later)];
    const T& b = past_[static_cast<std::size_t>(later == 0 ? kSize - 1 : later - 1)];
    return between(a, b, steps - whole);
  }

 private:
  static constexpr int kSize = kSteps + 2;
  std::array<T, kSize> past_{};
  int newest_ = 0;
};

}  // namespace pmg::actuator
