#include "recording/tick_messages.hpp"

#include <algorithm>
#include <cmath>

#include "recording/message_copy.hpp"

namespace pmg::recording {

namespace {

/// Each value of an operator's message beside its field, for both ways.
template <typename Way, typename Request, typename Message>
void pair_sender(Way& way, Request& request, Message& message) {
  way(request.source, message.source, message.session);
  way(request.sequence, message.sequence);
  way(request.stamp_ns, message.stamp_ns);
}
template <typename Way, typename Drive, typename Message>
void pair_drive(Way& way, Drive& drive, Message& message) {
  pair_sender(way, drive, message);
  way(drive.lease_s, message.lease_s);
  auto& u = drive.command.u;
  way(u[kVx], message.vx_m_s);
  way(u[kVy], message.vy_m_s);
  way(u[kOmega], message.omega_rad_s);
  way(u[kPitch], message.pitch_rad);
  way(u[kRoll], message.roll_rad);
  way(u[kHeight], message.height_m);
}
template <typename Way, typename Request, typename Message>
void pair_request(Way& way, Request& request, Message& message) {
  pair_sender(way, request, message);
  way(request.mode, message.mode);
  way(request.reset_fault, message.reset_fault);
}
template <typename Way, typename Arms, typename Message>
void pair_arms(Way& way, Arms& arms, Message& message) {
  pair_sender(way, arms, message);
  way(arms.lease_s, message.lease_s);
  auto& [left, right] = arms.arm;
  way(left.wish, message.left);
  way(left.palm.p_m, message.left_p_m);
  way(left.palm.R, message.left_orientation);
  way(right.wish, message.right);
  way(right.palm.p_m, message.right_p_m);
  way(right.palm.R, message.right_orientation);
}
template <typename Way, typename State, typename Message>
void pair_state(Way& way, State& state, Message& message) {
  way(state.stamp_ns, message.stamp_ns);
  way(state.bus_sample, message.bus_sample);
  way(state.q, message.q_rad);
  way(state.dq, message.dq_rad_s);
  way(state.tau, message.torque_Nm);
  way(state.temperature_degC, message.temperature_degC);
  way(state.gyro_rad_s, message.gyro_rad_s);
  way(state.acceleration_m_s2, message.acceleration_m_s2);
  way(state.orientation_WI, message.orientation_WI);
}

}  // namespace

void fill(const RunInfo& run, const model::RobotModel& robot, double control_rate_Hz, std::int64_t stamp_ns,
          pmg_msgs::robot_info_t& message) {
  const ToMessage copy{robot.joint_index.size()};
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
  message.joint_count = copy.joint_count;
  message.joint_names = robot.joint_index.names();
  copy(robot.q_lower(), message.lower_rad);
  copy(robot.q_upper(), message.upper_rad);
  copy(robot.q_stand(), message.stand_rad);
  message.standing_height_m = robot.standing_height_m;
  message.control_rate_hz = control_rate_Hz;
}

void fill(const control::TickRecord& record, int joint_count, pmg_msgs::robot_state_t& message) {
  message.joint_count = joint_count;
  const ToMessage copy{joint_count};
  pair_state(copy, record.state, message);
}

void fill(const control::TickRecord& record, int joint_count, pmg_msgs::reference_t& message) {
  const Reference& reference = record.result.reference;
  const gco::Result& optimised = record.result.optimised;
  const ToMessage copy{joint_count};
  message.stamp_ns = record.now_ns;
  message.joint_count = joint_count;
  copy(reference.q, message.q_ref_rad);
  copy(reference.dq, message.dq_ref_rad_s);
  message.phase = reference.phase;
  message.phase_rate_per_s = reference.phase_rate_per_s;
  message.gain = reference.gain;
  copy(reference.contact_center, message.contact_center);
  copy(reference.duty_factor, message.duty_factor);
  copy(reference.contact, message.contact);
  copy(reference.contact_weight, message.contact_weight);
  copy(record.result.user, message.user);
  copy(user_command(reference), message.command);
  copy(optimised.command, message.optimised);
  message.vz_m_s = optimised.vz_m_s;
  message.height_deficit_m = optimised.height_deficit_m;
  for (const std::size_t foot : {kLeft, kRight}) {
    message.slip_before_m_s[foot] = optimised.foot[foot].before_m_s;
    message.slip_after_m_s[foot] = optimised.foot[foot].after_m_s;
    message.yaw_slip_after_rad_s[foot] = optimised.foot[foot].yaw_rate_after_rad_s;
    message.foot_height_m[foot] = optimised.foot[foot].height_m;
  }
  copy(optimised.status, message.gco_status);
  message.command_limited = reference.command_limited;
  message.joint_clamped = reference.joint_clamped;
}

void fill(const control::TickRecord& record, int joint_count, pmg_msgs::motor_command_t& message) {
  const model::JointCommand& command = record.result.command;
  const ToMessage copy{joint_count};
  message.stamp_ns = record.now_ns;
  copy(command.bus_sample, message.bus_sample);
  message.joint_count = joint_count;
  copy(command.q, message.q_rad);
  copy(command.dq, message.dq_rad_s);
  copy(command.kp, message.kp_Nm_per_rad);
  copy(command.kd, message.kd_Nm_s_per_rad);
  copy(command.tau_ff, message.torque_ff_Nm);
}

void fill(const control::TickRecord& record, const RunInfo& run, const model::RobotModel& robot,
          pmg_msgs::status_t& message) {
  const control::TickResult& result = record.result;
  const ToMessage copy;
  message.stamp_ns = record.now_ns;
  message.robot = run.robot;
  message.session = run.session;
  copy(result.mode, message.mode);
  message.fault_code = static_cast<std::int32_t>(result.fault.code);
  if (result.fault.code == faults::FaultCode::kNone) {
    message.fault.clear();
  } else {
    message.fault = (control::sitting_down(result.maker) ? "sitting down; " : "") + describe(result.fault, robot);
  }
  copy(result.driving, message.driving_source, message.driving_session);
  message.command_age_s = std::isfinite(result.command_age_s) ? result.command_age_s : -1.0;
  message.limited_position = result.limited.position;
  message.limited_rate = result.limited.rate;
  message.limited_torque = result.limited.torque;
  message.gco_held = result.optimised.status == gco::Status::kNotConverged;
  message.policy_held = result.policy_held;
  message.hanging = control::hanging(result.maker);
  message.footing_unknown = result.maker == control::TargetMaker::kReferenceUnjudged;
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
  const ToMessage copy;
  message.stamp_ns = input.now_ns;
  message.tick = record.tick;
  copy(input.bus, message.bus);
  copy(input.guard_trip, message.guard_trip);
  message.stop = input.stop;
  message.late_ns = input.late_ns;
  message.policy_late = input.policy_late;
  message.command_count = static_cast<std::int32_t>(input.drives.size());
  message.command_received_ns.clear();
  for (const control::DriveMessage& drive : input.drives) message.command_received_ns.push_back(drive.received_ns);
  message.request_count = static_cast<std::int32_t>(input.requests.size());
  message.request_received_ns.clear();
  message.request_heard_ns.clear();
  for (const control::ModeRequest& request : input.requests) {
    message.request_received_ns.push_back(request.received_ns);
    message.request_heard_ns.push_back(request.heard_ns);
  }
}

void fill(const control::TickRecord& record, pmg_msgs::arms_input_t& message) {
  const control::TickInput input = record.input();
  message.stamp_ns = input.now_ns;
  message.count = static_cast<std::int32_t>(input.arms.size());
  message.received_ns.clear();
  for (const control::ArmsMessage& arms : input.arms) message.received_ns.push_back(arms.received_ns);
}

void fill(const control::TickRecord& record, const RunInfo& run, pmg_msgs::arms_state_t& message) {
  const control::ArmsState& arms = record.result.arms;
  const auto& [left, right] = arms.arm;
  const ToMessage copy;
  message.stamp_ns = record.now_ns;
  message.robot = run.robot;
  copy(arms.order, message.order);
  copy(arms.source, message.source, message.session);
  message.sequence = arms.sequence;
  message.refused = arms.refused;
  copy(arms.refusal, message.last_refusal);
  copy(left.activity, message.left);
  copy(left.reached, message.left_reached);
  message.left_error_m = left.position_error_m;
  message.left_error_rad = left.turn_error_rad;
  copy(left.palm.p_m, message.left_p_m);
  copy(left.palm.R, message.left_orientation);
  copy(right.activity, message.right);
  copy(right.reached, message.right_reached);
  message.right_error_m = right.position_error_m;
  message.right_error_rad = right.turn_error_rad;
  copy(right.palm.p_m, message.right_p_m);
  copy(right.palm.R, message.right_orientation);
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
  const faults::Fault& fault = record.result.fault;
  message.robot = run.robot;
  message.stamp_ns = fault.stamp_ns;
  message.code = static_cast<std::int32_t>(fault.code);
  message.text = describe(fault, robot);
}

void fill(const control::DriveMessage& drive, const RunInfo& run, pmg_msgs::command_t& message) {
  message.version = pmg_msgs::command_t::VERSION;
  message.robot = run.robot;
  const ToMessage copy;
  pair_drive(copy, drive, message);
}

void fill(const control::ModeRequest& request, const RunInfo& run, pmg_msgs::mode_t& message) {
  message.version = pmg_msgs::mode_t::VERSION;
  if (!request.sealed) message.version = pmg_msgs::mode_t::UNSEALED;
  message.robot = run.robot;
  const ToMessage copy;
  pair_request(copy, request, message);
}

void fill(const control::ArmsMessage& arms, const RunInfo& run, pmg_msgs::arms_t& message) {
  message.version = pmg_msgs::arms_t::VERSION;
  message.robot = run.robot;
  const ToMessage copy;
  pair_arms(copy, arms, message);
}

void fill(const control::ModeAck& ack, const RunInfo& run, std::int64_t stamp_ns, pmg_msgs::ack_t& message) {
  message.stamp_ns = stamp_ns;
  message.robot = run.robot;
  message.sequence = ack.sequence;
  const ToMessage copy;
  copy(ack.source, message.source, message.session);
  std::ranges::copy(ack.digest, message.digest);
  copy(ack.verdict, message.verdict);
  copy(ack.mode, message.mode);
}

void fill(std::int64_t stamp_ns, const model::GroundTruth& truth, bool hoisted, pmg_msgs::ground_truth_t& message) {
  message.stamp_ns = stamp_ns;
  const ToMessage copy;
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
  FromMessage take;
  pair_drive(take, drive, message);
  drive.received_ns = received_ns;
  return drive;
}

control::ModeRequest mode_request(const pmg_msgs::mode_t& message, std::int64_t received_ns) {
  control::ModeRequest request;
  FromMessage take;
  pair_request(take, request, message);
  request.sealed = message.version != pmg_msgs::mode_t::UNSEALED;
  request.received_ns = received_ns;
  return request;
}

control::ArmsMessage arms_message(const pmg_msgs::arms_t& message, std::int64_t received_ns) {
  control::ArmsMessage arms;
  FromMessage take;
  pair_arms(take, arms, message);
  arms.received_ns = received_ns;
  return arms;
}

bool robot_state(const pmg_msgs::robot_state_t& message, int joint_count, model::RobotState& state) {
  FromMessage take{.joint_count = joint_count};
  pair_state(take, state, message);
  return take.complete;
}

}  // namespace pmg::recording
