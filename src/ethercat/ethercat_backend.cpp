#include "ethercat/ethercat_backend.hpp"

#include <optional>

#include "can/bus_claim.hpp"
#include "can/bus_ids.hpp"
#include "can/bus_load.hpp"
#include "can/can_backend.hpp"
#include "ethercat/ethercat_hal.hpp"
#include "ethercat/packet_wire.hpp"
#include "model/constants.hpp"

namespace pmg::ethercat {

namespace {

class EthercatBackend final : public hal::Backend {
 public:
  explicit EthercatBackend(const hal::BackendSetup& setup)
      : robot_(setup.robot),
        clock_(setup.clock),
        options_(setup.options),
        drives_(can::load_drives(setup.robot)),
        setup_(load_ethercat(setup.robot, drives_)) {
    can::check_load(drives_);
    can::check_ids(drives_);
  }

  hal::OptionValues configuration() const override {
    hal::OptionValues values = options_;
    values["interface"] = setup_.interface;  // by this name the doctor looks at the card
    values["slaves"] = std::to_string(expected_slaves(setup_, drives_, {}).size());
    return values;
  }
  hal::BackendLimits limits() const override { return can::limits(); }
  hal::BackendDescription description() const override { return ethercat::description(drives_); }

  hal::Hal& connect(const std::function<bool()>& interrupted) override {
    claim_.emplace(setup_.interface);
    wire_ = std::make_unique<PacketWire>(setup_.interface);
    hal_ = std::make_unique<EthercatHal>(setup_, drives_, robot_, clock_, *wire_, can::sleeping(), interrupted);
    return *hal_;
  }
  std::string news() override { return hal_ ? hal_->take_news() : std::string(); }

 private:
  const model::RobotModel& robot_;
  const io::Clock& clock_;
  hal::OptionValues options_;
  can::DriveSetup drives_;
  EthercatSetup setup_;
  std::optional<can::BusClaim> claim_;
  std::unique_ptr<PacketWire> wire_;
  std::unique_ptr<EthercatHal> hal_;
};

}  // namespace

hal::BackendDescription description(const can::DriveSetup& drives) {
  hal::BackendDescription description = can::description(drives);
  bool all = true;
  for (const can::BusSetup& bus : drives.buses) {
    const bool bridged = bus.on_can;
    all = all && bridged;
    description.older_imu = description.older_imu || (bridged && bus.imu);
    for (const drives::MotorSetup& motor : bus.motors) {
      if (bridged) description.older_joints.push_back(motor.joint);
    }
  }
  if (all &&
      drives.imu_on_can_or_line) {  // the whole state is a cycle older; of an IMU on a line of its own nothing is known
    description.older_joints.clear();
    description.older_imu = false;
    *description.command_delay_s += model::kBusPeriod_s;
  } else {
    description.older_by_s = model::kBusPeriod_s;
  }
  return description;
}

void register_backend(hal::BackendFactory& factory) {
  factory.add({.name = "ethercat",
               .summary = "drives on CAN buses behind EtherCAT slaves as robot.yaml describes them",
               .options = {},
               .make = [](const hal::BackendSetup& setup) { return std::make_unique<EthercatBackend>(setup); }});
}

}  // namespace pmg::ethercat
