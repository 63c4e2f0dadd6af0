// Seeded draws that every machine makes alike.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace pmg::literature {

/// The standard fixes mt19937_64's numbers, not those of its distributions; these are our own.
class Draw {
 public:
  explicit Draw(std::uint64_t seed, std::uint64_t stream = 0) : engine_(seed * 1000003ULL + stream) {
    engine_.discard(16);
  }
  double uniform(double low, double high) { return low + (high - low) * share(); }
  /// Equally likely in every decade.
  double spread(double low, double high) { return low * std::pow(high / low, share()); }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - share()));
    return radius * std::cos(2.0 * std::numbers::pi * share());
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(share() * static_cast<double>(count)); }
  bool chance(double probability) { return share() < probability; }
  double sign() { return chance(0.5) ? 1.0 : -1.0; }
  template <typename T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
  }

 private:
  double share() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  std::mt19937_64 engine_;
};

}  // namespace pmg::literature
