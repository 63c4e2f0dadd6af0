// A robot's drives and IMU behind emulated slaves on a cable without a kernel, in robot.yaml's order: one bridge a bus,
// or each drive a slave; then the IMU where it is one.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "can/emulated_drives.hpp"
#include "can/mixed_drives.hpp"
#include "ethercat/emulated_bridge.hpp"
#include "ethercat/emulated_drive_slave.hpp"
#include "ethercat/emulated_imu.hpp"
#include "ethercat/ethercat_hal.hpp"
#include "ethercat/memory_wire.hpp"

namespace pmg::test {

struct CableForm {
  bool leg_drives = false;  ///< the drives of the first two buses are CiA 402 slaves, in torque mode
  bool imu = false;         ///< so is the IMU
  bool clocks = false;      ///< bridges have distributed clocks
};

class CabledDrives {
 public:
  static constexpr int kFramesOut = 8, kFramesIn = 12, kFirstAlias = 100;
  static constexpr std::size_t kLegs = 2;

  /// Where robot.yaml has the bus's bridge, the bridge has that place and alias.
  explicit CabledDrives(const model::RobotModel& robot, const CableForm& form = {}) : setup(can::load_drives(robot)) {
    cable.buses = ethercat::load_places(robot, setup);
    std::vector<std::unique_ptr<MemoryLink>> near;
    std::vector<std::unique_ptr<can::Link>> far;
    int slave = 0;
    for (std::size_t b = 0; b < setup.buses.size(); ++b) {
      can::BusSetup& bus = setup.buses[b];
      ethercat::BusPlace& at = cable.buses[b];
      if (form.imu) bus.imu = false;
      if (form.leg_drives && b < kLegs) {
        bus.on_can = false;
        at.first_slave = slave + 1;
        at.first_alias = kFirstAlias + at.first_slave;
        for (drives::MotorSetup& motor : bus.motors)
          motor.drive = drives::cia402_drive(cia402_for(motor, robot, drives::Cia402Mode::kTorque));
        slave += static_cast<int>(bus.motors.size());
      } else if (at.bridge == 0) {
        bus.relayed = true;
        at.bridge = ++slave;
        at.bridge_alias = kFirstAlias + slave;
      }
      auto [here, there] = MemoryLink::pair();
      near.push_back(std::move(here));
      far.push_back(std::move(there));
    }
    ++slave;
    if (form.imu) {
      setup.imu_on_can_or_line = false;
      cable.imu = EmulatedImu::model(slave, kFirstAlias + slave);
    }
    drives.emplace(setup, std::move(far));
    std::map<int, std::unique_ptr<EmulatedSlave>> places;
    const auto place = [&](int at, int alias, std::unique_ptr<EmulatedSlave> made) {
      made->set_alias(static_cast<std::uint16_t>(alias));
      places[at] = std::move(made);
    };
    for (std::size_t b = 0; b < setup.buses.size(); ++b) {
      const can::BusSetup& bus = setup.buses[b];
      const ethercat::BusPlace& at = cable.buses[b];
      if (bus.on_can) {
        place(at.bridge, at.bridge_alias,
              std::make_unique<EmulatedBridge>(kFramesOut, kFramesIn, std::move(near[b]), form.clocks));
        continue;
      }
      for (std::size_t m = 0; m < bus.motors.size(); ++m) {
        const int from_first = bus.motors[m].node - 1;
        place(at.first_slave + from_first, at.first_alias + from_first,
              std::make_unique<EmulatedDriveSlave>(drives->cia402(b, m), false));
      }
      unused_.push_back(std::move(near[b]));
    }
    if (form.imu) {
      auto own = std::make_unique<EmulatedImu>();
      imu = own.get();
      place(cable.imu->slave, cable.imu->alias, std::move(own));
    }
    for (auto& [at, made] : places) wire.slaves.push_back(std::move(made));
  }

  EmulatedBridge& bridge(std::size_t slave) { return dynamic_cast<EmulatedBridge&>(*wire.slaves[slave]); }
  void feel(const model::RobotState& state) noexcept {
    drives->feel(state);
    if (imu != nullptr) imu->feel(state);
  }
  /// 2 ms pass for the slaves.
  void tick_slaves() noexcept {
    for (const auto& slave : wire.slaves) slave->tick();
  }

  can::DriveSetup setup;
  ethercat::EthercatSetup cable{
      .interface = "eth9", .buses = {}, .imu = {}, .frames_out = kFramesOut, .frames_in = kFramesIn};
  MemoryWire wire;
  std::optional<EmulatedDrives> drives;
  EmulatedImu* imu = nullptr;

 private:
  std::vector<std::unique_ptr<MemoryLink>> unused_;  // the other ends' peers
};

}  // namespace pmg::test
