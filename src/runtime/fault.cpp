#include "runtime/fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pmg::runtime {

namespace {

constexpr std::array<const char*, kFaultCodes> kNames = {
    "none",           "bus_lost",     "stale_state", "state_not_finite", "temperature", "joint_limit",
    "joint_velocity", "joint_torque", "tilt",        "policy_not_finite"};
constexpr std::array<const char*, kFaultCodes> kUnits = {"", "", "s", "", "degC", "rad", "rad/s", "Nm", "rad", ""};

int first_not_finite(const JointVector& values) noexcept {
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    if (!std::isfinite(values[i])) return i;
  }
  return -1;
}

}  // namespace

const char* to_string(FaultCode code) noexcept { return kNames[static_cast<std::size_t>(code)]; }

std::string describe(const Fault& fault, const model::RobotModel& robot) {
  const char* unit = kUnits[static_cast<std::size_t>(fault.code)];
  std::string text = to_string(fault.code);
  if (fault.joint >= 0) text += ": " + robot.joint_index.name(fault.joint);
  if (*unit != '\0') {
    text += fmt::format("{} {:.3f} {}, limit {:.3f} {}", fault.joint >= 0 ? " at" : ":", fault.value, unit, fault.limit,
                        unit);
  }
  return text;
}

FaultDetector::FaultDetector(const model::RobotModel& robot, const FaultLimits& limits)
    : limits_(limits),
      q_lower_(robot.q_lower()),
      q_upper_(robot.q_upper()),
      velocity_limit_(q_lower_.size()),
      effort_limit_(q_lower_.size()),
      up_I_(robot.imu.T_LI.linear().transpose() * Eigen::Vector3d::UnitZ()) {
  for (int i = 0; i < static_cast<int>(q_lower_.size()); ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(i)];
    velocity_limit_[i] = joint.velocity_limit_rad_s;
    effort_limit_[i] = joint.effort_limit_Nm;
  }
}

std::optional<Fault> FaultDetector::detect(const model::RobotState& state, hal::BusStatus bus, std::int64_t now_ns,
                                           Scope scope) noexcept {
  Fault fault = check_sensing(state, bus, now_ns);
  if (fault.code == FaultCode::kNone && scope == Scope::kMotion) {
    for (const FaultCode code : {FaultCode::kJointLimit, FaultCode::kJointVelocity, FaultCode::kJointTorque}) {
      const Fault found = check_joints(code, state);
      if (persists(code, found.code != FaultCode::kNone) && fault.code == FaultCode::kNone) fault = found;
    }
    const Fault tilted = check_tilt(state);
    if (persists(FaultCode::kTilt, tilted.code != FaultCode::kNone) && fault.code == FaultCode::kNone) fault = tilted;
  } else {
    held_ticks_.fill(0);
  }
  if (fault.code == FaultCode::kNone) return std::nullopt;
  fault.stamp_ns = now_ns;
  return fault;
}

Fault FaultDetector::check_sensing(const model::RobotState& state, hal::BusStatus bus,
                                   std::int64_t now_ns) const noexcept {
  if (bus == hal::BusStatus::kLost) return {.code = FaultCode::kBusLost};
  const double age_s = static_cast<double>(now_ns - state.stamp_ns) * 1e-9;
  if (age_s > limits_.stale_state_s) {
    return {.code = FaultCode::kStaleState, .value = age_s, .limit = limits_.stale_state_s};
  }
  for (const JointVector* values : {&state.q, &state.dq, &state.tau}) {
    if (values->size() != q_lower_.size()) return {.code = FaultCode::kStateNotFinite};
    const int joint = first_not_finite(*values);
    if (joint >= 0) return {.code = FaultCode::kStateNotFinite, .joint = joint};
  }
  if (!state.gyro_rad_s.allFinite() || !state.acceleration_m_s2.allFinite() ||
      !(std::abs(state.orientation_WI.norm() - 1.0) < 0.1)) {  // catches NaN as well as an estimate that never started
    return {.code = FaultCode::kStateNotFinite};
  }
  for (int i = 0; i < static_cast<int>(state.temperature_degC.size()); ++i) {
    if (!(state.temperature_degC[i] <= limits_.temperature_degC)) {
      return {.code = FaultCode::kTemperature,
              .joint = i,
              .value = state.temperature_degC[i],
              .limit = limits_.temperature_degC};
    }
  }
  return {};
}

Fault FaultDetector::check_joints(FaultCode code, const model::RobotState& state) const noexcept {
  for (int i = 0; i < static_cast<int>(q_lower_.size()); ++i) {
    double value = 0.0, limit = 0.0;
    bool beyond = false;
    switch (code) {
      case FaultCode::kJointLimit:
        value = state.q[i];
        limit = value < q_lower_[i] ? q_lower_[i] : q_upper_[i];
        beyond = value < q_lower_[i] - limits_.joint_limit_margin_rad ||
                 value > q_upper_[i] + limits_.joint_limit_margin_rad;
        break;
      case FaultCode::kJointVelocity:
        value = state.dq[i];
        limit = velocity_limit_[i] * limits_.velocity_factor;
        beyond = std::abs(value) > limit;
        break;
      default:
        value = state.tau[i];
        limit = effort_limit_[i] * limits_.torque_factor;
        beyond = std::abs(value) > limit;
        break;
    }
    if (beyond) return {.code = code, .joint = i, .value = value, .limit = limit};
  }
  return {};
}

Fault FaultDetector::check_tilt(const model::RobotState& state) const noexcept {
  const double cosine = (state.orientation_WI * up_I_).z();
  const double tilt_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  if (tilt_rad <= limits_.tilt_rad) return {};
  return {.code = FaultCode::kTilt, .value = tilt_rad, .limit = limits_.tilt_rad};
}

bool FaultDetector::persists(FaultCode code, bool present) noexcept {
  int& held = held_ticks_[static_cast<std::size_t>(code)];
  held = present ? std::min(held + 1, limits_.persist_ticks) : 0;
  return held >= limits_.persist_ticks;
}

}  // namespace pmg::runtime
