// Ordinary differential equations to a tolerance: Dormand and Prince's embedded Runge-Kutta pair of orders 5 and 4
// (1980) with the fourth-order dense output of Hairer, Norsett and Wanner (Solving Ordinary Differential Equations I,
// 1993, II.6), by which events within a step are located.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

namespace pmg::literature {

/// Steps so small that a millisecond takes more than kMostAttempts of them, or a state that is no number.
struct DoesNotConverge : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <std::size_t N>
class DormandPrince {
 public:
  using State = std::array<double, N>;

  explicit DormandPrince(double relative = 1e-8, double absolute = 1e-10) : relative_(relative), absolute_(absolute) {}

  /// (slope(state), state, duration, event(state)) => (time that has passed). Goes on until the duration has passed, or
  /// until event() has fallen from above 0 to 0; then state is the one at that time, to 1e-13 s. Throws
  /// DoesNotConverge.
  template <typename Slope, typename Event>
  double advance(const Slope& slope, State& state, double duration_s, const Event& event) {
    double passed_s = 0.0;
    State first = slope(state);
    double value = event(state);
    int attempts = 0;
    while (duration_s - passed_s > 1e-13) {
      double h = std::min(step_s_, duration_s - passed_s);
      const double error = attempt(slope, state, first, h);
      if ((!std::isfinite(error) && h <= kSmallest_s) || ++attempts > kMostAttempts) {
        step_s_ = kFirst_s;
        throw DoesNotConverge("the state is no number, or takes too many steps");
      }
      const double scale = std::clamp(0.9 * std::pow(std::max(error, 1e-10), -0.2), 0.2, 5.0);
      if (error > 1.0 && h > kSmallest_s) {
        step_s_ = h * scale;
        continue;
      }
      const double next_value = event(next_);
      if (value > 0.0 && next_value <= 0.0) {
        const double share = locate(event, value, next_value);
        state = between(share);
        return passed_s + share * h;
      }
      if (h == step_s_ || scale < 1.0) step_s_ = std::min(kLargest_s, h * scale);
      passed_s += h;
      state = next_;
      first = stages_[6];
      value = next_value;
    }
    return duration_s;
  }

 private:
  static constexpr double kSmallest_s = 1e-9, kFirst_s = 1e-4, kLargest_s = 0.01;
  static constexpr int kMostAttempts = 20000;

  static State sum(const State& at, double h, std::initializer_list<std::pair<double, const State*>> parts) {
    State to = at;
    for (const auto& [weight, part] : parts) {
      for (std::size_t i = 0; i < N; ++i) to[i] += h * weight * (*part)[i];
    }
    return to;
  }

  /// One step into next_; its error over the tolerance, infinite where the state is no number.
  template <typename Slope>
  double attempt(const Slope& slope, const State& from, const State& first, double h) {
    auto& [k1, k2, k3, k4, k5, k6, k7] = stages_;
    k1 = first;
    k2 = slope(sum(from, h, {{1.0 / 5.0, &k1}}));
    k3 = slope(sum(from, h, {{3.0 / 40.0, &k1}, {9.0 / 40.0, &k2}}));
    k4 = slope(sum(from, h, {{44.0 / 45.0, &k1}, {-56.0 / 15.0, &k2}, {32.0 / 9.0, &k3}}));
    k5 = slope(sum(
        from, h, {{19372.0 / 6561.0, &k1}, {-25360.0 / 2187.0, &k2}, {64448.0 / 6561.0, &k3}, {-212.0 / 729.0, &k4}}));
    k6 = slope(sum(from, h,
                   {{9017.0 / 3168.0, &k1},
                    {-355.0 / 33.0, &k2},
                    {46732.0 / 5247.0, &k3},
                    {49.0 / 176.0, &k4},
                    {-5103.0 / 18656.0, &k5}}));
    next_ = sum(from, h,
                {{35.0 / 384.0, &k1},
                 {500.0 / 1113.0, &k3},
                 {125.0 / 192.0, &k4},
                 {-2187.0 / 6784.0, &k5},
                 {11.0 / 84.0, &k6}});
    k7 = slope(next_);
    from_ = from;
    h_ = h;
    double error = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double off = h * (71.0 / 57600.0 * k1[i] - 71.0 / 16695.0 * k3[i] + 71.0 / 1920.0 * k4[i] -
                              17253.0 / 339200.0 * k5[i] + 22.0 / 525.0 * k6[i] - 1.0 / 40.0 * k7[i]);
      const double most = absolute_ + relative_ * std::max(std::abs(from[i]), std::abs(next_[i]));
      if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
      error = std::max(error, std::abs(off) / most);
    }
    return error;
  }

  /// The state at a share of the last step.
  State between(double share) const {
    const auto& [k1, k2, k3, k4, k5, k6, k7] = stages_;
    State at;
    for (std::size_t i = 0; i < N; ++i) {
      const double way = next_[i] - from_[i], bend = h_ * k1[i] - way;
      const double last = h_ * (-12715105075.0 / 11282082432.0 * k1[i] + 87487479700.0 / 32700410799.0 * k3[i] -
                                10690763975.0 / 1880347072.0 * k4[i] + 701980252875.0 / 199316789632.0 * k5[i] -
                                1453857185.0 / 822651844.0 * k6[i] + 69997945.0 / 29380423.0 * k7[i]);
      const double rest = 1.0 - share;
      at[i] = from_[i] + share * (way + rest * (bend + share * (way - h_ * k7[i] - bend + rest * last)));
    }
    return at;
  }

  /// The share of the last step at which the event happens: bisection and false position by turns.
  template <typename Event>
  double locate(const Event& event, double before, double after) const {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60 && (high - low) * h_ > 1e-13; ++i) {
      const double straight = low + (high - low) * before / (before - after);
      const double at = i % 2 == 0 ? std::clamp(straight, low, high) : 0.5 * (low + high);
      const double value = event(between(at));
      if (value > 0.0) {
        low = at;
        before = value;
      } else {
        high = at;
        after = value;
      }
    }
    return high;
  }

  double relative_, absolute_, step_s_ = kFirst_s, h_ = 0.0;
  State from_{}, next_{};
  std::array<State, 7> stages_{};
};

}  // namespace pmg::literature
