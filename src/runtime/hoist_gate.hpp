// Requests from the network for the robot's hoist (pmg_msgs::hoist_t), and the answers (pmg_msgs::hoist_state_t).
#pragma once

#include <cstdint>
#include <string>

#include "control/tick.hpp"
#include "hal/hoist_line.hpp"
#include "io/lcm_link.hpp"
#include "pmg_msgs/hoist_state_t.hpp"
#include "pmg_msgs/hoist_t.hpp"
#include "runtime/datagram_order.hpp"
#include "runtime/operator_gate.hpp"

namespace pmg::runtime {

/// For the thread that hears operators. A request only sets a flag, so a flood of them costs no more than hearing it.
class HoistGate {
 public:
  /// Keeps references. robot: the controller's name. order: of all operators' messages.
  HoistGate(std::string robot, const io::Clock& clock, const seal::ControllerSeal& seal, DatagramOrder& order)
      : robot_(std::move(robot)), clock_(clock), seal_(seal), order_(order) {}

  void work(hal::HoistLine* line) noexcept { line_ = line; }  ///< keeps the pointer; null: there is no hoist
  bool there() const noexcept { return line_ != nullptr; }

  void take(io::Bytes message);  ///< channel HOIST
  void see(const control::TickResult& result) noexcept {
    if (line_ != nullptr) line_->see(control::upright(result.mode), result.entering);
  }

  /// Fills the message for channel HOIST_STATE, all but its stamp. True when it says something new.
  bool fill(pmg_msgs::hoist_state_t& message);

  /// Requests that were ignored. Repeated and overtaken ones are not among them: they are acknowledged anew.
  const GateCounts& counts() const noexcept { return counts_; }

 private:
  /// A message with a good seal.
  void answer(const pmg_msgs::hoist_t& message);

  std::string robot_;
  const io::Clock& clock_;
  const seal::ControllerSeal& seal_;
  DatagramOrder& order_;
  hal::HoistLine* line_ = nullptr;
  GateCounts counts_;
  control::Source taken_;     // of the last request that moved the hoist
  control::Source answered_;  // of the last one that was answered: it, or a repetition of an earlier one
  std::int64_t answered_sequence_ = 0;
  bool answer_ = false;
};

}  // namespace pmg::runtime
