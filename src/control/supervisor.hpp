// The mode machine: Passive -> Damping -> Stand -> Walk, and Fault, latched. Its table is docs/reference/safety.md.
#pragma once

#include <cstdint>
#include <optional>

#include "control/mode.hpp"
#include "faults/fault_detector.hpp"

namespace pmg::control {

struct SupervisorOptions {
  faults::FaultLimits fault_limits;
  double stale_command_s = 0.2;  ///< an older driving command ends walking; Walk waits so long for the first one
  double stop_within_s = 0.5;    ///< after this time velocity counts as zero, whatever the generator says
  /// So many ticks in a row with a held ground-aware solution end walking: u' is then a second old.
  int gco_held_ticks = 100;
};

/// The inputs from which a tick decides its mode.
struct SupervisorInput {
  faults::FaultEvidence evidence;
  double command_age_s = 0.0;
  bool entry_done = false;    ///< the ramp from the measured posture into Stand has ended
  bool at_rest = false;       ///< the reference moves no foot
  int gco_held_ticks = 0;     ///< ticks in a row in which the ground-aware optimisation held an old solution
  bool policy_waits = false;  ///< the policy needs the ground, and the feet aren't known to carry the robot
};

class Supervisor {
 public:
  Supervisor(const model::RobotModel& robot, const SupervisorOptions& options);

  /// Remembers a request until update() has carried it out or refused it. A later request replaces it. Outside of Fault
  /// a reset changes no mode.
  void request(const ModeRequest& request) noexcept;

  /// A stop by anyone comes before every other request of this tick: Damping, unless the mode is Passive or Fault.
  void stop() noexcept { stop_wanted_ = true; }

  /// (requests, evidence) => (mode of this tick). It changes by one step at most, upwards one mode at a time.
  Mode update(const SupervisorInput& input) noexcept;

  /// Latches a fault found later in the tick than update().
  void raise(const faults::Fault& fault) noexcept;

  /// See FaultDetector.
  bool robot_is_sound(const faults::FaultEvidence& evidence) const noexcept {
    return detector_.robot_is_sound(evidence);
  }

  /// From here the robot would not stand up: it leans so far that Stand would end in a fault at once.
  bool robot_is_down(const model::RobotState& state) const noexcept {
    return mode_ <= Mode::kDamping && detector_.leans_too_far(state);
  }

  Mode mode() const noexcept { return mode_; }
  const faults::Fault& fault() const noexcept { return fault_; }  ///< kNone unless the mode is kFault
  /// (user's command) => (command for the generator): all channels in Walk, posture alone while the robot comes to a
  /// stop, zero otherwise.
  Command admit(const Command& user) const noexcept;

 private:
  void stop_now() noexcept;
  void follow_request(const SupervisorInput& input) noexcept;
  void climb(const SupervisorInput& input) noexcept;
  bool may_walk(const SupervisorInput& input) const noexcept;
  /// Its command may be behind the request on the network.
  bool only_lacks_a_command(const SupervisorInput& input) const noexcept;
  void stop_walking_if_due(const SupervisorInput& input) noexcept;

  SupervisorOptions options_;
  faults::FaultDetector detector_;
  Mode mode_ = Mode::kPassive;
  faults::Fault fault_;
  std::optional<Mode> wanted_;
  std::optional<std::int64_t> wanted_since_ns_;  // the first update() that knew the request
  bool reset_wanted_ = false, stop_wanted_ = false;
  std::optional<std::int64_t> stopping_since_ns_;
};

}  // namespace pmg::control
