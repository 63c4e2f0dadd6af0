#include "control/velocity_trim.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::control {

VelocityTrim::VelocityTrim(const model::RobotModel& robot, const VelocityTrimOptions& options,
                           double double_support_rate, double dt_s)
    : options_(options),
      double_support_rate_(double_support_rate),
      dt_s_(dt_s),
      odometry_(robot),
      limits_(robot.command_limits) {
  for (std::size_t c = 0; c < kVelocityChannels; ++c)
    range_[c] = std::max(robot.command_limits.upper[c], -robot.command_limits.lower[c]);
}

void VelocityTrim::forget() noexcept {
  lagged_ = {};
  before_ = {};
  asked_ = {};
  measured_ = {};
  trim_ = {};
}

void VelocityTrim::reset() noexcept {
  forget();
  correction_ = {};
}

const std::array<double, kVelocityChannels>& VelocityTrim::step(const model::RobotState& state, const Command& user,
                                                                const Reference& reference, bool walks) noexcept {
  const Command taken = user_command(reference);
  double commanded = 0.0;
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    if (range_[c] > 0.0) commanded += std::abs(taken.u[c]) / range_[c];
  }
  if (walks && commanded > 0.0) {
    learn(state, user, taken, reference.contact_weight);
  } else {
    forget();
  }
  const double share = std::min(1.0, commanded / options_.full_above_share);
  const double both_carry = reference.contact_weight[kLeft] * reference.contact_weight[kRight];
  const double rate_per_s = kMostRate_per_s * (1.0 + (double_support_rate_ - 1.0) * both_carry);
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    const double most = rate_per_s * range_[c] * dt_s_;
    correction_[c] += std::clamp(share * trim_[c] - correction_[c], -most, most);
  }
  return correction_;
}

void VelocityTrim::learn(const model::RobotState& state, const Command& user, const Command& taken,
                         const PerFoot<double>& weight) noexcept {
  const auto measured = odometry_.velocity_H(state, weight);
  const bool learns = settled(user, taken) && measured;
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    if (measured) measured_[c] += dt_s_ / options_.lag_s * ((*measured)[c] - measured_[c]);
    if (!learns) continue;
    const double most_miss = options_.most_miss_share * range_[c], most = options_.most_share * range_[c];
    const double missing = std::clamp(lagged_[c] - measured_[c], -most_miss, most_miss);
    trim_[c] = std::clamp(trim_[c] + options_.gain_per_s * dt_s_ * missing, -most, most);
  }
}

bool VelocityTrim::settled(const Command& user, const Command& taken) noexcept {
  bool settled = true;
  double changed = 0.0;
  for (std::size_t c = 0; c < kVelocityChannels; ++c) {
    if (range_[c] == 0.0) continue;
    const double asked = std::clamp(user.u[c], limits_.lower[c], limits_.upper[c]);
    asked_[c] += dt_s_ / options_.lag_s * (asked - asked_[c]);
    lagged_[c] += dt_s_ / options_.lag_s * (taken.u[c] - lagged_[c]);
    changed += std::abs(taken.u[c] - before_[c]) / range_[c];
    before_[c] = taken.u[c];
    settled = settled && std::abs(asked - asked_[c]) <= options_.settled_share * range_[c];
  }
  for (double& trim : trim_) trim *= std::exp(-options_.forgets_per_range * changed);
  return settled;
}

}  // namespace pmg::control
