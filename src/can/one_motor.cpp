#include "can/one_motor.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "can/canopen_setup.hpp"
#include "drives/robot_drives.hpp"

namespace pmg::can {

namespace {
constexpr int kAnswerCycles = 250;  // 0.5 s: some nodes take their time to start
constexpr int kPatience = 5;        // ticks: 10 ms, which some adapters take; drives let go after 20 ms
}  // namespace

OneMotor::OneMotor(const drives::BusSetup& bus, const drives::MotorSetup& motor, Link& link,
                   const std::function<void()>& tick)
    : bus_(bus), setup_(motor), monitor_(motor.limits, fresh_cycles(bus)), motor_(motor, bus, monitor_), link_(link), tick_(tick) {
  if (std::holds_alternative<drives::Cia402Settings>(motor.drive)) set_up_node(bus, motor, link, tick);
  for (int k = 0; k < kAnswerCycles && !monitor_.answered(); ++k) exchange_off();
  if (!monitor_.answered())
    throw std::runtime_error(name_of(bus, motor) + " does not answer; expected a powered drive with this node number");
}

OneMotor::~OneMotor() {
  try {
    exchange_off();
  } catch (...) {  // tick's; the drive's watchdog remains
    return;
  }
  if (!std::holds_alternative<drives::Cia402Settings>(setup_.drive)) return;
  const Frame quiet = canopen::node_command(canopen::NodeCommand::kPreOperational, setup_.node);
  link_.send(std::span(&quiet, 1));
}

void OneMotor::cycle(const std::function<std::optional<Frame>(bool synced)>& ask) {
  const auto send = [this](const Frame& frame) { return link_.send(std::span(&frame, 1)) == 1; };
  monitor_.begin();
  const bool synced = bus_.has_canopen() && !motor_.pauses_sync();
  bool asked = synced && send(canopen::sync());
  if (bus_.has_canopen() && ticks_ >= kHeartbeatCycles) {
    ticks_ = 0;
    send(canopen::heartbeat());
  }
  if (const auto frame = ask(synced)) {
    const bool sent = send(*frame);
    if (std::holds_alternative<drives::MitRanges>(setup_.drive)) asked = sent;
  }
  if (!asked) motor_.not_asked();
  for (int k = 0; k < kPatience && (k == 0 || monitor_.age_cycles() > 0); ++k) {
    tick_();
    ++ticks_;
    std::array<Frame, 32> frames;
    while (const std::size_t count = link_.receive(frames)) {
      for (const Frame& got : std::span(frames).first(count)) motor_.hear(got);
    }
  }
  if (const auto targets = motor_.targets()) link_.send(std::span(&*targets, 1));
}

void OneMotor::exchange_off() {
  cycle([this](bool synced) { return motor_.ask_off(synced); });
}

bool OneMotor::switch_on() {
  for (int k = 0; k < kAnswerCycles && !monitor_.enabled(); ++k)
    cycle([this](bool synced) { return motor_.ask({}, {.synced = synced}); });
  return monitor_.enabled();
}

void OneMotor::exchange(const drives::MotorCommand& joint) {
  cycle([&](bool synced) { return motor_.ask(joint, {.stiff = true, .synced = synced}); });
  if (monitor_.condition(true) != drives::Condition::kLost) return;
  throw std::runtime_error(name_of(bus_, setup_) + " " +
                           drives::words_of(monitor_.trouble(true), monitor_.reading().fault) + "; it is switched off");
}

void OneMotor::set_zero() {
  const Frame frame = Frame::of(static_cast<std::uint32_t>(setup_.node), drives::kMitZero, bus_.data_bitrate != 0);
  link_.send(std::span(&frame, 1));
  tick_();
  std::array<Frame, 32> answers;
  while (link_.receive(answers) > 0) {
  }
  monitor_ = drives::MotorMonitor(setup_.limits, fresh_cycles(bus_));  // the position jumps
  motor_ = BusMotor(setup_, bus_, monitor_);
}

}  // namespace pmg::can
