#include "control/supervisor.hpp"

#include <utility>

namespace pmg::control {

Supervisor::Supervisor(const model::RobotModel& robot, const SupervisorOptions& options)
    : options_(options), detector_(robot, options.fault_limits) {}

void Supervisor::request(const ModeRequest& request) noexcept {
  if (request.mode == Mode::kFault) return;  // nobody asks for one
  if (request.reset_fault) {
    reset_wanted_ = true;
  } else {
    wanted_ = request.mode;
    wanted_since_ns_.reset();
  }
}

Mode Supervisor::update(const SupervisorInput& input) noexcept {
  // A limp robot may be carried about, bent and unplugged: nothing of that is a fault until it is to hold itself.
  if (mode_ != Mode::kPassive) {
    // In Fault as well: what was wrong with the robot's motion must be over before a reset.
    const auto scope =
        mode_ == Mode::kDamping ? faults::FaultDetector::Scope::kSensing : faults::FaultDetector::Scope::kMotion;
    const std::optional<faults::Fault> found = detector_.detect(input.evidence, scope);
    if (mode_ == Mode::kFault) {
      if (reset_wanted_ && !found) {
        mode_ = Mode::kDamping;
        fault_ = faults::Fault{};
      }
      wanted_.reset();
      reset_wanted_ = stop_wanted_ = false;
      return mode_;
    }
    if (found) {
      raise(*found);
      return mode_;
    }
  } else {
    detector_.reset();
  }
  reset_wanted_ = false;
  if (std::exchange(stop_wanted_, false)) stop_now();
  follow_request(input);
  if (mode_ == Mode::kWalk) stop_walking_if_due(input);
  return mode_;
}

void Supervisor::raise(const faults::Fault& fault) noexcept {
  if (mode_ == Mode::kFault) return;  // the first one is the cause
  mode_ = Mode::kFault;
  fault_ = fault;
  wanted_.reset();
  reset_wanted_ = false;
  stopping_since_ns_.reset();
}

void Supervisor::stop_now() noexcept {
  // A wish for limp drives is carried out by follow_request; every other wish of this tick yields to the stop.
  if (wanted_ != Mode::kPassive && mode_ > Mode::kDamping) wanted_ = Mode::kDamping;
  if (wanted_ == Mode::kStand || wanted_ == Mode::kWalk) wanted_.reset();
}

void Supervisor::follow_request(const SupervisorInput& input) noexcept {
  if (!wanted_) return;
  if (!wanted_since_ns_) wanted_since_ns_ = input.evidence.now_ns;
  if (*wanted_ == Mode::kStand || *wanted_ == Mode::kWalk) {
    climb(input);
    return;
  }
  // Limp only from damping: a standing robot that is told to go limp is braked and stays so until told again.
  mode_ = (*wanted_ == Mode::kPassive && mode_ <= Mode::kDamping) ? Mode::kPassive : Mode::kDamping;
  stopping_since_ns_.reset();
  wanted_.reset();
}

void Supervisor::climb(const SupervisorInput& input) noexcept {
  switch (mode_) {
    case Mode::kPassive:
      mode_ = Mode::kDamping;
      return;
    case Mode::kDamping:
      mode_ = Mode::kStand;
      if (*wanted_ == Mode::kStand) wanted_.reset();
      return;
    case Mode::kStand:
      if (*wanted_ == Mode::kWalk) {
        if (!input.entry_done) return;  // the request waits for the ramp
        // Without somebody who drives, or in the air, it would stop at once; and walking must not begin by itself when
        // a link comes back or the robot is set down.
        if (may_walk(input)) {
          mode_ = Mode::kWalk;
        } else if (only_lacks_a_command(input)) {
          return;
        }
      }
      wanted_.reset();
      return;
    case Mode::kWalk:
      if (*wanted_ == Mode::kWalk) {
        if (may_walk(input)) stopping_since_ns_.reset();
      } else if (!stopping_since_ns_) {
        stopping_since_ns_ = input.evidence.now_ns;
      }
      wanted_.reset();
      return;
    case Mode::kFault:
      return;
  }
}

bool Supervisor::may_walk(const SupervisorInput& input) const noexcept {
  return input.command_age_s <= options_.stale_command_s && input.gco_held_ticks < options_.gco_held_ticks &&
         !input.policy_waits;
}

bool Supervisor::only_lacks_a_command(const SupervisorInput& input) const noexcept {
  SupervisorInput with_command = input;
  with_command.command_age_s = 0.0;
  const double waited_s = static_cast<double>(input.evidence.now_ns - *wanted_since_ns_) * 1e-9;
  return may_walk(with_command) && waited_s < options_.stale_command_s;
}

void Supervisor::stop_walking_if_due(const SupervisorInput& input) noexcept {
  const std::int64_t now_ns = input.evidence.now_ns;
  if (!may_walk(input) && !stopping_since_ns_) stopping_since_ns_ = now_ns;
  if (!stopping_since_ns_) return;
  const double stopping_s = static_cast<double>(now_ns - *stopping_since_ns_) * 1e-9;
  if (input.at_rest || stopping_s >= options_.stop_within_s) {
    mode_ = Mode::kStand;
    stopping_since_ns_.reset();
  }
}

Command Supervisor::admit(const Command& user) const noexcept {
  if (mode_ != Mode::kWalk) return Command{};
  Command admitted = user;
  if (stopping_since_ns_) admitted[kVx] = admitted[kVy] = admitted[kOmega] = 0.0;
  return admitted;
}

}  // namespace pmg::control
