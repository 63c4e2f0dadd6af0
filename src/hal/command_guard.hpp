// The last guard before the drives, in the bus thread: it trusts neither the control thread's numbers nor its being
// alive.
#pragma once

#include <cstdint>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::hal {

/// What the control thread hands to the bus: a command, and which interventions its author knew of.
struct ControlOutput {
  model::JointCommand joints;
  std::uint32_t stops_seen = 0;  ///< StopLine::pulls()
  std::uint32_t trips_seen = 0;  ///< CommandGuard::trips()
};

enum class TripCause : std::uint8_t {
  kNone = 0,
  kControlFrozen,     ///< no new command for longer than a held one may stand
  kCommandNotFinite,  ///< NaN, infinity, or vectors of another length
};

struct GuardOptions {
  /// Bus cycles that the last command is held without a new one: five control ticks. A standing humanoid of 0.75 m
  /// tips by a fifth of its lean in that time; cycles and not time, so that a host that stops both threads is no fault.
  int hold_cycles = 25;
  double max_kp_Nm_per_rad = 2000.0, max_kd_Nm_s_per_rad = 100.0;  ///< plausible drive gains
};

class CommandGuard {
 public:
  CommandGuard(const model::RobotModel& robot, const GuardOptions& options);

  /// One bus cycle: fresh is the command that came since the last cycle, or null. Before the first command: no torque.
  /// Afterwards the newest command, held for hold_cycles; then, or when it is not finite, or a stop is pulled that its
  /// author had not seen, damping with robot.yaml's kd: until a command comes that knows of it. Targets are clamped to
  /// the URDF's ranges, speeds and efforts.
  const model::JointCommand& next(const ControlOutput* fresh, std::uint32_t stop_pulls) noexcept;

  const GuardOptions& options() const noexcept { return options_; }
  std::uint32_t trips() const noexcept { return trips_; }
  TripCause cause() const noexcept { return cause_; }  ///< of the last trip
  bool damping() const noexcept { return damping_; }   ///< this cycle's command is the guard's own
  int age_cycles() const noexcept { return age_cycles_; }

 private:
  bool plausible(const model::JointCommand& command) const noexcept;
  void clamp(model::JointCommand& command) const noexcept;
  void trip(TripCause cause) noexcept;

  GuardOptions options_;
  JointVector lower_, upper_, velocity_, effort_;
  ControlOutput newest_;
  model::JointCommand brake_;
  bool any_ = false, damping_ = false;
  int age_cycles_ = 0;
  std::uint32_t trips_ = 0;
  TripCause cause_ = TripCause::kNone;
};

}  // namespace pmg::hal
