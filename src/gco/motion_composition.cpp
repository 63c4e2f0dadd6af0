#include "gco/motion_composition.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::gco {

namespace {

/// Removes every other direction and every corner.
ClipLibrary forward_clip_only(ClipLibrary library) {
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    if (channel != kVx) library.positive[channel].reset();
    library.negative[channel].reset();
  }
  library.corners.clear();
  return library;
}

/// Baselines don't know u', so their clips get the command without the inverse.
ClipLibrary known_to(Variant variant, ClipLibrary library) {
  if (variant != Variant::kPmg) library.inverse = {};
  return library;
}

}  // namespace

GeneratorOptions generator_options(const model::RobotModel& robot) {
  GeneratorOptions options;
  options.limits = robot.command_limits;
  options.scale_positive = robot.velocity_scale_positive;
  options.scale_negative = robot.velocity_scale_negative;
  return options;
}

MotionComposition::MotionComposition(const model::RobotModel& robot, const ClipLibrary& library, Variant variant,
                                     const GeneratorOptions& generator, const Options& gco)
    : variant_(variant),
      forward_scale_m_s_(library.velocity_scale ? library.velocity_scale->positive[kVx]
                                                : generator.scale_positive[kVx]),
      generator_(known_to(variant, library), generator),
      limits_(generator.limits),
      gco_(robot, gco) {
  if (variant_ == Variant::kSingleGait) forward_only_.emplace(forward_clip_only(known_to(variant, library)), generator);
  if (variant_ == Variant::kVelocity) {
    constexpr double kFullRate = 1.0;  // it steps by itself: no double support of the reference's to wait for
    velocities_.emplace(limits_, kFullRate, generator.stop_within_s, generator.turn_s);
  }
  unasked_.status = Status::kNotAsked;
  reset();
}

void MotionComposition::reset() noexcept {
  generator_.reset();
  if (forward_only_) forward_only_->reset();
  if (velocities_) velocities_->reset();
  gco_.reset();
  reference_ = generator_.reference();
}

const Reference& MotionComposition::advance(const Command& user, double dt_s) noexcept {
  const Command before = reference_.command;
  reference_ = generator_.step(user, dt_s);
  if (forward_only_) play_forward_clip(dt_s);
  if (velocities_) take_velocities(user, before, dt_s);
  return reference_;
}

/// Gait, joints and contacts of the forward clip; the command stays the user's, admissible and rate-limited.
void MotionComposition::play_forward_clip(double dt_s) noexcept {
  Command forward;
  forward[kVx] = reference_.gain * forward_scale_m_s_;
  const Command command = reference_.command, rate = reference_.command_rate;
  const bool limited = reference_.command_limited;
  reference_ = forward_only_->step(forward, dt_s);
  reference_.command = command;
  reference_.command_rate = rate;
  reference_.command_limited = limited;
}

/// The velocities of the user's command, in range and rate-limited; the gain says how large they are. before: the
/// reference's command of the tick before.
void MotionComposition::take_velocities(const Command& user, const Command& before, double dt_s) noexcept {
  const Command& wanted = velocities_->step(user, 0.0, dt_s);
  double share = 0.0;
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const double value = wanted.u[channel];
    const double most = value < 0.0 ? -limits_.lower[channel] : limits_.upper[channel];
    if (value != 0.0) share += std::abs(value) / most;
    reference_.command.u[channel] = value;
    reference_.command_rate.u[channel] = (value - before.u[channel]) / dt_s;
  }
  reference_.gain = std::min(share, 1.0);
  reference_.command_limited = velocities_->limited();
}

const Result& MotionComposition::ground() noexcept {
  if (variant_ == Variant::kPmg) return gco_.solve(reference_);
  unasked_.command = reference_.command;
  return unasked_;
}

}  // namespace pmg::gco
