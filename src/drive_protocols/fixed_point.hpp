// A number in a few bits of a frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pmg::drives {

/// A field of 1 to 16 bits that covers [lower, upper] in equal steps:
///   value(code) = lower + code (upper - lower) / (2^bits - 1).
class FixedPoint {
 public:
  constexpr FixedPoint(double lower, double upper, int bits) noexcept
      : lower_(lower), span_(upper - lower), most_code_((1U << static_cast<unsigned>(bits)) - 1U) {}

  constexpr double value(std::uint32_t code) const noexcept { return lower_ + code * span_ / most_code_; }
  constexpr double step() const noexcept { return span_ / most_code_; }
  constexpr std::uint32_t most_code() const noexcept { return most_code_; }

  /// The code nearest to value (halves go up) among those whose value lies within [least, most]; if the field's step
  /// leaves no such code, the nearest to the middle of [least, most]. Not a number counts as the middle.
  std::uint32_t code(double value, double least, double most) const noexcept {
    // A bound that is a step's value may come out one rounding error beside it.
    const double first = clamped(std::ceil(position(least) - kRounding)),
                 last = clamped(std::floor(position(most) + kRounding));
    const double middle = clamped(std::floor(position(0.5 * (least + most)) + 0.5));
    if (!(first <= last) || std::isnan(value)) return static_cast<std::uint32_t>(middle);
    return static_cast<std::uint32_t>(std::clamp(std::floor(position(value) + 0.5), first, last));
  }

 private:
  static constexpr double kRounding = 1e-9;  // of a step; a position has 16 bits of a double's 52
  double position(double value) const noexcept { return (value - lower_) / span_ * most_code_; }
  double clamped(double position) const noexcept {
    return std::isnan(position) ? 0.0 : std::clamp(position, 0.0, static_cast<double>(most_code_));
  }

  double lower_, span_;
  std::uint32_t most_code_;
};

}  // namespace pmg::drives
