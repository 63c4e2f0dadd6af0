// A simulated robot whose drives are reached over EtherCAT: EthercatHal, emulated bridges and drives.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "can/robot_behind_drives.hpp"
#include "ethercat/cable_wire.hpp"
#include "ethercat/cabled_drives.hpp"
#include "io/clock.hpp"

namespace pmg::test {

/// A command goes out at the end of an exchange. The drives take it then, and answer with their state of that moment;
/// the next exchange brings these answers. So a command computed from sample k acts from sample k + 1 on, as on CAN,
/// and what is known of the drives is one cycle older than there. So is the IMU.
class EthercatRobot final : public RobotBehindDrives {
 public:
  EthercatRobot(const model::RobotModel& robot, sim::World& world, const CableForm& form = {})
      : RobotBehindDrives(CabledDrives(robot, form).setup, robot, world), cabled_(robot, form) {
    if (over_cable()) cable_ = std::make_unique<CableWire>(cabled_.wire);
    feel();
    // The host starts a robot at rest; before its first step MuJoCo's accelerometer is that of one that nothing holds.
    model::RobotState resting;
    world.read(resting);
    resting.gyro_rad_s.setZero();
    resting.acceleration_m_s2 = resting.orientation_WI.inverse() * Eigen::Vector3d(0.0, 0.0, 9.81);
    feel(resting);
    hal_.emplace(
        cabled_.cable, cabled_.setup, robot, still_, cable_ ? static_cast<ethercat::Wire&>(*cable_) : cabled_.wire,
        [this] { cabled_.drives->serve(); }, std::function<bool()>());
  }

  ethercat::EthercatHal& hal() { return *hal_; }
  EmulatedDrives& drives() noexcept override { return *cabled_.drives; }
  CabledDrives& cabled() { return cabled_; }

 private:
  using RobotBehindDrives::feel;
  void feel(const model::RobotState& state) noexcept override { cabled_.feel(state); }
  hal::BusStatus cycle(const model::JointCommand& command, model::RobotState& state) noexcept override {
    const hal::BusStatus status = frozen ? hal::BusStatus::kStale : hal_->exchange(command, state);
    cabled_.drives->serve();
    cabled_.tick_slaves();
    return status;
  }

  io::SimulationClock still_;  // a lockstep doesn't pause, however slow its computer is
  CabledDrives cabled_;
  std::unique_ptr<CableWire> cable_;
  std::optional<ethercat::EthercatHal> hal_;
};

}  // namespace pmg::test
