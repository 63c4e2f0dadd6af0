// Ground-aware command optimisation (paper III-A.3): the command that the reference motion really realises on the ground.
#pragma once

#include <memory>

#include "model/robot_model.hpp"
#include "pmg/command.hpp"
#include "pmg/reference.hpp"
#include "pmg/types.hpp"

namespace pmg::gco {

struct Options {
  double prior_weight = 1e-3;       ///< towards the command, relative to the contact residuals
  bool optimise_roll_pitch = false;  ///< 7 unknowns instead of 5
};

enum class Status { kConverged, kNotConverged, kNoContact };

struct FootSlip {
  double before_m_s = 0.0;         ///< horizontal speed of the contact point if the base moved by the user's command
  double after_m_s = 0.0;          ///< the same with the optimised command
  double yaw_rate_after_rad_s = 0.0;
  double height_m = 0.0;           ///< lowest sole point above the ground with the optimised height
};

struct Result {
  Command command;                ///< u' = [v'x, v'y, omega', pitch, roll, h'], H frame, h' as deviation from stand
  double vz_m_s = 0.0;            ///< v'z
  double height_deficit_m = 0.0;  ///< commanded height - h': what the legs can't give while pitch wins
  PerFoot<FootSlip> foot;         ///< valid for feet in contact
  Status status = Status::kConverged;
};

class GroundAwareCommand {
 public:
  explicit GroundAwareCommand(const model::RobotModel& robot, const Options& options = {});
  ~GroundAwareCommand();

  /// One solve. u is the user's (admissible) command: reference.command. No heap, no exception.
  const Result& solve(const Reference& reference) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::gco
