#include "can/can_backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "can/bus_claim.hpp"
#include "can/bus_ids.hpp"
#include "can/bus_load.hpp"
#include "can/can_hal.hpp"
#include "can/canopen_setup.hpp"
#include "can/roll_call.hpp"
#include "can/socket_link.hpp"
#include "model/constants.hpp"

namespace pmg::can {

namespace {

/// Nine cycles without a command, then damping: the drives damp in the tenth. A control tick may be 8 ms late.
constexpr int kHoldCycles = 9;

/// Frames of so many cycles wait for a wire that is out; newer commands are then dropped. When the wire is back, the
/// old ones go first: none is older than the time that it was out, and new ones follow within as many cycles.
constexpr int kWaitingCycles = 4;

class CanBackend final : public hal::Backend {
 public:
  explicit CanBackend(const hal::BackendSetup& setup)
      : robot_(setup.robot), clock_(setup.clock), options_(setup.options), setup_(load_drives(setup.robot)) {
    for (const BusSetup& bus : setup_.buses) {
      if (!bus.on_can)
        throw std::invalid_argument(bus.name + ": its drives are EtherCAT slaves; expected --hal ethercat");
    }
    if (!setup_.imu_on_can_or_line)
      throw std::invalid_argument("the IMU is an EtherCAT slave; expected --hal ethercat");
    check_load(setup_);
    check_ids(setup_);
  }

  hal::OptionValues configuration() const override {
    hal::OptionValues values = options_;
    for (const BusSetup& bus : setup_.buses) {
      const BusLoad load = planned_load(bus);
      values[bus.name] = fmt::format(
          "{} motors, {} bit/s{}, {} frames a cycle, {:.0f} % of it at the worst bit stuffing", bus.motors.size(),
          bus.bitrate, bus.data_bitrate != 0 ? fmt::format(" and {} bit/s", bus.data_bitrate) : "", load.frames,
          100.0 * load.share);
    }
    return values;
  }
  hal::BackendLimits limits() const override { return can::limits(); }

  hal::BackendDescription description() const override { return can::description(setup_); }

  hal::Hal& connect(const std::function<bool()>& interrupted) override {
    std::vector<std::unique_ptr<Link>> links;
    for (const BusSetup& bus : setup_.buses) claims_.emplace_back(bus.name);
    for (const BusSetup& bus : setup_.buses)
      links.push_back(std::make_unique<SocketLink>(bus.name, awaited_ids(bus), bus.data_bitrate != 0,
                                                   kWaitingCycles * planned_load(bus).frames));
    call_roll(setup_, links, sleeping(), interrupted);
    set_up_nodes(setup_, links, sleeping(), interrupted);
    hal_ = std::make_unique<CanHal>(setup_, robot_, clock_, std::move(links));
    return *hal_;
  }

  std::string news() override {
    BusTrouble change;
    return hal_ && hal_->take_change(change) ? describe(change, setup_) : std::string();
  }

 private:
  const model::RobotModel& robot_;
  const io::Clock& clock_;
  hal::OptionValues options_;
  DriveSetup setup_;
  std::vector<BusClaim> claims_;
  std::unique_ptr<CanHal> hal_;
};

}  // namespace

hal::BackendLimits limits() {
  return {.guard = {.hold_cycles = kHoldCycles}, .stale_state_s = std::nullopt, .overrun_ticks = std::nullopt};
}

hal::BackendDescription description(const DriveSetup& setup) {
  hal::BackendDescription description{.drive_sampling_s = 0.0, .command_delay_s = model::kBusPeriod_s};
  // A torque acts for a cycle: what it was computed from grows older by half of it on average.
  constexpr double kBusLoopAge_s = 0.5 * model::kBusPeriod_s;
  for (const BusSetup& bus : setup.buses) {
    for (const drives::MotorSetup& motor : bus.motors) {
      const drives::LoopPlace loop = motor.drive->loop();
      if (loop == drives::LoopPlace::kBusThread) description.closed_by_bus.push_back(motor.joint);
      if (loop == drives::LoopPlace::kOwnGains) description.own_gains.push_back(motor.joint);
    }
  }
  if (!description.closed_by_bus.empty()) description.bus_loop_age_s = kBusLoopAge_s;
  if (!description.own_gains.empty()) description.drive_sampling_s.reset();
  return description;
}

void register_backend(hal::BackendFactory& factory) {
  factory.add({.name = "can",
               .summary = "drives on CAN buses as robot.yaml describes them",
               .options = {},
               .make = [](const hal::BackendSetup& setup) { return std::make_unique<CanBackend>(setup); }});
}

}  // namespace pmg::can
