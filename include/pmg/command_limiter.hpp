// Range and rate limits of the user's command. In double support the velocities change slowly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "pmg/command.hpp"

namespace pmg {

/// Clamps a command to its range and limits its rate of change, channel by channel.
///
/// The distance between the feet scales with the gains. So a gain that changes in double support makes the feet slide
/// against each other. Velocity channels therefore change at their full rate in single support, and at a fraction of it
/// in double support. A stop does not wait: once all three velocities are commanded to zero, each of them reaches zero
/// within stop_within_s.
///
/// A command that flickers must not make the rate flicker: the joints' reference speeds, and with them the velocity
/// that the reference realises on the ground, follow the rate and not the command. So a change in one direction takes
/// away the rate in the other direction, which grows back from zero to its limit within turn_s. A command that rests
/// before it turns keeps its full rate.
class CommandLimiter {
 public:
  CommandLimiter() = default;
  /// turn_s: 0 gives the rate in the other direction back at once.
  CommandLimiter(const CommandLimits& limits, double double_support_rate, double stop_within_s, double turn_s)
      : limits_(limits),
        double_support_rate_(double_support_rate),
        stop_within_s_(stop_within_s),
        turn_s_(turn_s),
        stop_left_s_(stop_within_s) {
    reset();
  }

  void reset() noexcept {
    rate_per_s_ = limits_.rate_per_s;
    target_ = Command{};
    command_ = Command{};
    rising_share_.fill(1.0);
    falling_share_.fill(1.0);
    stop_left_s_ = stop_within_s_;
    limited_ = false;
  }

  /// Another rate for this channel [1/s], until reset().
  void set_rate(Channel channel, double rate_per_s) noexcept { rate_per_s_[channel] = rate_per_s; }

  /// (user, double_support, dt) => (command). double_support in [0, 1] is the product of the feet's contact weights. A
  /// channel that isn't finite keeps its previous target.
  ///   u += clamp(target - u, -falling step, rising step),
  ///   step = rate dt, for velocities times 1 - (1 - double_support_rate) double_support,
  ///   rising = min(1, rising + dt / turn_s), and 0 once u fell; falling likewise.
  const Command& step(const Command& user, double double_support, double dt_s) noexcept {
    limited_ = false;
    for (std::size_t channel = 0; channel < kChannels; ++channel) set_target(channel, user.u[channel]);
    const double rate_factor = 1.0 - (1.0 - double_support_rate_) * double_support;
    const bool stopping = target_[kVx] == 0.0 && target_[kVy] == 0.0 && target_[kOmega] == 0.0;
    if (!stopping) stop_left_s_ = stop_within_s_;
    const double regained = dt_s < turn_s_ ? dt_s / turn_s_ : 1.0;
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      const bool velocity = channel < kVelocityChannels;
      double step = rate_per_s_[channel] * dt_s * (velocity ? rate_factor : 1.0);
      if (velocity && stopping) step = std::max(step, stopping_step(channel, dt_s));
      move(channel, step, regained);
    }
    if (stopping) stop_left_s_ = std::max(0.0, stop_left_s_ - dt_s);
    return command_;
  }

  /// The user's command of the last step was out of range or not finite.
  bool limited() const noexcept { return limited_; }

 private:
  void set_target(std::size_t channel, double user) noexcept {
    if (!std::isfinite(user)) {
      limited_ = true;
      return;
    }
    target_.u[channel] = std::clamp(user, limits_.lower[channel], limits_.upper[channel]);
    limited_ = limited_ || target_.u[channel] != user;
  }

  /// step: largest change; regained: share of the rate that a direction gets back.
  void move(std::size_t channel, double step, double regained) noexcept {
    double &rising = rising_share_[channel], &falling = falling_share_[channel];
    rising = std::min(1.0, rising + regained);
    falling = std::min(1.0, falling + regained);
    const double change = std::clamp(target_.u[channel] - command_.u[channel], -falling * step, rising * step);
    if (change > 0.0) falling = 0.0;
    if (change < 0.0) rising = 0.0;
    command_.u[channel] += change;
  }

  /// |u| dt / (time left to stop): reaches zero exactly at the end of that time.
  double stopping_step(std::size_t channel, double dt_s) const noexcept {
    constexpr double kRounding_s = 1e-9;  // stop_left_s_ is a difference of many dt
    const double speed = std::abs(command_.u[channel]);
    return stop_left_s_ <= dt_s + kRounding_s ? speed : speed * dt_s / stop_left_s_;
  }

  CommandLimits limits_;
  std::array<double, kChannels> rate_per_s_{};
  double double_support_rate_ = 1.0;
  double stop_within_s_ = 0.0;
  double turn_s_ = 0.0;
  double stop_left_s_ = 0.0;
  Command target_;
  Command command_;
  std::array<double, kChannels> rising_share_{}, falling_share_{};  ///< of the rate, in [0, 1]
  bool limited_ = false;
};

}  // namespace pmg
