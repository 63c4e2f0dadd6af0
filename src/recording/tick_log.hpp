// One run's log: the tick's inputs and results as LCM messages (msgs/), stamped with the run's own clock.
#pragma once

#include <cstdint>

#include "control/tick_record.hpp"
#include "io/log_writer.hpp"
#include "model/ground_truth.hpp"
#include "model/robot_model.hpp"
#include "pmg_msgs/scenario_step_t.hpp"
#include "recording/run_info.hpp"
#include "recording/tick_messages.hpp"

namespace pmg::recording {

/// Channels: ROBOT_INFO once a file, then STATE, COMMAND, MODE, ARMS, TICK, REFERENCE, MOTOR_COMMAND, STATUS a tick,
/// LIMITED in ticks that limit a joint, ARMS_STATE in ticks in which an operator has an arm, GROUND_TRUTH in
/// simulation, SCENARIO where a step of it begins, TIMING in the threaded controller, FAULT when one latches. Keeps its
/// message buffers, so a tick allocates nothing once they have grown. Not for a real-time thread.
class TickLog {
 public:
  /// Keeps references to writer and robot.
  TickLog(io::LogWriter& writer, const model::RobotModel& robot, const RunInfo& run, double control_rate_Hz,
          std::int64_t stamp_ns = 0);

  /// From here on into another file, which stands alone: it begins with ROBOT_INFO too.
  void continue_in(io::LogWriter& writer, std::int64_t stamp_ns);

  /// FAULT now, with the stamp of the fault itself, instead of after the tick that latched it: a file that is about one
  /// fault begins with it.
  void announce_fault(std::int64_t stamp_ns, const control::TickRecord& record);

  void write(const control::TickRecord& record);
  void write_timing(const control::TickRecord& record, const BusTiming& bus, const control::DroppedItems& dropped);
  void write_step(const pmg_msgs::scenario_step_t& step);
  void write_truth(std::int64_t stamp_ns, const model::GroundTruth& truth, bool hoisted);

 private:
  void write_input(const control::TickRecord& record);
  void write_arms_state(const control::TickRecord& record);
  void write_fault_once(const control::TickRecord& record);

  io::LogWriter* writer_;
  const model::RobotModel& robot_;
  const RunInfo run_;
  const int joint_count_;
  faults::Fault last_fault_, announced_fault_;
  pmg_msgs::robot_info_t info_;
  pmg_msgs::tick_input_t input_;
  pmg_msgs::command_t command_;
  pmg_msgs::mode_t mode_;
  pmg_msgs::robot_state_t state_;
  pmg_msgs::reference_t reference_;
  pmg_msgs::motor_command_t motor_command_;
  pmg_msgs::status_t status_;
  pmg_msgs::timing_t timing_;
  pmg_msgs::ground_truth_t truth_{};
  pmg_msgs::limited_t limited_;
  pmg_msgs::arms_t arms_;
  pmg_msgs::arms_input_t arms_input_;
  pmg_msgs::arms_state_t arms_state_{};
  bool arms_led_ = false;  // in the last tick
  pmg_msgs::fault_t fault_;
};

}  // namespace pmg::recording
