#include "ethercat/ethercat_hal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "drive_protocols/canopen_drive.hpp"
#include "ethercat/coe_dictionary.hpp"
#include "imu/at_rest.hpp"

namespace pmg::ethercat {

namespace {

/// A bridge is empty when it fills no batch in so many exchanges, some 1 ms each: longer than it takes to offer the
/// next one, and than a drive's last answer is under way. On a bus that never gets quiet the drives are asked all the
/// same.
constexpr int kQuietExchanges = 10, kMostExchanges = 500;
constexpr int kImuExchanges = 200;  // for its first sample

}  // namespace

EthercatHal::EthercatHal(const EthercatSetup& setup, const can::DriveSetup& drives, const model::RobotModel& robot,
                         const io::Clock& clock, Wire& wire, const can::Wait& pause,
                         const std::function<bool()>& interrupted)
    : setup_(setup),
      drives_(drives),
      clock_(clock),
      drive_answers_(drives.buses.size()),
      master_(wire, setup.interface,
              expected_slaves(setup, drives,
                              [this](std::size_t bus, std::size_t motor, drives::ObjectDictionary& objects) {
                                prepare_drive(bus, motor, objects);
                              }),
              setup.timing),
      can_(drives, robot, clock, called(pause, interrupted)) {
  if (const auto& own = setup.imu) {
    imu_.emplace(*own);
    imu_slave_ = static_cast<std::size_t>(own->slave - 1);
    await_imu(pause, interrupted);
  }
}

void EthercatHal::prepare_drive(std::size_t bus, std::size_t motor, drives::ObjectDictionary& objects) {
  const drives::MotorSetup& setup = drives_.buses[bus].motors[motor];
  const auto& settings = *drives::as_cia402(setup.drive);
  drives::check_drive(objects, settings);
  drives::set_up_drive(objects, settings, setup.limits);
  drive_answers_[bus].push_back(
      {.node = setup.node, .count = 1, .reading = drives::read_drive(objects, settings), .problem = {}});
  map_process_data(objects, settings);
}

std::vector<std::unique_ptr<can::Link>> EthercatHal::make_links() {
  std::vector<std::unique_ptr<can::Link>> links;
  for (std::size_t b = 0; b < drives_.buses.size(); ++b) {
    const can::BusSetup& bus = drives_.buses[b];
    const BusPlace& place = setup_.buses[b];
    if (!bus.on_can) {
      std::vector<int> nodes;
      std::vector<std::size_t> slaves;
      for (const drives::MotorSetup& motor : bus.motors) {
        nodes.push_back(motor.node);
        slaves.push_back(static_cast<std::size_t>(place.first_slave + motor.node - 2));
      }
      auto link = std::make_unique<DriveLink>(nodes);
      drive_buses_.push_back({.link = link.get(), .slaves = std::move(slaves)});
      links.push_back(std::move(link));
      continue;
    }
    auto link = std::make_unique<BridgeLink>();
    const auto channel = static_cast<std::size_t>(place.channel);
    channels_.push_back({.link = link.get(),
                         .slave = static_cast<std::size_t>(place.bridge - 1),
                         .offset_out = channel * block_bytes(setup_.frames_out),
                         .offset_in = channel * block_bytes(setup_.frames_in)});
    links.push_back(std::move(link));
  }
  return links;
}

std::vector<std::unique_ptr<can::Link>> EthercatHal::called(const can::Wait& pause,
                                                            const std::function<bool()>& interrupted) {
  std::vector<std::unique_ptr<can::Link>> links = make_links();
  for (std::size_t b = 0; b < drives_.buses.size(); ++b) {
    if (drives_.buses[b].on_can) continue;
    const std::vector<std::string> found = can::problems(drives_.buses[b], drive_answers_[b]);
    if (!found.empty()) throw std::runtime_error(found.front());
  }
  if (!channels_.empty()) empty_bridges(pause, interrupted);
  can::call_roll(
      drives_, links,
      [&] {
        write(false);
        pause();
        read();
      },
      interrupted);
  return links;
}

void EthercatHal::empty_bridges(const can::Wait& pause, const std::function<bool()>& interrupted) {
  for (int k = 0, quiet = 0; k < kMostExchanges && quiet < kQuietExchanges; ++k) {
    if (interrupted && interrupted()) return;  // the roll call says so
    write(false);
    pause();
    quiet = read() ? 0 : quiet + 1;
  }
}

void EthercatHal::await_imu(const can::Wait& pause, const std::function<bool()>& interrupted) {
  const std::string who = setup_.interface + ": the IMU";
  for (int k = 0; k < kImuExchanges && imu_->age_cycles() != 0; ++k) {
    if (interrupted && interrupted()) throw std::runtime_error(who + ": interrupted");
    imu_->begin_cycle();
    write(false);
    pause();
    read();
  }
  if (imu_->status() != 0)
    throw std::runtime_error(fmt::format("{} has status 0x{:04X}; expected 0: self-test passed", who, imu_->status()));
  if (imu_->age_cycles() != 0) throw std::runtime_error(who + " gives no sample; expected some 200 a second or more");
  imu::check_at_rest(imu_->sample(), who);
}

bool EthercatHal::read() noexcept {
  bool full = false;
  if (!master_.read()) return full;
  for (const Channel& channel : channels_)
    full |= channel.link->take(master_.inputs(channel.slave).subspan(channel.offset_in, block_bytes(setup_.frames_in)));
  for (const DriveBus& bus : drive_buses_) {
    for (std::size_t i = 0; i < bus.slaves.size(); ++i) bus.link->take(i, master_.inputs(bus.slaves[i]));
  }
  if (imu_) imu_->take(master_.inputs(imu_slave_));
  return full;
}

void EthercatHal::write(bool recover) noexcept {
  for (const Channel& channel : channels_)
    channel.link->fill(master_.outputs(channel.slave).subspan(channel.offset_out, block_bytes(setup_.frames_out)));
  for (const DriveBus& bus : drive_buses_) {
    for (std::size_t i = 0; i < bus.slaves.size(); ++i) bus.link->fill(i, master_.outputs(bus.slaves[i]));
  }
  master_.write(recover);
}

hal::BusStatus EthercatHal::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  if (imu_) imu_->begin_cycle();
  can_.send(command);
  sent_ns_ = clock_.now_ns();
  read();
  const hal::BusStatus drives = can_.receive(whole_);
  const bool stiff = (command.kp.array() != 0.0).any() || (command.tau_ff.array() != 0.0).any();
  const bool recover = bad_cycles_ >= kLostCycles && !stiff && ++since_recovery_ >= kRecoverCycles;
  if (recover) since_recovery_ = 0;
  write(recover);
  const hal::BusStatus status = std::max(drives, judge());  // in the order kOk, kStale, kLost
  if (status != hal::BusStatus::kOk) return status;
  state = whole_;
  if (!imu_) return status;
  state.orientation_WI = imu_->sample().orientation_WI;
  state.gyro_rad_s = imu_->sample().gyro_rad_s;
  state.acceleration_m_s2 = imu_->sample().acceleration_m_s2;
  return status;
}

hal::BusStatus EthercatHal::judge() noexcept {
  const CableState& cable = master_.state();
  shift_ns_ = master_.has_clock() && cable.answered ? lock_.update(cable.clock_ns, sent_ns_) : 0;
  if (cable.good) {
    bad_cycles_ = 0;
  } else {
    bad_cycles_ = std::min(bad_cycles_ + 1, kLostCycles);
    ++misses_;
  }
  const int imu_age = imu_ ? imu_->age_cycles() : 0;
  const Change now = {.cable = cable,
                      .lost = bad_cycles_ == kLostCycles,
                      .runs_away = lock_.runs_away(),
                      .imu_silent = imu_age > ProcessDataImu::kSilentCycles};
  if (!(now == told_)) changes_.put(now);
  told_ = now;
  if (now.lost || now.runs_away || now.imu_silent) return hal::BusStatus::kLost;
  return bad_cycles_ > 0 || imu_age > ProcessDataImu::kLateCycles ? hal::BusStatus::kStale : hal::BusStatus::kOk;
}

std::string EthercatHal::take_news() {
  Change change;
  if (changes_.take(change)) {
    const CableState& cable = change.cable;
    if (change.lost) {
      return fmt::format(
          "{}: {} slaves answer, {} give inputs, {} take outputs, states 0x{:02X}, clocks less than {:.1f} us apart; "
          "expected all operational",
          setup_.interface, cable.slaves, cable.readers, cable.writers, cable.al_status,
          1e-3 * static_cast<double>(cable.apart_ns));
    }
    if (change.runs_away)
      return setup_.interface + ": the slaves' clock runs away from this computer's; expected the two within 500 ppm";
    if (change.imu_silent) return setup_.interface + ": the IMU does not speak";
    return setup_.interface + ": every slave exchanges process data";
  }
  can::BusTrouble trouble;
  return can_.take_change(trouble) ? describe(trouble, drives_) : std::string();
}

}  // namespace pmg::ethercat
