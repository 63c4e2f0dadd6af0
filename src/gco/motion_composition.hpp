// From the user's command to what a policy imitates and which command it observes: the one composition of generator and
// ground-aware optimisation, for the controller's tick and for training, so that the two can't differ.
#pragma once

#include <optional>

#include "gco/ground_aware_command.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "pmg/generator.hpp"
#include "pmg/reference.hpp"
#include "pmg/variant.hpp"

namespace pmg::gco {

/// Command limits and scales of robot.yaml; defaults for the rest.
GeneratorOptions generator_options(const model::RobotModel& robot);

/// Once a tick: advance(), then ground(). Neither uses the heap or throws.
class MotionComposition {
 public:
  /// Throws std::invalid_argument as Generator and GroundAwareCommand do.
  MotionComposition(const model::RobotModel& robot, const ClipLibrary& library, Variant variant,
                    const GeneratorOptions& generator, const Options& gco = {});

  /// At rest in the standing posture, nothing remembered.
  void reset() noexcept;

  /// The reference of the next tick. PMG's generator has the library's inverse, so that u' averages to the user's
  /// command; the baselines, which know no u', ask their clips for the user's command as it is.
  const Reference& advance(const Command& user, double dt_s) noexcept;

  /// Which command the policy observes with that reference, and what the ground makes of it. Baselines observe u: their
  /// status is kNotAsked, slip and v'z are zero.
  const Result& ground() noexcept;

  Variant variant() const noexcept { return variant_; }
  const Reference& reference() const noexcept { return reference_; }

 private:
  void play_forward_clip(double dt_s) noexcept;

  Variant variant_;
  double forward_scale_m_s_;  ///< vx at which the forward clip plays with full amplitude
  Generator generator_;
  std::optional<Generator> forward_only_;  ///< single gait alone
  GroundAwareCommand gco_;
  Reference reference_;
  Result unasked_;
};

}  // namespace pmg::gco
