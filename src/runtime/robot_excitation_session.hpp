// The excitation of a whole robot by the controller: the commands by their name, what a log says of it, and what people
// are told while it plays.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "control/robot_excitation_player.hpp"
#include "control/tick_record.hpp"
#include "hal/command_guard.hpp"
#include "pmg/clip.hpp"

namespace pmg::runtime {

/// "hanging", "standing".
std::vector<std::string> robot_excitation_names();

/// own_gains: as hal::BackendDescription's. Throws std::invalid_argument when there is no such excitation, or the robot
/// or the bus guard forbids a command.
control::RobotExcitationPlan robot_excitation_plan(const std::string& name, const model::RobotModel& robot,
                                                   const ClipLibrary& clips, const hal::GuardOptions& guard,
                                                   std::span<const std::string> own_gains = {});

class RobotExcitationSession {
 public:
  RobotExcitationSession(std::string name, const control::RobotExcitationPlan& plan, double dt_s);

  nlohmann::ordered_json json() const;  ///< for a log, so that it can be replayed
  /// (tick) => (a line for people when something has changed; else ""). Feed it every tick's record.
  std::string news(const control::TickRecord& record);
  bool whole() const { return over_ && !given_up_; }
  /// Nothing is left to play, and the robot may be damped: never while it stands on its feet.
  bool may_end() const { return over_ && name_ == "hanging"; }

 private:
  std::string waits(const control::TickRecord& record);

  std::string name_;
  double dt_s_, duration_s_, settle_s_;
  bool playing_ = false, over_ = false, given_up_ = false;
  double waited_s_ = 0.0;
};

}  // namespace pmg::runtime
