#include "logs/message_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstddef>
#include <exception>

#include "pmg/command.hpp"
#include "pmg_msgs/ack_t.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/hoist_state_t.hpp"
#include "pmg_msgs/hoist_t.hpp"
#include "pmg_msgs/limited_t.hpp"
#include "pmg_msgs/link_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/scenario_step_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "pmg_msgs/timing_t.hpp"

namespace pmg::logs {

namespace {

constexpr std::array<std::string_view, 2> kFeet = {"left", "right"};
constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
constexpr std::array<std::string_view, 4> kQuaternion = {"w", "x", "y", "z"};

/// Gathers fields; one method a kind of field.
class Gatherer {
 public:
  Gatherer(const std::vector<std::string>& joint_names, std::vector<Field>& fields)
      : joint_names_(joint_names), fields_(fields) {
    fields_.clear();
  }

  void number(const char* name, std::int64_t value) { fields_.push_back({name, {}, value}); }
  void real(const char* name, double value) { fields_.push_back({name, {}, value}); }
  void flag(const char* name, std::int8_t value) { fields_.push_back({name, {}, value != 0}); }
  void text(const char* name, const std::string& value) { fields_.push_back({name, {}, value}); }
  template <typename T>
  void list(const char* name, const std::vector<T>& values) {
    std::vector<std::string> texts;
    for (const T& value : values) texts.push_back(fmt::format("{}", value));
    fields_.push_back({name, {}, std::move(texts)});
  }
  void joints(const char* name, const std::vector<double>& values) {
    const bool named = values.size() == joint_names_.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
      fields_.push_back({name, named ? joint_names_[i] : std::to_string(i), values[i]});
    }
  }
  template <typename Elements, std::size_t N>
  void vector(const char* name, const double (&values)[N], const Elements& elements) {
    static_assert(std::tuple_size_v<Elements> == N);
    for (std::size_t i = 0; i < N; ++i) fields_.push_back({name, std::string(elements[i]), values[i]});
  }
  void flags(const char* name, const std::int8_t (&values)[2]) {
    for (std::size_t i = 0; i < 2; ++i) fields_.push_back({name, std::string(kFeet[i]), values[i] != 0});
  }
  /// What command_t and mode_t begin with.
  template <typename Message>
  void sender(const Message& m) {
    number("version", m.version);
    text("robot", m.robot);
    number("stamp_ns", m.stamp_ns);
    text("source", m.source);
    number("session", m.session);
    number("sequence", m.sequence);
  }

 private:
  const std::vector<std::string>& joint_names_;
  std::vector<Field>& fields_;
};

void gather(const pmg_msgs::robot_info_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.text("robot", m.robot);
  to.text("model", m.model);
  to.number("session", m.session);
  to.text("software", m.software);
  to.text("policy", m.policy);
  to.text("backend", m.backend);
  to.text("options", m.options);
  to.text("bundle", m.bundle);
  to.list("bundle_file", m.bundle_file);
  to.list("bundle_sha256", m.bundle_sha256);
  to.list("refused", m.refused);
  to.list("joint_names", m.joint_names);
  to.joints("lower_rad", m.lower_rad);
  to.joints("upper_rad", m.upper_rad);
  to.joints("stand_rad", m.stand_rad);
  to.real("standing_height_m", m.standing_height_m);
  to.real("control_rate_hz", m.control_rate_hz);
}

void gather(const pmg_msgs::robot_state_t& m, Gatherer& to) {
  to.text("robot", m.robot);
  to.number("stamp_ns", m.stamp_ns);
  to.number("bus_sample", m.bus_sample);
  to.joints("q_rad", m.q_rad);
  to.joints("dq_rad_s", m.dq_rad_s);
  to.joints("torque_Nm", m.torque_Nm);
  to.joints("temperature_degC", m.temperature_degC);
  to.vector("gyro_rad_s", m.gyro_rad_s, kAxes);
  to.vector("acceleration_m_s2", m.acceleration_m_s2, kAxes);
  to.vector("orientation_WI", m.orientation_WI, kQuaternion);
}

void gather(const pmg_msgs::command_t& m, Gatherer& to) {
  to.sender(m);
  to.real("lease_s", m.lease_s);
  to.real("vx_m_s", m.vx_m_s);
  to.real("vy_m_s", m.vy_m_s);
  to.real("omega_rad_s", m.omega_rad_s);
  to.real("pitch_rad", m.pitch_rad);
  to.real("roll_rad", m.roll_rad);
  to.real("height_m", m.height_m);
}

void gather(const pmg_msgs::mode_t& m, Gatherer& to) {
  to.sender(m);
  to.number("mode", m.mode);
  to.flag("reset_fault", m.reset_fault);
}

void gather(const pmg_msgs::tick_input_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.number("tick", m.tick);
  to.number("bus", m.bus);
  to.number("guard_trip", m.guard_trip);
  to.flag("stop", m.stop);
  to.number("late_ns", m.late_ns);
  to.flag("policy_late", m.policy_late);
  to.list("command_received_ns", m.command_received_ns);
  to.list("request_received_ns", m.request_received_ns);
}

void gather(const pmg_msgs::reference_t& m, Gatherer& to) {
  to.text("robot", m.robot);
  to.number("stamp_ns", m.stamp_ns);
  to.joints("q_ref_rad", m.q_ref_rad);
  to.joints("dq_ref_rad_s", m.dq_ref_rad_s);
  to.real("phase", m.phase);
  to.real("phase_rate_per_s", m.phase_rate_per_s);
  to.real("gain", m.gain);
  to.vector("contact_center", m.contact_center, kFeet);
  to.vector("duty_factor", m.duty_factor, kFeet);
  to.flags("contact", m.contact);
  to.vector("contact_weight", m.contact_weight, kFeet);
  to.vector("user", m.user, kChannelNames);
  to.vector("command", m.command, kChannelNames);
  to.vector("optimised", m.optimised, kChannelNames);
  to.real("vz_m_s", m.vz_m_s);
  to.real("height_deficit_m", m.height_deficit_m);
  to.vector("slip_before_m_s", m.slip_before_m_s, kFeet);
  to.vector("slip_after_m_s", m.slip_after_m_s, kFeet);
  to.vector("yaw_slip_after_rad_s", m.yaw_slip_after_rad_s, kFeet);
  to.vector("foot_height_m", m.foot_height_m, kFeet);
  to.number("gco_status", m.gco_status);
  to.flag("command_limited", m.command_limited);
  to.flag("joint_clamped", m.joint_clamped);
}

void gather(const pmg_msgs::motor_command_t& m, Gatherer& to) {
  to.text("robot", m.robot);
  to.number("stamp_ns", m.stamp_ns);
  to.number("bus_sample", m.bus_sample);
  to.joints("q_rad", m.q_rad);
  to.joints("dq_rad_s", m.dq_rad_s);
  to.joints("kp_Nm_per_rad", m.kp_Nm_per_rad);
  to.joints("kd_Nm_s_per_rad", m.kd_Nm_s_per_rad);
  to.joints("torque_ff_Nm", m.torque_ff_Nm);
}

void gather(const pmg_msgs::status_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.text("robot", m.robot);
  to.number("session", m.session);
  to.number("mode", m.mode);
  to.number("fault_code", m.fault_code);
  to.text("fault", m.fault);
  to.text("driving_source", m.driving_source);
  to.real("command_age_s", m.command_age_s);
  to.number("limited_position", m.limited_position);
  to.number("limited_rate", m.limited_rate);
  to.number("limited_torque", m.limited_torque);
  to.flag("gco_held", m.gco_held);
  to.flag("policy_held", m.policy_held);
  to.flag("hanging", m.hanging);
  to.flag("footing_unknown", m.footing_unknown);
  to.vector("foot_load", m.foot_load, kFeet);
  to.flag("realtime", m.realtime);
}

void gather(const pmg_msgs::limited_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.list("joint", m.joint);
  to.list("by", m.by);
}

void gather(const pmg_msgs::scenario_step_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.text("scenario", m.scenario);
  to.number("number", m.number);
  to.number("step_count", m.step_count);
  to.real("duration_s", m.duration_s);
  to.text("text", m.text);
  to.number("mode", m.mode);
  to.vector("command", m.command, kChannelNames);
}

void gather(const pmg_msgs::fault_t& m, Gatherer& to) {
  to.text("robot", m.robot);
  to.number("stamp_ns", m.stamp_ns);
  to.number("code", m.code);
  to.text("text", m.text);
}

void gather(const pmg_msgs::timing_t& m, Gatherer& to) {
  to.text("robot", m.robot);
  to.number("stamp_ns", m.stamp_ns);
  to.number("wake_ns", m.wake_ns);
  to.number("tick_ns", m.tick_ns);
  to.number("generator_ns", m.generator_ns);
  to.number("gco_ns", m.gco_ns);
  to.number("policy_ns", m.policy_ns);
  to.number("missed_ticks", m.missed_ticks);
  to.number("bus_cycles", m.bus_cycles);
  to.number("bus_wake_max_ns", m.bus_wake_max_ns);
  to.number("bus_exchange_max_ns", m.bus_exchange_max_ns);
  to.number("bus_missed_cycles", m.bus_missed_cycles);
  to.number("dropped_records", m.dropped_records);
  to.number("dropped_bus_cycles", m.dropped_bus_cycles);
  to.number("dropped_acks", m.dropped_acks);
}

void gather(const pmg_msgs::ground_truth_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.vector("p_WB_m", m.p_WB_m, kAxes);
  to.vector("q_WB", m.q_WB, kQuaternion);
  to.vector("v_WB_W_m_s", m.v_WB_W_m_s, kAxes);
  to.vector("omega_WB_B_rad_s", m.omega_WB_B_rad_s, kAxes);
  to.vector("q_WT", m.q_WT, kQuaternion);
  to.vector("foot_force_N", m.foot_force_N, kFeet);
  to.vector("foot_slip_m_s", m.foot_slip_m_s, kFeet);
  to.flag("hoisted", m.hoisted);
}

void gather(const pmg_msgs::ack_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.text("robot", m.robot);
  to.text("source", m.source);
  to.number("session", m.session);
  to.number("sequence", m.sequence);
  to.number("verdict", m.verdict);
  to.number("mode", m.mode);
}

void gather(const pmg_msgs::link_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.text("robot", m.robot);
  to.number("accepted", m.accepted);
  to.number("malformed", m.malformed);
  to.number("other_version", m.other_version);
  to.number("other_robot", m.other_robot);
  to.number("flooded", m.flooded);
  to.number("other_source", m.other_source);
  to.number("out_of_order", m.out_of_order);
  to.number("late", m.late);
  to.number("not_finite", m.not_finite);
  to.number("no_lease", m.no_lease);
  to.number("no_hoist", m.no_hoist);
}

void gather(const pmg_msgs::hoist_t& m, Gatherer& to) {
  to.number("version", m.version);
  to.text("robot", m.robot);
  to.number("stamp_ns", m.stamp_ns);
  to.text("source", m.source);
  to.number("session", m.session);
  to.number("sequence", m.sequence);
  to.number("request", m.request);
}

void gather(const pmg_msgs::hoist_state_t& m, Gatherer& to) {
  to.number("stamp_ns", m.stamp_ns);
  to.text("robot", m.robot);
  to.number("state", m.state);
  to.number("stays_up", m.stays_up);
  to.text("source", m.source);
  to.number("session", m.session);
  to.number("sequence", m.sequence);
}

using Bytes = std::vector<std::uint8_t>;
using Names = std::vector<std::string>;

template <typename Message>
bool read(const Bytes& data, const Names& joint_names, std::vector<Field>& fields) {
  static thread_local Message message;  // its memory is used again
  try {
    if (message.decode(data.data(), 0, static_cast<int>(data.size())) < 0) return false;
  } catch (const std::exception&) {  // a length that no memory has: damaged bytes
    return false;
  }
  Gatherer to(joint_names, fields);
  gather(message, to);
  return true;
}

using Read = bool (*)(const Bytes&, const Names&, std::vector<Field>&);
constexpr std::array<std::string_view, 17> kChannelsInOrder = {
    "ROBOT_INFO", "SCENARIO", "STATE",  "COMMAND",      "MODE", "TICK", "REFERENCE", "MOTOR_COMMAND", "STATUS",
    "LIMITED",    "FAULT",    "TIMING", "GROUND_TRUTH", "ACK",  "LINK", "HOIST",     "HOIST_STATE"};
constexpr std::array<Read, 17> kReads = {
    read<pmg_msgs::robot_info_t>,   read<pmg_msgs::scenario_step_t>, read<pmg_msgs::robot_state_t>,
    read<pmg_msgs::command_t>,      read<pmg_msgs::mode_t>,          read<pmg_msgs::tick_input_t>,
    read<pmg_msgs::reference_t>,    read<pmg_msgs::motor_command_t>, read<pmg_msgs::status_t>,
    read<pmg_msgs::limited_t>,      read<pmg_msgs::fault_t>,         read<pmg_msgs::timing_t>,
    read<pmg_msgs::ground_truth_t>, read<pmg_msgs::ack_t>,           read<pmg_msgs::link_t>,
    read<pmg_msgs::hoist_t>,        read<pmg_msgs::hoist_state_t>};

struct ToText {
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return fmt::format("{}", value); }
  std::string operator()(bool value) const { return value ? "1" : "0"; }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const std::vector<std::string>& values) const {
    return fmt::format("{}", fmt::join(values, ";"));
  }
};

}  // namespace

std::string to_text(const Field::Value& value) { return std::visit(ToText{}, value); }

std::span<const std::string_view> known_channels() { return kChannelsInOrder; }

bool read_fields(std::string_view channel, const Bytes& data, const Names& joint_names, std::vector<Field>& fields) {
  for (std::size_t i = 0; i < kChannelsInOrder.size(); ++i) {
    if (channel == kChannelsInOrder[i]) return kReads[i](data, joint_names, fields);
  }
  return false;
}

}  // namespace pmg::logs
