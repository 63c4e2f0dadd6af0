// Ground-aware command optimisation (paper III-A.3): the command that the reference motion really realises on the
// ground.
#pragma once

#include <memory>

#include "model/robot_model.hpp"
#include "pmg/command.hpp"
#include "pmg/reference.hpp"
#include "pmg/types.hpp"

namespace pmg::gco {

struct Options {
  double prior_weight = 1e-3;        ///< of residuals towards the command, relative to the contact residuals' 1
  bool optimise_roll_pitch = false;  ///< 7 unknowns instead of 5
  /// The same as prior_weight for pitch and roll [per rad], only with 7 unknowns. Gauss-Newton needs it well above the
  /// square root of residual times leg speed, of the order of 0.1: below, it crawls.
  double attitude_prior_weight = 0.3;
};

enum class Status {
  kConverged,
  kNotConverged,  ///< the reference is not finite or the solver failed: everything else in Result is of the last good
                  ///< solve
  kNoContact,     ///< both contact weights are zero: u' is the command, h' stays where it was
  kNotAsked       ///< a baseline runs without it (motion_composition.hpp): u' is the command, nothing else is known
};

struct FootSlip {
  double before_m_s = 0.0;  ///< horizontal speed of the contact point if the base moved by the user's command
  double after_m_s = 0.0;   ///< the same with the optimised command
  double yaw_rate_after_rad_s = 0.0;
  double height_m = 0.0;  ///< lowest sole point above the ground with the optimised height
};

struct Result {
  Command command;                ///< u' = [v'x, v'y, omega', pitch, roll, h'], H frame, h' as deviation from stand
  double vz_m_s = 0.0;            ///< v'z
  double height_deficit_m = 0.0;  ///< commanded height - h': what the legs can't give while pitch wins
  PerFoot<FootSlip> foot;         ///< of feet with a contact weight; zero otherwise
  Status status = Status::kConverged;
};

/// Finds the base velocity, yaw rate and height under which the feet in contact stand still on the ground (paper
/// III-A.3), starting from the user's command. Where two stance feet disagree the result is the least-squares one, its
/// slip is reported, and the lower foot is the one on the ground. Pitch always wins over height.
class GroundAwareCommand {
 public:
  /// Throws std::invalid_argument if a prior weight isn't positive.
  explicit GroundAwareCommand(const model::RobotModel& robot, const Options& options = {});
  ~GroundAwareCommand();

  /// One solve. u is the user's (admissible) command: reference.command. No heap, no exception.
  const Result& solve(const Reference& reference) noexcept;

  /// Forgets the height that is held in flight and the last good result.
  void reset() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::gco
