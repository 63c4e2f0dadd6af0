#include "can/can_hal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "can/bus_ids.hpp"

namespace pmg::can {

namespace {

constexpr std::size_t kIncoming = 64;  // frames a call: more than any bus carries in 2 ms

std::vector<drives::RobotDrives::Way> ways(const DriveSetup& setup) {
  std::vector<drives::RobotDrives::Way> ways;
  for (const BusSetup& bus : setup.buses) ways.push_back({.group = &bus, .fresh_cycles = bus.fresh_cycles()});
  return ways;
}

}  // namespace

std::string describe(const BusTrouble& trouble, const DriveSetup& setup) {
  if (trouble.bus < 0) return "the drives answer";
  const BusSetup& bus = setup.buses[static_cast<std::size_t>(trouble.bus)];
  if (trouble.imu) return fmt::format("the IMU on {} does not speak", bus.name);
  if (trouble.motor < 0)
    return fmt::format("{} is {}", bus.name, trouble.health == BusHealth::kOff ? "off" : "error-passive");
  const drives::MotorSetup& motor = bus.motors[static_cast<std::size_t>(trouble.motor)];
  return drives::name_of(bus, motor) + " " + drives::words_of(trouble.trouble, trouble.fault);
}

CanHal::CanHal(const DriveSetup& setup, const model::RobotModel& robot, const io::Clock& clock,
               std::vector<std::unique_ptr<Link>> links)
    : clock_(clock), drives_(ways(setup), robot.joint_index.size()), incoming_(kIncoming) {
  buses_.reserve(setup.buses.size());
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    Bus bus;
    bus.setup = &setup.buses[b];
    bus.link = std::move(links.at(b));
    for (std::size_t m = 0; m < setup.buses[b].motors.size(); ++m)
      bus.motors.emplace_back(setup.buses[b].motors[m], drives_.monitor(b, m), setup.buses[b].data_bitrate != 0);
    bus.network = drives::network_of(setup.buses[b]);
    bus.synced = bus.network && std::ranges::any_of(bus.motors, &drives::MotorChannel::asked_by_sync);
    bus.outgoing.resize((bus.motors.size() + 1) * drives::Outbox::kMost + 1);
    bus.asked.resize(bus.outgoing.size());
    polled_.push_back({.fd = bus.link->descriptor(), .events = POLLIN, .revents = 0});
    waits_ = waits_ || polled_.back().fd >= 0;
    buses_.push_back(std::move(bus));
  }
}

hal::BusStatus CanHal::exchange(const model::JointCommand& command, model::RobotState& state) noexcept {
  send(command);
  return receive(state);
}

void CanHal::send(const model::JointCommand& command) noexcept {
  drain();  // late answers belong to the cycle before
  drives_.begin(command, clock_.now_ns());
  imu_.begin_cycle();
  for (std::size_t b = 0; b < buses_.size(); ++b) send(b);
}

void CanHal::send(std::size_t b) noexcept {
  Bus& bus = buses_[b];
  bool synced = bus.synced;
  for (drives::MotorChannel& motor : bus.motors) {
    if (drives_.paused()) motor.interrupt();
    synced = synced && !motor.pauses_sync();
  }
  std::size_t count = 0;
  const auto put = [&](const drives::Message& frame, int asked) {
    bus.outgoing[count] = frame;
    bus.asked[count++] = asked;
  };
  if (synced) put(bus.network->sync(), kAllSynced);  // first: what it asks for is worth most when it is new
  for (std::size_t m = 0; m < bus.motors.size(); ++m) {
    drives::MotorChannel& motor = bus.motors[m];
    drives::Outbox out;
    motor.ask(drives_.wanted(b, m), {.stiff = drives_.stiff(), .urgent = drives_.urgent(), .synced = synced}, out);
    for (const drives::Message& frame : out.messages())
      put(frame, motor.asked_by_sync() ? kNobody : static_cast<int>(m));
  }
  if (bus.network) {
    drives::Outbox out;
    bus.network->sign_of_life(1, out);
    for (const drives::Message& frame : out.messages()) put(frame, kNobody);
  }
  for (std::size_t k = bus.link->send(std::span(bus.outgoing).first(count)); k < count; ++k) {
    if (bus.asked[k] >= 0) bus.motors[static_cast<std::size_t>(bus.asked[k])].not_asked();
    if (bus.asked[k] != kAllSynced) continue;
    for (drives::MotorChannel& motor : bus.motors) {
      if (motor.asked_by_sync()) motor.not_asked();
    }
  }
}

hal::BusStatus CanHal::receive(model::RobotState& state) noexcept {
  drain();
  const io::WallClock clock;
  const std::int64_t deadline_ns = clock.now_ns() + kWait_ns;
  while (waits_ && !drives_.all_settled() && wait(deadline_ns)) drain();
  for (Bus& bus : buses_) send_targets(bus);
  drives_.read();
  trouble_ = judge();
  tell();
  ++cycles_;
  if (trouble_.status != hal::BusStatus::kOk) return trouble_.status;
  drives_.fill(state);
  imu_.read(state);
  state.bus_sample = cycles_;
  return trouble_.status;
}

void CanHal::send_targets(Bus& bus) noexcept {
  std::size_t count = 0;
  for (drives::MotorChannel& motor : bus.motors) {
    drives::Outbox out;
    motor.follow_up(out);
    for (const drives::Message& frame : out.messages()) bus.outgoing[count++] = frame;
  }
  if (count > 0) bus.link->send(std::span(bus.outgoing).first(count));
}

// A late answer alone is no news.
void CanHal::tell() noexcept {
  if (trouble_.status == hal::BusStatus::kStale || trouble_ == told_) return;
  told_ = trouble_;
  changes_.put(told_);
}

void CanHal::drain() noexcept {
  for (Bus& bus : buses_) drain(bus);
}

void CanHal::drain(Bus& bus) noexcept {
  while (true) {
    const std::size_t count = bus.link->receive(incoming_);
    for (std::size_t i = 0; i < count; ++i) hear(bus, incoming_[i]);
    if (count < incoming_.size()) return;
  }
}

void CanHal::hear(Bus& bus, const drives::Message& frame) noexcept {
  if (bus.setup->imu && imu_.hear(frame)) return;
  for (drives::MotorChannel& motor : bus.motors) {
    if (motor.hear(frame)) return;
  }
  ++(stranger(*bus.setup, frame) ? strangers_ : unreadable_);
}

bool CanHal::wait(std::int64_t deadline_ns) noexcept {
  const io::WallClock clock;
  const std::int64_t left_ns = deadline_ns - clock.now_ns();
  if (left_ns <= 0) return false;
  const timespec timeout{.tv_sec = 0, .tv_nsec = left_ns};
  return ppoll(polled_.data(), polled_.size(), &timeout, nullptr) > 0;
}

BusTrouble CanHal::judge() const noexcept {
  BusTrouble late;
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    const Bus& bus = buses_[b];
    const int at = static_cast<int>(b);
    if (bus.link->health() == BusHealth::kOff)
      return {.status = hal::BusStatus::kLost, .bus = at, .health = BusHealth::kOff};
    const drives::MotorTrouble motors = drives_.judge(b);
    if (motors.condition != drives::Condition::kGood) {
      const BusTrouble trouble = {
          .status = motors.condition == drives::Condition::kLost ? hal::BusStatus::kLost : hal::BusStatus::kStale,
          .bus = at,
          .motor = motors.motor,
          .trouble = motors.trouble,
          .fault = motors.fault,
          .health = bus.link->health()};
      if (trouble.status == hal::BusStatus::kLost) return trouble;
      if (late.status == hal::BusStatus::kOk) late = trouble;
    }
    if (!bus.setup->imu || imu_.age_cycles() <= XsensImu::kLateCycles) continue;
    const bool silent = imu_.age_cycles() > XsensImu::kSilentCycles;
    const BusTrouble trouble = {
        .status = silent ? hal::BusStatus::kLost : hal::BusStatus::kStale, .bus = at, .imu = true};
    if (silent) return trouble;
    if (late.status == hal::BusStatus::kOk) late = trouble;
  }
  return late;
}

}  // namespace pmg::can
