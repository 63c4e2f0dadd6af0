// One run's log: the tick's inputs and results as LCM messages (msgs/), stamped with the run's own clock.
#pragma once

#include <cstdint>

#include "io/log_writer.hpp"
#include "model/robot_model.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "runtime/tick_record.hpp"
#include "sim/world.hpp"

namespace pmg::runtime {

/// Channels: ROBOT_INFO once, then STATE, COMMAND, MODE, TICK, REFERENCE, MOTOR_COMMAND, STATUS a tick, GROUND_TRUTH in
/// simulation, FAULT when one latches. Keeps its message buffers, so a tick allocates nothing once they have grown. Not
/// for a real-time thread.
class TickLog {
 public:
  TickLog(io::LogWriter& writer, const model::RobotModel& robot, double control_rate_Hz);

  void write(const TickRecord& record);
  void write_truth(std::int64_t stamp_ns, const sim::Truth& truth, bool hoisted);

 private:
  void write_input(const TickRecord& record);
  void write_state(std::int64_t stamp_ns, const model::RobotState& state);
  void write_reference(std::int64_t stamp_ns, const TickResult& result);
  void write_command(std::int64_t stamp_ns, const model::JointCommand& command);
  void write_status(std::int64_t stamp_ns, const TickResult& result);

  io::LogWriter& writer_;
  const model::RobotModel& robot_;
  Mode last_mode_ = Mode::kPassive;
  pmg_msgs::tick_input_t input_;
  pmg_msgs::command_t command_;
  pmg_msgs::mode_t mode_;
  pmg_msgs::robot_state_t state_;
  pmg_msgs::reference_t reference_;
  pmg_msgs::motor_command_t motor_command_;
  pmg_msgs::status_t status_;
  pmg_msgs::ground_truth_t truth_;
};

}  // namespace pmg::runtime
