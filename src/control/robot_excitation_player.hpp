// Excites all joints of a robot at once in mode Stand, by commands that were made before. It begins softly, only once
// the robot has stood or hung still for some time, as the commands need it, and ends softly.
#pragma once

#include <vector>

#include "control/excitation_player.hpp"
#include "faults/foot_load_watch.hpp"
#include "hal/command_guard.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::control {

struct RobotExcitationPlan {
  std::vector<model::JointCommand> commands;  ///< one a tick; the first: standing posture, robot.yaml's gains, at rest
  faults::Footing footing = faults::Footing::kHangs;  ///< what the commands are for: hanging or standing
  /// On this footing without a break before the first command. A hoist that sets a robot down takes two seconds, and
  /// the feet carry before its straps are loose.
  double settle_s = 4.0;
  /// While it plays, legs that swing look as if they carried, now more and now less than nothing. Their load is
  /// averaged with this time constant, which holds two swings of the fastest sine (2.1 Hz); its inertia counts most.
  double average_s = 1.0;
  /// Shares of the weight. Above the one the feet of a hanging robot carry it: it was set down. Below the other those
  /// of a standing one don't: it was lifted, or it fell. Either ends the play. A robot that stands has 1, one that
  /// hangs 0.
  double set_down_share = 0.6, lifted_share = 0.25;
  double return_s = 2.0;  ///< from the last command back to rest
};

/// Throws std::invalid_argument when there is no command, or when one has another size than the robot, isn't finite,
/// leaves a joint's range, speed or the gains that the bus guard lets pass, has a torque, or doesn't begin at rest.
void check(const RobotExcitationPlan& plan, const model::RobotModel& robot, const hal::GuardOptions& guard = {});

class RobotExcitationPlayer {
 public:
  /// Throws as check().
  RobotExcitationPlayer(RobotExcitationPlan plan, const model::RobotModel& robot, double dt_s,
                        const faults::FootLoadOptions& foot_load, const hal::GuardOptions& guard = {});

  void start() noexcept;  ///< Stand is entered: the footing is unknown
  /// (state, command in force) => footing. Once a tick in Stand.
  void watch(const model::RobotState& state, const model::JointCommand& in_force) noexcept;
  /// (the command at rest) => (the command of the next tick), in place. Once a tick after the entry into Stand.
  void step(model::JointCommand& command) noexcept;
  void give_up() noexcept;  ///< ends the play at once; no effect before its first command and after its end

  /// sample: of the commands; run 0 while they play.
  const ExcitationProgress& progress() const noexcept { return progress_; }

 private:
  enum class Phase { kSettle, kPlay, kReturn, kOver };
  bool lost_footing() const noexcept;
  void settle() noexcept;
  void play(model::JointCommand& command) noexcept;
  void come_back(model::JointCommand& command) noexcept;
  void end_play(bool given_up) noexcept;

  RobotExcitationPlan plan_;
  faults::FootLoadWatch feet_;
  double dt_s_;
  Phase phase_ = Phase::kSettle;
  model::JointCommand last_;  // of the play
  double settled_s_ = 0.0, carried_ = 0.0, returned_s_ = 0.0;
  ExcitationProgress progress_;
};

}  // namespace pmg::control
