// Something that happens once in a period, at steps of a simulation.
#pragma once

#include <algorithm>

namespace pmg::actuator {

/// Periods of a fraction of a step follow each other on average.
class Period {
 public:
  Period(double period_s, double step_s) : period_s_(period_s), step_s_(step_s) { restart(); }
  bool every_step() const noexcept { return period_s_ <= step_s_; }

  /// It is due in the next step.
  void restart() noexcept { since_s_ = period_s_ - step_s_; }

  /// Once a step: whether it is due in this one.
  bool due() noexcept {
    constexpr double kRounding_s = 1e-9;
    since_s_ += step_s_;
    if (since_s_ < period_s_ - kRounding_s) return false;
    since_s_ = std::min(since_s_ - period_s_, step_s_);
    return true;
  }

 private:
  double period_s_, step_s_;
  double since_s_ = 0.0;
};

}  // namespace pmg::actuator
