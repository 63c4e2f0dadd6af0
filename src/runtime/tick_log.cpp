#include "runtime/tick_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"

namespace pmg::runtime {

namespace {

/// A vector that a broken state left short is filled up with NaN: the message's length is fixed.
void copy(const JointVector& from, int joint_count, std::vector<double>& to) {
  to.assign(from.data(), from.data() + from.size());
  to.resize(static_cast<std::size_t>(joint_count), std::numeric_limits<double>::quiet_NaN());
}
void copy(const Command& from, double (&to)[kChannels]) { std::ranges::copy(from.u, to); }
template <typename T, typename U>
void copy(const PerFoot<T>& from, U (&to)[2]) {
  for (const std::size_t foot : {kLeft, kRight}) to[foot] = from[foot];
}
void copy(const Eigen::Vector3d& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }
void copy(const Eigen::Quaterniond& from, double (&to)[4]) {
  to[0] = from.w();
  to[1] = from.x();
  to[2] = from.y();
  to[3] = from.z();
}

template <typename From, typename Message>
void copy_sender(const From& from, Message& message) {
  message.stamp_ns = from.stamp_ns;
  message.source = from.source.name.data();
  message.session = from.source.session;
  message.sequence = from.sequence;
}

}  // namespace

TickLog::TickLog(io::LogWriter& writer, const model::RobotModel& robot, double control_rate_Hz)
    : writer_(writer), robot_(robot) {
  const int n = robot.joint_index.size();
  pmg_msgs::robot_info_t info;
  info.stamp_ns = 0;
  info.robot = info.model = robot.name;
  info.joint_count = n;
  info.joint_names = robot.joint_index.names();
  copy(robot.q_lower(), n, info.lower_rad);
  copy(robot.q_upper(), n, info.upper_rad);
  copy(robot.q_stand(), n, info.stand_rad);
  info.standing_height_m = robot.standing_height_m;
  info.control_rate_hz = control_rate_Hz;
  writer_.write("ROBOT_INFO", 0, info);
  state_.joint_count = reference_.joint_count = motor_command_.joint_count = n;
}

void TickLog::write(const TickRecord& record) {
  const TickResult& result = record.result;
  write_state(record.now_ns, record.state);
  write_input(record);
  write_reference(record.now_ns, result);
  write_command(record.now_ns, result.command);
  write_status(record.now_ns, result);
  if (result.mode == Mode::kFault && last_mode_ != Mode::kFault) {
    pmg_msgs::fault_t fault;
    fault.robot = robot_.name;
    fault.stamp_ns = result.fault.stamp_ns;
    fault.code = static_cast<std::int32_t>(result.fault.code);
    fault.text = describe(result.fault, robot_);
    writer_.write("FAULT", record.now_ns, fault);
  }
  last_mode_ = result.mode;
}

void TickLog::write_input(const TickRecord& record) {
  input_.command_received_ns.clear();
  input_.request_received_ns.clear();
  for (const DriveMessage& drive : record.input().drives) {
    input_.command_received_ns.push_back(drive.received_ns);
    copy_sender(drive, command_);
    command_.lease_s = drive.lease_s;
    const Command& u = drive.command;
    command_.vx_m_s = u[kVx];
    command_.vy_m_s = u[kVy];
    command_.omega_rad_s = u[kOmega];
    command_.pitch_rad = u[kPitch];
    command_.roll_rad = u[kRoll];
    command_.height_m = u[kHeight];
    writer_.write("COMMAND", record.now_ns, command_);
  }
  for (const ModeRequest& request : record.input().requests) {
    input_.request_received_ns.push_back(request.received_ns);
    copy_sender(request, mode_);
    mode_.mode = static_cast<std::int8_t>(request.mode);
    mode_.reset_fault = request.reset_fault;
    writer_.write("MODE", record.now_ns, mode_);
  }
  input_.stamp_ns = record.now_ns;
  input_.bus = static_cast<std::int8_t>(record.bus);
  input_.guard_trip = static_cast<std::int8_t>(record.guard_trip);
  input_.stop = record.stop;
  input_.late_ns = record.late_ns;
  input_.command_count = static_cast<std::int32_t>(record.drive_count);
  input_.request_count = static_cast<std::int32_t>(record.request_count);
  writer_.write("TICK", record.now_ns, input_);
}

void TickLog::write_state(std::int64_t stamp_ns, const model::RobotState& state) {
  state_.stamp_ns = state.stamp_ns;
  state_.bus_sample = static_cast<std::int64_t>(state.bus_sample);
  copy(state.q, state_.joint_count, state_.q_rad);
  copy(state.dq, state_.joint_count, state_.dq_rad_s);
  copy(state.tau, state_.joint_count, state_.torque_Nm);
  copy(state.temperature_degC, state_.joint_count, state_.temperature_degC);
  copy(state.gyro_rad_s, state_.gyro_rad_s);
  copy(state.acceleration_m_s2, state_.acceleration_m_s2);
  copy(state.orientation_WI, state_.orientation_WI);
  writer_.write("STATE", stamp_ns, state_);
}

void TickLog::write_reference(std::int64_t stamp_ns, const TickResult& result) {
  const Reference& reference = result.reference;
  const gco::Result& optimised = result.optimised;
  reference_.stamp_ns = stamp_ns;
  copy(reference.q, reference_.joint_count, reference_.q_ref_rad);
  copy(reference.dq, reference_.joint_count, reference_.dq_ref_rad_s);
  reference_.phase = reference.phase;
  reference_.phase_rate_per_s = reference.phase_rate_per_s;
  reference_.gain = reference.gain;
  copy(reference.contact_center, reference_.contact_center);
  copy(reference.duty_factor, reference_.duty_factor);
  copy(reference.contact, reference_.contact);
  copy(reference.contact_weight, reference_.contact_weight);
  copy(result.user, reference_.user);
  copy(reference.command, reference_.command);
  copy(optimised.command, reference_.optimised);
  reference_.vz_m_s = optimised.vz_m_s;
  reference_.height_deficit_m = optimised.height_deficit_m;
  for (const std::size_t foot : {kLeft, kRight}) {
    reference_.slip_before_m_s[foot] = optimised.foot[foot].before_m_s;
    reference_.slip_after_m_s[foot] = optimised.foot[foot].after_m_s;
    reference_.yaw_slip_after_rad_s[foot] = optimised.foot[foot].yaw_rate_after_rad_s;
    reference_.foot_height_m[foot] = optimised.foot[foot].height_m;
  }
  reference_.gco_status = static_cast<std::int8_t>(optimised.status);
  reference_.command_limited = reference.command_limited;
  reference_.joint_clamped = reference.joint_clamped;
  writer_.write("REFERENCE", stamp_ns, reference_);
}

void TickLog::write_command(std::int64_t stamp_ns, const model::JointCommand& command) {
  motor_command_.stamp_ns = stamp_ns;
  motor_command_.bus_sample = static_cast<std::int64_t>(command.bus_sample);
  copy(command.q, motor_command_.joint_count, motor_command_.q_rad);
  copy(command.dq, motor_command_.joint_count, motor_command_.dq_rad_s);
  copy(command.kp, motor_command_.joint_count, motor_command_.kp_Nm_per_rad);
  copy(command.kd, motor_command_.joint_count, motor_command_.kd_Nm_s_per_rad);
  copy(command.tau_ff, motor_command_.joint_count, motor_command_.torque_ff_Nm);
  writer_.write("MOTOR_COMMAND", stamp_ns, motor_command_);
}

void TickLog::write_status(std::int64_t stamp_ns, const TickResult& result) {
  status_.stamp_ns = stamp_ns;
  status_.mode = static_cast<std::int8_t>(result.mode);
  status_.fault_code = static_cast<std::int32_t>(result.fault.code);
  status_.driving_source = result.driving.name.data();
  status_.command_age_s = std::isfinite(result.command_age_s) ? result.command_age_s : -1.0;
  status_.limited_position = result.limited.position;
  status_.limited_rate = result.limited.rate;
  status_.limited_torque = result.limited.torque;
  status_.gco_held = result.optimised.status == gco::Status::kNotConverged;
  writer_.write("STATUS", stamp_ns, status_);
}

void TickLog::write_truth(std::int64_t stamp_ns, const sim::Truth& truth, bool hoisted) {
  truth_.stamp_ns = stamp_ns;
  copy(truth.p_WB, truth_.p_WB_m);
  copy(truth.q_WB, truth_.q_WB);
  copy(truth.v_WB_W, truth_.v_WB_W_m_s);
  copy(truth.omega_WB_B, truth_.omega_WB_B_rad_s);
  copy(truth.q_WT, truth_.q_WT);
  copy(truth.foot_force_N, truth_.foot_force_N);
  copy(truth.foot_slip_m_s, truth_.foot_slip_m_s);
  truth_.hoisted = hoisted;
  writer_.write("GROUND_TRUTH", stamp_ns, truth_);
}

}  // namespace pmg::runtime
