#include "faults/fault_detector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pmg::faults {

namespace {

int first_not_finite(const JointVector& values) noexcept {
  for (int i = 0; i < static_cast<int>(values.size()); ++i) {
    if (!std::isfinite(values[i])) return i;
  }
  return -1;
}

constexpr bool is_fault(const Fault& fault) noexcept { return fault.code != FaultCode::kNone; }

}  // namespace

Eigen::Vector3d up_of_link(const model::ImuModel& imu) noexcept {
  return imu.T_LI.linear().transpose() * Eigen::Vector3d::UnitZ();
}

FaultDetector::FaultDetector(const model::RobotModel& robot, const FaultLimits& limits)
    : limits_(limits),
      q_lower_(robot.q_lower()),
      q_upper_(robot.q_upper()),
      velocity_limit_(q_lower_.size()),
      effort_limit_(q_lower_.size()),
      up_I_(up_of_link(robot.imu)),
      torso_(robot) {
  for (int i = 0; i < static_cast<int>(q_lower_.size()); ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(i)];
    velocity_limit_[i] = joint.velocity_limit_rad_s;
    effort_limit_[i] = joint.effort_limit_Nm;
  }
}

std::optional<Fault> FaultDetector::detect(const FaultEvidence& evidence, Scope scope) noexcept {
  const Fault state = check_state(evidence);
  const Fault timing = check_timing(evidence);
  Fault motion;
  if (scope == Scope::kMotion && !is_fault(check_finite(evidence.state))) {
    motion = check_motion(evidence);
  } else {
    std::fill(held_ticks_.begin() + static_cast<int>(FaultCode::kJointLimit), held_ticks_.end(), 0);
  }
  for (Fault fault : {state, timing, motion}) {
    if (!is_fault(fault)) continue;
    fault.stamp_ns = evidence.now_ns;
    return fault;
  }
  return std::nullopt;
}

bool FaultDetector::robot_is_sound(const FaultEvidence& evidence) const noexcept {
  const double age_s = static_cast<double>(evidence.now_ns - evidence.state.stamp_ns) * 1e-9;
  return evidence.bus != hal::BusStatus::kLost && evidence.guard_trip == hal::TripCause::kNone &&
         age_s <= limits_.stale_state_s && !is_fault(check_finite(evidence.state)) &&
         !is_fault(check_tilt(evidence.state));
}

Fault FaultDetector::check_state(const FaultEvidence& evidence) noexcept {
  const Fault stale = check_age(evidence);
  if (evidence.bus == hal::BusStatus::kLost) return {.code = FaultCode::kBusLost};
  if (is_fault(stale)) return stale;
  const Fault broken = check_finite(evidence.state);
  return is_fault(broken) ? broken : check_temperature(evidence.state);
}

Fault FaultDetector::check_age(const FaultEvidence& evidence) noexcept {
  const double age_s = static_cast<double>(evidence.now_ns - evidence.state.stamp_ns) * 1e-9;
  const double away_s = static_cast<double>(evidence.now_ns - last_ns_.value_or(evidence.now_ns)) * 1e-9;
  last_ns_ = evidence.now_ns;
  if (age_s <= limits_.stale_state_s) {
    stale_since_ns_.reset();
    return {};
  }
  if (!stale_since_ns_) {
    stale_since_ns_ = evidence.now_ns;
    stale_known_s_ = away_s > limits_.stale_state_s ? limits_.stale_state_s : limits_.stale_state_again_s;
  }
  const double known_s = static_cast<double>(evidence.now_ns - *stale_since_ns_) * 1e-9;
  if (known_s < stale_known_s_) return {};
  return {.code = FaultCode::kStaleState, .value = age_s, .limit = limits_.stale_state_s};
}

Fault FaultDetector::check_finite(const model::RobotState& state) const noexcept {
  for (const JointVector* values : {&state.q, &state.dq, &state.tau}) {
    if (values->size() != q_lower_.size()) return {.code = FaultCode::kStateNotFinite};
    const int joint = first_not_finite(*values);
    if (joint >= 0) return {.code = FaultCode::kStateNotFinite, .joint = joint};
  }
  if (!state.gyro_rad_s.allFinite() || !state.acceleration_m_s2.allFinite() ||
      state.temperature_degC.size() != q_lower_.size() ||
      !(std::abs(state.orientation_WI.norm() - 1.0) < 0.1)) {  // catches NaN as well as an estimate that never started
    return {.code = FaultCode::kStateNotFinite};
  }
  return {};
}

Fault FaultDetector::check_temperature(const model::RobotState& state) const noexcept {
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

Fault FaultDetector::check_timing(const FaultEvidence& evidence) noexcept {
  Fault policy, overrun;
  if (evidence.policy_late) policy = {.code = FaultCode::kStalePolicy};
  if (evidence.late_ns > 0) {
    overrun = {.code = FaultCode::kOverrun, .value = static_cast<double>(evidence.late_ns) * 1e-9};
  }
  policy = persisting(FaultCode::kStalePolicy, policy, limits_.overrun_ticks);
  overrun = persisting(FaultCode::kOverrun, overrun, limits_.overrun_ticks);
  if (evidence.guard_trip == hal::TripCause::kControlFrozen) return {.code = FaultCode::kControlFrozen};
  if (evidence.guard_trip == hal::TripCause::kCommandNotFinite) return {.code = FaultCode::kCommandNotFinite};
  return is_fault(policy) ? policy : overrun;
}

Fault FaultDetector::check_motion(const FaultEvidence& evidence) noexcept {
  Fault first;
  const int counts = std::exchange(sample_ns_, evidence.state.stamp_ns) == evidence.state.stamp_ns ? 0 : 1;
  const auto consider = [&](FaultCode code, const Fault& found) {
    const Fault fault = persisting(code, found, limits_.persist_ticks, counts);
    if (!is_fault(first)) first = fault;
  };
  for (const FaultCode code : {FaultCode::kJointLimit, FaultCode::kJointVelocity, FaultCode::kJointTorque}) {
    consider(code, check_joints(code, evidence.state));
  }
  consider(FaultCode::kTilt, check_tilt(evidence.state));
  consider(FaultCode::kTorsoAttitude, check_torso(evidence));
  return first;
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

double FaultDetector::tilt_rad(const model::RobotState& state) const noexcept {
  return std::acos(std::clamp((state.orientation_WI * up_I_).z(), -1.0, 1.0));
}

bool FaultDetector::leans_too_far(const model::RobotState& state) const noexcept {
  return tilt_rad(state) > limits_.tilt_rad;
}

Fault FaultDetector::check_tilt(const model::RobotState& state) const noexcept {
  const double tilt = tilt_rad(state);
  if (tilt <= limits_.tilt_rad) return {};
  return {.code = FaultCode::kTilt, .value = tilt, .limit = limits_.tilt_rad};
}

Fault FaultDetector::check_torso(const FaultEvidence& evidence) noexcept {
  if (!evidence.torso) return {};
  const double error_rad = torso_.error_rad(evidence.state, *evidence.torso);
  if (error_rad <= limits_.torso_error_rad) return {};
  return {.code = FaultCode::kTorsoAttitude, .value = error_rad, .limit = limits_.torso_error_rad};
}

Fault FaultDetector::persisting(FaultCode code, const Fault& found, int ticks, int counts) noexcept {
  int& held = held_ticks_[static_cast<std::size_t>(code)];
  held = is_fault(found) ? std::min(held + counts, ticks) : 0;
  return held >= ticks ? found : Fault{};
}

}  // namespace pmg::faults
