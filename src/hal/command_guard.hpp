// The last guard before the drives, in the bus thread. It checks the control thread's numbers, and that the control
// thread lives.
#pragma once

#include <cstdint>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::hal {

/// The control thread's message to the bus: a command, and the interventions that its tick knew of.
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
  /// Bus cycles that the last command is held without a new one: 25 cycles of 2 ms = five control ticks. In that time
  /// the lean of a falling humanoid (an inverted pendulum of h = 0.75 m) grows by exp(0.05 s sqrt(g / h)) - 1 = 20 %.
  /// Cycles and not time, so that a host that stops both threads is no fault.
  int hold_cycles = 25;
  double max_kp_Nm_per_rad = 2000.0, max_kd_Nm_s_per_rad = 100.0;  ///< plausible drive gains
};

class CommandGuard {
 public:
  CommandGuard(const model::RobotModel& robot, const GuardOptions& options);

  /// (new command or null, pulls of the stop line) => (command for the drives), once a bus cycle.
  /// - Before the first command: no torque.
  /// - Then the newest command, for hold_cycles at most, clamped to the URDF's ranges, speeds and efforts and to the
  ///   largest gains.
  /// - Damping with robot.yaml's kd when the command is too old or not finite, or when its tick had not seen the last
  /// pull
  ///   of the stop line. It ends with a command whose tick knows of the intervention.
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
