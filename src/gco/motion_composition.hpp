// (user command) => (reference to imitate, observed command). The controller's tick and training step this same
// composition of generator and ground-aware optimisation, so they can't differ.
#pragma once

#include <array>
#include <optional>

#include "gco/ground_aware_command.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "pmg/command_limiter.hpp"
#include "pmg/generator.hpp"
#include "pmg/reference.hpp"
#include "pmg/variant.hpp"

namespace pmg::gco {

/// Command limits and scales of robot.yaml; defaults for the rest.
GeneratorOptions generator_options(const model::RobotModel& robot);

/// Once per tick: advance(), then ground(). Neither uses the heap or throws.
class MotionComposition {
 public:
  /// Throws std::invalid_argument as Generator and GroundAwareCommand do.
  MotionComposition(const model::RobotModel& robot, const ClipLibrary& library, Variant variant,
                    const GeneratorOptions& generator, const Options& gco = {});

  /// At rest in the standing posture, nothing remembered.
  void reset() noexcept;

  /// Another rate limit for this channel [1/s], until reset().
  void set_rate(Channel channel, double rate_per_s) noexcept { generator_.set_rate(channel, rate_per_s); }

  /// As Generator's, until reset(): only PMG's, whose policy knows by u' what is asked of its clips.
  void set_correction(const std::array<double, kVelocityChannels>& correction) noexcept {
    if (variant_ == Variant::kPmg) generator_.set_correction(correction);
  }

  /// (user, dt) => (reference). PMG's generator applies the library's inverse, so u' averages to the user's command.
  /// The baselines, which don't know u', ask their clips for the user's command itself. For a policy that steps by
  /// itself the reference stands still, with a gain and the command's velocities within their limits.
  const Reference& advance(const Command& user, double dt_s) noexcept;

  /// (reference) => (observed command, slip). Baselines observe u: their status is kNotAsked, slip and v'z are zero.
  const Result& ground() noexcept;

  Variant variant() const noexcept { return variant_; }
  const Reference& reference() const noexcept { return reference_; }

 private:
  void play_forward_clip(double dt_s) noexcept;
  void take_velocities(const Command& user, const Command& before, double dt_s) noexcept;

  Variant variant_;
  double forward_scale_m_s_;  ///< vx of the forward clip at full amplitude
  Generator generator_;
  std::optional<Generator> forward_only_;     ///< only for the single gait
  CommandLimits limits_;                      ///< robot.yaml's, or narrower ones
  std::optional<CommandLimiter> velocities_;  ///< only for a policy that steps by itself
  GroundAwareCommand gco_;
  Reference reference_;
  Result unasked_;
};

}  // namespace pmg::gco
