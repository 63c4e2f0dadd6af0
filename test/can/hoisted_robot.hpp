// A simulated robot in real time behind emulated drives. It hangs in a hoist, which sets it down when its drives have
// held it for long enough.
#pragma once

#include <algorithm>
#include <cmath>

#include "can/emulated_drives.hpp"
#include "sil/crane.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::test {

class HoistedRobot {
 public:
  static constexpr std::int64_t kPeriod_ns = 2'000'000;

  /// Keeps references. gantry: it stays up.
  HoistedRobot(const model::RobotModel& robot, EmulatedDrives& drives, bool gantry)
      : drives_(drives), world_(robot, sil::world_with_noise(1, true)), gantry_(gantry) {
    acting_.q = acting_.dq = acting_.kp = acting_.kd = acting_.tau_ff = JointVector::Zero(robot.joint_index.size());
    weight_N_ = world_.mj_model()->body_subtreemass[0] * std::abs(world_.mj_model()->opt.gravity[2]);
  }
  /// A cycle begins: the drives feel where they are, the IMU speaks.
  void speak() {
    world_.read(sensed_);
    drives_.feel(sensed_);
    drives_.speak();
  }
  /// 2 ms pass.
  void step() {
    drives_.tick(acting_);
    held_s_ = acting_.kp.maxCoeff() > 0.0 ? held_s_ + kPeriod_s : 0.0;
    if (!gantry_) {
      const auto& feet_N = world_.foot_force_N();
      crane_.step({.stands = held_s_ > kStands_s,
                   .stays_up = false,
                   .carried_share = (feet_N[0] + feet_N[1]) / weight_N_,
                   .torso_height_m = world_.torso_height_m()},
                  kPeriod_s);
      world_.set_hoist(crane_.lift_m(), crane_.engaged());
    }
    world_.step(acting_);
  }

 private:
  static constexpr double kPeriod_s = 1e-9 * static_cast<double>(kPeriod_ns);
  static constexpr double kStands_s = 6.0;  // the longest ramp into Stand lasts 5 s

  EmulatedDrives& drives_;
  sim::World world_;
  bool gantry_;
  model::JointCommand acting_;
  model::RobotState sensed_;
  sil::Crane crane_;
  double weight_N_ = 0.0, held_s_ = 0.0;
};

}  // namespace pmg::test
