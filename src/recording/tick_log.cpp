#include "recording/tick_log.hpp"

namespace pmg::recording {

TickLog::TickLog(io::LogWriter& writer, const model::RobotModel& robot, const RunInfo& run, double control_rate_Hz,
                 std::int64_t stamp_ns)
    : writer_(&writer), robot_(robot), run_(run), joint_count_(robot.joint_index.size()) {
  state_.robot = reference_.robot = motor_command_.robot = timing_.robot = run_.robot;
  fill(run_, robot_, control_rate_Hz, stamp_ns, info_);
  writer_->write("ROBOT_INFO", stamp_ns, info_);
}

void TickLog::continue_in(io::LogWriter& writer, std::int64_t stamp_ns) {
  writer_ = &writer;
  info_.stamp_ns = stamp_ns;
  writer_->write("ROBOT_INFO", stamp_ns, info_);
}

void TickLog::write(const control::TickRecord& record) {
  const std::int64_t stamp_ns = record.now_ns;
  fill(record, joint_count_, state_);
  writer_->write("STATE", stamp_ns, state_);
  write_input(record);
  fill(record, joint_count_, reference_);
  writer_->write("REFERENCE", stamp_ns, reference_);
  fill(record, joint_count_, motor_command_);
  writer_->write("MOTOR_COMMAND", stamp_ns, motor_command_);
  fill(record, run_, robot_, status_);
  writer_->write("STATUS", stamp_ns, status_);
  write_arms_state(record);
  fill(record, limited_);
  if (limited_.count > 0) writer_->write("LIMITED", stamp_ns, limited_);
  write_fault_once(record);
}

void TickLog::write_input(const control::TickRecord& record) {
  for (const control::DriveMessage& drive : record.input().drives) {
    fill(drive, run_, command_);
    writer_->write("COMMAND", record.now_ns, command_);
  }
  for (const control::ModeRequest& request : record.input().requests) {
    fill(request, run_, mode_);
    writer_->write("MODE", record.now_ns, mode_);
  }
  for (const control::ArmsMessage& arms : record.input().arms) {
    fill(arms, run_, arms_);
    writer_->write("ARMS", record.now_ns, arms_);
  }
  if (record.arms_count > 0) {
    fill(record, arms_input_);
    writer_->write("ARMS_INPUT", record.now_ns, arms_input_);
  }
  fill(record, input_);
  writer_->write("TICK", record.now_ns, input_);
}

void TickLog::write_arms_state(const control::TickRecord& record) {
  const bool led = control::led(record.result.arms);
  if (led || arms_led_) {
    fill(record, run_, arms_state_);
    writer_->write("ARMS_STATE", record.now_ns, arms_state_);
  }
  arms_led_ = led;
}

void TickLog::announce_fault(std::int64_t stamp_ns, const control::TickRecord& record) {
  announced_fault_ = record.result.fault;
  fill(record, run_, robot_, fault_);
  writer_->write("FAULT", stamp_ns, fault_);
}

void TickLog::write_fault_once(const control::TickRecord& record) {
  const faults::Fault& fault = record.result.fault;
  const bool latched = fault.code != faults::FaultCode::kNone && !faults::same_incident(fault, last_fault_) &&
                       !faults::same_incident(fault, announced_fault_);
  last_fault_ = fault;
  if (!latched) return;
  fill(record, run_, robot_, fault_);
  writer_->write("FAULT", record.now_ns, fault_);
}

void TickLog::write_timing(const control::TickRecord& record, const BusTiming& bus,
                           const control::DroppedItems& dropped) {
  fill(record, bus, dropped, timing_);
  writer_->write("TIMING", record.now_ns, timing_);
}

void TickLog::write_step(const pmg_msgs::scenario_step_t& step) { writer_->write("SCENARIO", step.stamp_ns, step); }

void TickLog::write_truth(std::int64_t stamp_ns, const model::GroundTruth& truth, bool hoisted) {
  fill(stamp_ns, truth, hoisted, truth_);
  writer_->write("GROUND_TRUTH", stamp_ns, truth_);
}

}  // namespace pmg::recording
