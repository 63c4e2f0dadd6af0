#include "runtime/tick_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pmg::runtime {

namespace {

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
void copy_sender(const From& from, const RunInfo& run, Message& message) {
  message.version = Message::VERSION;
  message.robot = run.robot;
  message.stamp_ns = from.stamp_ns;
  message.source = from.source.name.data();
  message.session = from.source.session;
  message.sequence = from.sequence;
}

template <typename Message, typename To>
void take_sender(const Message& message, std::int64_t received_ns, To& to) {
  to.source = control::Source::make(message.source, message.session);
  to.sequence = message.sequence;
  to.stamp_ns = message.stamp_ns;
  to.received_ns = received_ns;
}

bool take(const std::vector<double>& from, int joint_count, JointVector& to) {
  if (std::ssize(from) != joint_count) return false;
  to = Eigen::Map<const Eigen::VectorXd>(from.data(), joint_count);
  return true;
}

}  // namespace

void fill(const RunInfo& run, const model::RobotModel& robot, double control_rate_Hz, std::int64_t stamp_ns,
          pmg_msgs::robot_info_t& message) {
  const int n = robot.joint_index.size();
  message.stamp_ns = stamp_ns;
  message.robot = run.robot;
  message.model = robot.name;
  message.session = run.session;
  message.software = software_version();
  message.policy = run.policy;
  message.backend = run.backend;
  message.options = run.options;
  message.bundle = run.bundle;
  message.bundle_count = static_cast<std::int32_t>(run.files.size());
  message.bundle_file.clear();
  message.bundle_sha256.clear();
  for (const auto& [file, sha256] : run.files) {
    message.bundle_file.push_back(file);
    message.bundle_sha256.push_back(sha256);
  }
  message.refused_count = static_cast<std::int32_t>(run.refused.size());
  message.refused = run.refused;
  message.joint_count = n;
  message.joint_names = robot.joint_index.names();
  copy(robot.q_lower(), n, message.lower_rad);
  copy(robot.q_upper(), n, message.upper_rad);
  copy(robot.q_stand(), n, message.stand_rad);
  message.standing_height_m = robot.standing_height_m;
  message.control_rate_hz = control_rate_Hz;
}

void fill(const control::TickRecord& record, int joint_count, pmg_msgs::robot_state_t& message) {
  const model::RobotState& state = record.state;
  message.stamp_ns = state.stamp_ns;
  message.bus_sample = static_cast<std::int64_t>(state.bus_sample);
  message.joint_count = joint_count;
  copy(state.q, joint_count, message.q_rad);
  copy(state.dq, joint_count, message.dq_rad_s);
  copy(state.tau, joint_count, message.torque_Nm);
  copy(state.temperature_degC, joint_count, message.temperature_degC);
  copy(state.gyro_rad_s, message.gyro_rad_s);
  copy(state.acceleration_m_s2, message.acceleration_m_s2);
  copy(state.orientation_WI, message.orientation_WI);
}

void fill(const control::TickRecord& record, int joint_count, pmg_msgs::reference_t& message) {
  const Reference& reference = record.result.reference;
  const gco::Result& optimised = record.result.optimised;
  message.stamp_ns = record.now_ns;
  message.joint_count = joint_count;
  copy(reference.q, joint_count, message.q_ref_rad);
  copy(reference.dq, joint_count, message.dq_ref_rad_s);
  message.phase = reference.phase;
  message.phase_rate_per_s = reference.phase_rate_per_s;
  message.gain = reference.gain;
  copy(reference.contact_center, message.contact_center);
  copy(reference.duty_factor, message.duty_factor);
  copy(reference.contact, message.contact);
  copy(reference.contact_weight, message.contact_weight);
  copy(record.result.user, message.user);
  copy(reference.command, message.command);
  copy(optimised.command, message.optimised);
  message.vz_m_s = optimised.vz_m_s;
  message.height_deficit_m = optimised.height_deficit_m;
  for (const std::size_t foot : {kLeft, kRight}) {
    message.slip_before_m_s[foot] = optimised.foot[foot].before_m_s;
    message.slip_after_m_s[foot] = optimised.foot[foot].after_m_s;
    message.yaw_slip_after_rad_s[foot] = optimised.foot[foot].yaw_rate_after_rad_s;
    message.foot_height_m[foot] = optimised.foot[foot].height_m;
  }
  message.gco_status = static_cast<std::int8_t>(optimised.status);
  message.command_limited = reference.command_limited;
  message.joint_clamped = reference.joint_clamped;
}

void fill(const control::TickRecord& record, int joint_count, pmg_msgs::motor_command_t& message) {
  const model::JointCommand& command = record.result.command;
  message.stamp_ns = record.now_ns;
  message.bus_sample = static_cast<std::int64_t>(command.bus_sample);
  message.joint_count = joint_count;
  copy(command.q, joint_count, message.q_rad);
  copy(command.dq, joint_count, message.dq_rad_s);
  copy(command.kp, joint_count, message.kp_Nm_per_rad);
  copy(command.kd, joint_count, message.kd_Nm_s_per_rad);
  copy(command.tau_ff, joint_count, message.torque_ff_Nm);
}

void fill(const control::TickRecord& record, const RunInfo& run, const model::RobotModel& robot,
          pmg_msgs::status_t& message) {
  const control::TickResult& result = record.result;
  message.stamp_ns = record.now_ns;
  message.robot = run.robot;
  message.session = run.session;
  message.mode = static_cast<std::int8_t>(result.mode);
  message.fault_code = static_cast<std::int32_t>(result.fault.code);
  if (result.fault.code == control::FaultCode::kNone) {
    message.fault.clear();
  } else {
    message.fault = describe(result.fault, robot);
  }
  message.driving_source = result.driving.name.data();
  message.command_age_s = std::isfinite(result.command_age_s) ? result.command_age_s : -1.0;
  message.limited_position = result.limited.position;
  message.limited_rate = result.limited.rate;
  message.limited_torque = result.limited.torque;
  message.gco_held = result.optimised.status == gco::Status::kNotConverged;
  message.policy_held = result.policy_held;
  message.hanging = result.hanging;
  message.footing_unknown = result.footing_unknown;
  copy(result.foot_load.value_or(PerFoot<double>{-1.0, -1.0}), message.foot_load);
  message.realtime = run.realtime;
}

void fill(const control::TickRecord& record, pmg_msgs::limited_t& message) {
  const auto& by = record.result.limited.by;
  message.stamp_ns = record.now_ns;
  message.joint.clear();
  message.by.clear();
  for (std::size_t joint = 0; joint < by.size(); ++joint) {
    if (by[joint] == 0) continue;
    message.joint.push_back(static_cast<std::int32_t>(joint));
    message.by.push_back(static_cast<std::int8_t>(by[joint]));
  }
  message.count = static_cast<std::int32_t>(message.joint.size());
}

void fill(const control::TickRecord& record, pmg_msgs::tick_input_t& message) {
  const control::TickInput input = record.input();
  message.stamp_ns = input.now_ns;
  message.tick = record.tick;
  message.bus = static_cast<std::int8_t>(input.bus);
  message.guard_trip = static_cast<std::int8_t>(input.guard_trip);
  message.stop = input.stop;
  message.late_ns = input.late_ns;
  message.policy_late = input.policy_late;
  message.command_count = static_cast<std::int32_t>(input.drives.size());
  message.command_received_ns.clear();
  for (const control::DriveMessage& drive : input.drives) message.command_received_ns.push_back(drive.received_ns);
  message.request_count = static_cast<std::int32_t>(input.requests.size());
  message.request_received_ns.clear();
  for (const control::ModeRequest& request : input.requests) message.request_received_ns.push_back(request.received_ns);
}

void fill(const control::TickRecord& record, const BusTiming& bus, const control::DroppedItems& dropped,
          pmg_msgs::timing_t& message) {
  const control::CycleTiming& timing = record.timing;
  const control::StageTimes& times = record.result.times;
  message.stamp_ns = record.now_ns;
  message.wake_ns = timing.woke_ns - timing.planned_ns;
  message.tick_ns = times.tick_ns;
  message.generator_ns = times.generator_ns;
  message.gco_ns = times.gco_ns;
  message.policy_ns = times.policy_ns;
  message.missed_ticks = timing.missed;
  message.bus_cycles = bus.cycles;
  message.bus_wake_max_ns = bus.wake_max_ns;
  message.bus_exchange_max_ns = bus.exchange_max_ns;
  message.bus_missed_cycles = bus.missed;
  message.dropped_records = dropped.records;
  message.dropped_bus_cycles = dropped.bus_cycles;
  message.dropped_acks = dropped.acks;
}

void fill(const control::TickRecord& record, const RunInfo& run, const model::RobotModel& robot,
          pmg_msgs::fault_t& message) {
  const control::Fault& fault = record.result.fault;
  message.robot = run.robot;
  message.stamp_ns = fault.stamp_ns;
  message.code = static_cast<std::int32_t>(fault.code);
  message.text = describe(fault, robot);
}

void fill(const control::DriveMessage& drive, const RunInfo& run, pmg_msgs::command_t& message) {
  copy_sender(drive, run, message);
  message.lease_s = drive.lease_s;
  const Command& u = drive.command;
  message.vx_m_s = u[kVx];
  message.vy_m_s = u[kVy];
  message.omega_rad_s = u[kOmega];
  message.pitch_rad = u[kPitch];
  message.roll_rad = u[kRoll];
  message.height_m = u[kHeight];
}

void fill(const control::ModeRequest& request, const RunInfo& run, pmg_msgs::mode_t& message) {
  copy_sender(request, run, message);
  message.mode = static_cast<std::int8_t>(request.mode);
  message.reset_fault = request.reset_fault;
}

void fill(const control::ModeAck& ack, const RunInfo& run, std::int64_t stamp_ns, pmg_msgs::ack_t& message) {
  message.stamp_ns = stamp_ns;
  message.robot = run.robot;
  message.source = ack.source.name.data();
  message.session = ack.source.session;
  message.sequence = ack.sequence;
  message.verdict = static_cast<std::int8_t>(ack.verdict);
  message.mode = static_cast<std::int8_t>(ack.mode);
}

void fill(std::int64_t stamp_ns, const model::GroundTruth& truth, bool hoisted, pmg_msgs::ground_truth_t& message) {
  message.stamp_ns = stamp_ns;
  copy(truth.p_WB, message.p_WB_m);
  copy(truth.q_WB, message.q_WB);
  copy(truth.v_WB_W, message.v_WB_W_m_s);
  copy(truth.omega_WB_B, message.omega_WB_B_rad_s);
  copy(truth.q_WT, message.q_WT);
  copy(truth.foot_force_N, message.foot_force_N);
  copy(truth.foot_slip_m_s, message.foot_slip_m_s);
  message.hoisted = hoisted;
}

control::DriveMessage drive_message(const pmg_msgs::command_t& message, std::int64_t received_ns) {
  control::DriveMessage drive;
  take_sender(message, received_ns, drive);
  drive.lease_s = message.lease_s;
  drive.command = {.u = {message.vx_m_s, message.vy_m_s, message.omega_rad_s, message.pitch_rad, message.roll_rad,
                         message.height_m}};
  return drive;
}

control::ModeRequest mode_request(const pmg_msgs::mode_t& message, std::int64_t received_ns) {
  control::ModeRequest request;
  take_sender(message, received_ns, request);
  request.mode = static_cast<control::Mode>(message.mode);
  request.reset_fault = message.reset_fault != 0;
  return request;
}

bool robot_state(const pmg_msgs::robot_state_t& message, int joint_count, model::RobotState& state) {
  state.stamp_ns = message.stamp_ns;
  state.bus_sample = static_cast<std::uint64_t>(message.bus_sample);
  state.gyro_rad_s = Eigen::Map<const Eigen::Vector3d>(message.gyro_rad_s);
  state.acceleration_m_s2 = Eigen::Map<const Eigen::Vector3d>(message.acceleration_m_s2);
  const double* q = message.orientation_WI;
  state.orientation_WI = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  return take(message.q_rad, joint_count, state.q) && take(message.dq_rad_s, joint_count, state.dq) &&
         take(message.torque_Nm, joint_count, state.tau) &&
         take(message.temperature_degC, joint_count, state.temperature_degC);
}

}  // namespace pmg::runtime
