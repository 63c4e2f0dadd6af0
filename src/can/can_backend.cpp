#include "can/can_backend.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "can/bus_load.hpp"
#include "can/can_hal.hpp"
#include "can/roll_call.hpp"
#include "can/socket_link.hpp"

namespace pmg::can {

namespace {

/// Nine cycles without a command, then damping: the drives damp in the tenth. A control tick may be 8 ms late.
constexpr int kHoldCycles = 9;

/// The identifiers that the robot sends on a bus.
std::vector<std::uint32_t> awaited(const drives::BusSetup& bus) {
  std::vector<std::uint32_t> ids = {kReplyId};
  if (bus.imu) ids.insert(ids.end(), {kImuQuaternion, kImuRateOfTurn, kImuAcceleration});
  return ids;
}

class CanBackend final : public hal::Backend {
 public:
  explicit CanBackend(const hal::BackendSetup& setup)
      : robot_(setup.robot), clock_(setup.clock), options_(setup.options), setup_(drives::load_drives(setup.robot)) {
    check_load(setup_);
  }

  hal::OptionValues configuration() const override {
    hal::OptionValues values = options_;
    for (const drives::BusSetup& bus : setup_.buses) {
      const BusLoad load = planned_load(bus);
      values[bus.name] = fmt::format(
          "{} motors, {} bit/s{}, {} frames a cycle, {:.0f} % of it at the worst bit stuffing", bus.motors.size(),
          bus.bitrate, bus.data_bitrate != 0 ? fmt::format(" and {} bit/s", bus.data_bitrate) : "", load.frames,
          100.0 * load.share);
    }
    return values;
  }
  hal::BackendLimits limits() const override {
    return {.guard = {.hold_cycles = kHoldCycles}, .stale_state_s = std::nullopt, .overrun_ticks = std::nullopt};
  }

  hal::Hal& connect(const std::function<bool()>& interrupted) override {
    std::vector<std::unique_ptr<Link>> links;
    for (const drives::BusSetup& bus : setup_.buses)
      links.push_back(std::make_unique<SocketLink>(bus.name, awaited(bus), bus.data_bitrate != 0));
    call_roll(setup_, links, interrupted);
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
  drives::DriveSetup setup_;
  std::unique_ptr<CanHal> hal_;
};

}  // namespace

void register_backend(hal::BackendFactory& factory) {
  factory.add({.name = "can",
               .summary = "drives on CAN buses as robot.yaml describes them",
               .options = {},
               .make = [](const hal::BackendSetup& setup) { return std::make_unique<CanBackend>(setup); }});
}

}  // namespace pmg::can
