// A motor that turns one joint: (joint) <=> (drive's output shaft).
#pragma once

#include "drives/motor.hpp"
#include "model/robot_model.hpp"

namespace pmg::drives {

/// With g = direction gear:
///   q_motor = g (q_joint + zero_offset),  dq_motor = g dq_joint,  torque_motor = torque_joint / g,
///   kp_motor = kp_joint / g^2,  kd_motor = kd_joint / g^2.
class Transmission {
 public:
  explicit Transmission(const model::BusAddress& bus) noexcept
      : ratio_(bus.direction * bus.gear), zero_offset_rad_(bus.zero_offset_rad) {}

  MotorCommand to_motor(const MotorCommand& joint) const noexcept {
    return {.q_rad = ratio_ * (joint.q_rad + zero_offset_rad_),
            .dq_rad_s = ratio_ * joint.dq_rad_s,
            .kp_Nm_per_rad = joint.kp_Nm_per_rad / (ratio_ * ratio_),
            .kd_Nm_s_per_rad = joint.kd_Nm_s_per_rad / (ratio_ * ratio_),
            .torque_Nm = joint.torque_Nm / ratio_};
  }
  MotorCommand to_joint(const MotorCommand& motor) const noexcept {
    return {.q_rad = motor.q_rad / ratio_ - zero_offset_rad_,
            .dq_rad_s = motor.dq_rad_s / ratio_,
            .kp_Nm_per_rad = motor.kp_Nm_per_rad * ratio_ * ratio_,
            .kd_Nm_s_per_rad = motor.kd_Nm_s_per_rad * ratio_ * ratio_,
            .torque_Nm = motor.torque_Nm * ratio_};
  }
  MotorReading to_joint(MotorReading motor) const noexcept {
    motor.q_rad = motor.q_rad / ratio_ - zero_offset_rad_;
    motor.dq_rad_s /= ratio_;
    motor.torque_Nm *= ratio_;
    return motor;
  }
  MotorReading to_motor(MotorReading joint) const noexcept {
    joint.q_rad = ratio_ * (joint.q_rad + zero_offset_rad_);
    joint.dq_rad_s *= ratio_;
    joint.torque_Nm /= ratio_;
    return joint;
  }
  MotorLimits to_motor(const MotorLimits& joint) const noexcept {
    const double a = ratio_ * (joint.q_lower_rad + zero_offset_rad_),
                 b = ratio_ * (joint.q_upper_rad + zero_offset_rad_);
    const double gear = ratio_ < 0.0 ? -ratio_ : ratio_;
    return {.q_lower_rad = a < b ? a : b,
            .q_upper_rad = a < b ? b : a,
            .dq_rad_s = gear * joint.dq_rad_s,
            .torque_Nm = joint.torque_Nm / gear};
  }

 private:
  double ratio_, zero_offset_rad_;
};

}  // namespace pmg::drives
