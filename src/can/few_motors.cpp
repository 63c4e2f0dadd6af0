#include "can/few_motors.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "drive_protocols/canopen.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "drives/motor_monitor.hpp"
#include "drives/robot_drives.hpp"

namespace pmg::can {

namespace {
constexpr int kAnswerCycles = 250;  // 0.5 s: some nodes take their time to start
constexpr int kPatience = 5;        // ticks: 10 ms, which some adapters take; drives let go after 20 ms
}  // namespace

FewMotors::FewMotors(const BusSetup& bus, std::span<const drives::MotorSetup* const> motors, Link& link,
                     const std::function<void()>& tick, std::function<void(const drives::Message&)> others)
    : bus_(bus), link_(link), tick_(tick), others_(std::move(others)), network_(drives::network_of(bus)) {
  for (const drives::MotorSetup* motor : motors) {
    motors_.push_back(std::make_unique<Motor>(bus, *motor));
    if (drives::as_cia402(motor->drive) != nullptr) set_up_node(bus, *motor, link, tick);
  }
  for (int k = 0; k < kAnswerCycles && !all(&drives::MotorMonitor::answered); ++k) exchange_off();
  for (const auto& motor : motors_) {
    if (motor->monitor.answered()) continue;
    throw std::runtime_error(name_of(bus, motor->setup) +
                             " does not answer; expected a powered drive with this node number");
  }
}

FewMotors::FewMotors(const BusSetup& bus, const drives::MotorSetup& motor, Link& link,
                     const std::function<void()>& tick, std::function<void(const drives::Message&)> others)
    : FewMotors(bus, std::array{&motor}, link, tick, std::move(others)) {}

FewMotors::~FewMotors() {
  try {
    exchange_off();
  } catch (...) {  // tick's; the drives' watchdogs remain
    return;
  }
  for (const auto& motor : motors_) {
    if (drives::as_cia402(motor->setup.drive) == nullptr) continue;
    const drives::Message quiet =
        drives::canopen::node_command(drives::canopen::NodeCommand::kPreOperational, motor->setup.node);
    link_.send(std::span(&quiet, 1));
  }
}

drives::MotorReading FewMotors::reading(std::size_t motor) const {
  return motors_[motor]->setup.transmission.to_joint(motors_[motor]->monitor.reading());
}

bool FewMotors::all(bool (drives::MotorMonitor::*is)() const noexcept) const {
  return std::ranges::all_of(motors_, [is](const auto& motor) { return (motor->monitor.*is)(); });
}

void FewMotors::cycle(const std::function<void(std::size_t motor, bool synced, drives::Outbox&)>& ask) {
  const auto send = [this](std::span<const drives::Message> frames) { return link_.send(frames) == frames.size(); };
  for (const auto& motor : motors_) motor->monitor.begin();
  const bool synced =
      network_ && std::ranges::none_of(motors_, [](const auto& motor) { return motor->channel->pauses_sync(); });
  bool sync_sent = false;
  if (synced) {
    const drives::Message sync = network_->sync();
    sync_sent = send(std::span(&sync, 1));
  }
  if (network_) {
    drives::Outbox life;
    network_->sign_of_life(std::exchange(ticks_, 0), life);
    if (!life.messages().empty()) link_.send(life.messages());
  }
  for (std::size_t m = 0; m < motors_.size(); ++m) {
    drives::Outbox out;
    ask(m, synced, out);
    const bool sent = send(out.messages());
    if (!(motors_[m]->channel->asked_by_sync() ? sync_sent : sent)) motors_[m]->channel->not_asked();
  }
  const auto late = [](const auto& motor) { return motor->monitor.age_cycles() > 0; };
  for (int k = 0; k < kPatience && (k == 0 || std::ranges::any_of(motors_, late)); ++k) {
    tick_();
    ++ticks_;
    std::array<drives::Message, 32> frames;
    while (const std::size_t count = link_.receive(frames)) {
      for (const drives::Message& got : std::span(frames).first(count)) {
        const bool taken = std::ranges::any_of(motors_, [&](const auto& motor) { return motor->channel->hear(got); });
        if (!taken && others_) others_(got);
      }
    }
  }
  for (const auto& motor : motors_) {
    drives::Outbox follow_up;
    motor->channel->follow_up(follow_up);
    if (!follow_up.messages().empty()) link_.send(follow_up.messages());
  }
}

void FewMotors::exchange_off() {
  cycle([this](std::size_t m, bool synced, drives::Outbox& out) { motors_[m]->channel->ask_off(synced, out); });
}

bool FewMotors::switch_on() {
  for (int k = 0; k < kAnswerCycles && !all(&drives::MotorMonitor::enabled); ++k)
    cycle([this](std::size_t m, bool synced, drives::Outbox& out) {
      motors_[m]->channel->ask({}, {.synced = synced}, out);
    });
  return all(&drives::MotorMonitor::enabled);
}

void FewMotors::exchange(std::span<const drives::MotorCommand> wanted) {
  cycle([&](std::size_t m, bool synced, drives::Outbox& out) {
    motors_[m]->channel->ask(wanted[m], {.stiff = true, .synced = synced}, out);
  });
  for (const auto& motor : motors_) {
    if (motor->monitor.condition(true) != drives::Condition::kLost) continue;
    throw std::runtime_error(name_of(bus_, motor->setup) + " " +
                             drives::words_of(motor->monitor.trouble(true), motor->monitor.reading().fault) +
                             "; it is switched off");
  }
}

bool FewMotors::set_zero() {
  for (const auto& motor : motors_) {
    drives::Outbox out;
    if (!motor->channel->zero(out)) return false;
    link_.send(out.messages());
  }
  tick_();
  std::array<drives::Message, 32> answers;
  while (link_.receive(answers) > 0) {
  }
  for (auto& motor : motors_) motor = std::make_unique<Motor>(bus_, motor->setup);  // the positions jump
  return true;
}

}  // namespace pmg::can
