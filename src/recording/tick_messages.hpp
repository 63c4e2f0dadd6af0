// (the controller's types) => (LCM messages, msgs/) for log and network, and back for a replay. Filling a message that
// was filled before allocates nothing, text of a fault apart. Not for a real-time thread.
#pragma once

#include <cstdint>

#include "control/controller_outbox.hpp"
#include "control/tick_record.hpp"
#include "model/ground_truth.hpp"
#include "model/robot_model.hpp"
#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/arms_input_t.hpp"
#include "pmg_msgs/arms_state_t.hpp"
#include "pmg_msgs/arms_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/limited_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "recording/bus_timing.hpp"
#include "recording/run_info.hpp"

namespace pmg::recording {

void fill(const RunInfo& run, const model::RobotModel& robot, double control_rate_Hz, std::int64_t stamp_ns,
          pmg_msgs::robot_info_t& message);
/// joint_count is the robot's: a vector that a broken state left short is filled up with NaN.
void fill(const control::TickRecord& record, int joint_count, pmg_msgs::robot_state_t& message);
void fill(const control::TickRecord& record, int joint_count, pmg_msgs::reference_t& message);
void fill(const control::TickRecord& record, int joint_count, pmg_msgs::motor_command_t& message);
void fill(const control::TickRecord& record, const RunInfo& run, const model::RobotModel& robot,
          pmg_msgs::status_t& message);
void fill(const control::TickRecord& record, pmg_msgs::limited_t& message);
void fill(const control::TickRecord& record, pmg_msgs::tick_input_t& message);
void fill(const control::TickRecord& record, pmg_msgs::arms_input_t& message);
void fill(const control::TickRecord& record, const RunInfo& run, pmg_msgs::arms_state_t& message);
void fill(const control::TickRecord& record, const BusTiming& bus, const control::DroppedItems& dropped,
          pmg_msgs::timing_t& message);
/// The fault of a tick in mode Fault.
void fill(const control::TickRecord& record, const RunInfo& run, const model::RobotModel& robot,
          pmg_msgs::fault_t& message);
void fill(const control::DriveMessage& drive, const RunInfo& run, pmg_msgs::command_t& message);
void fill(const control::ModeRequest& request, const RunInfo& run, pmg_msgs::mode_t& message);
void fill(const control::ArmsMessage& arms, const RunInfo& run, pmg_msgs::arms_t& message);
void fill(const control::ModeAck& ack, const RunInfo& run, std::int64_t stamp_ns, pmg_msgs::ack_t& message);
void fill(std::int64_t stamp_ns, const model::GroundTruth& truth, bool hoisted, pmg_msgs::ground_truth_t& message);

/// The other way: the values as they are. Unchecked: a caller that hears strangers validates first.
control::DriveMessage drive_message(const pmg_msgs::command_t& message, std::int64_t received_ns);
control::ModeRequest mode_request(const pmg_msgs::mode_t& message, std::int64_t received_ns);
control::ArmsMessage arms_message(const pmg_msgs::arms_t& message, std::int64_t received_ns);
/// False when the message's vectors don't have joint_count entries each.
bool robot_state(const pmg_msgs::robot_state_t& message, int joint_count, model::RobotState& state);

}  // namespace pmg::recording
