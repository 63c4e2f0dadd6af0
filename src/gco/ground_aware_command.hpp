// Ground-aware command optimisation (paper III-A.3): the command u' that the reference motion realises on the ground.
#pragma once

#include <memory>

#include "model/robot_model.hpp"
#include "pmg/command.hpp"
#include "pmg/reference.hpp"
#include "pmg/types.hpp"

namespace pmg::gco {

struct Options {
  double prior_weight = 1e-3;        ///< weight of x - command, relative to the contact residuals' 1
  bool optimise_roll_pitch = false;  ///< 7 unknowns instead of 5
  /// prior_weight of pitch and roll [per rad], only with 7 unknowns. Gauss-Newton needs it well above the square root
  /// of residual times leg speed, which is about 0.1; with less it converges very slowly.
  double attitude_prior_weight = 0.3;
};

enum class Status {
  kConverged,
  kNotConverged,  ///< reference not finite, or solver failed; the rest of Result is from the last good solve
  kNoContact,     ///< both contact weights are zero: u' is the command, h' keeps its last value
  kNotAsked       ///< a baseline runs without it (motion_composition.hpp): u' is the command, all else is unknown
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
  double height_deficit_m = 0.0;  ///< commanded height - h'; pitch wins where the legs can't reach both
  PerFoot<FootSlip> foot;         ///< of feet with a contact weight; zero otherwise
  Status status = Status::kConverged;
};

/// Finds the base velocity, yaw rate and height with which the feet in contact stand still on the ground (paper
/// III-A.3, eq. 19), starting from the user's command. If two stance feet disagree, the result is the least-squares
/// one: the slip is reported, and the lower foot is on the ground. Pitch always wins over height.
class GroundAwareCommand {
 public:
  /// Throws std::invalid_argument if a prior weight isn't positive.
  explicit GroundAwareCommand(const model::RobotModel& robot, const Options& options = {});
  ~GroundAwareCommand();

  /// (reference) => (u', slip); one solve. u, the user's admissible command, is reference.command. No heap, no
  /// exception.
  const Result& solve(const Reference& reference) noexcept;

  /// Forgets the height held in flight and the last good result.
  void reset() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::gco
