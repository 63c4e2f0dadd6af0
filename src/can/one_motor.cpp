#include "can/one_motor.hpp"

#include <array>
#include <stdexcept>
#include <utility>

#include "can/canopen_setup.hpp"
#include "drive_protocols/canopen_drive.hpp"
#include "drives/robot_drives.hpp"

namespace pmg::can {

namespace {
constexpr int kAnswerCycles = 250;  // 0.5 s: some nodes take their time to start
constexpr int kPatience = 5;        // ticks: 10 ms, which some adapters take; drives let go after 20 ms
}  // namespace

OneMotor::OneMotor(const BusSetup& bus, const drives::MotorSetup& motor, Link& link, const std::function<void()>& tick,
                   std::function<void(const drives::Message&)> others)
    : bus_(bus),
      setup_(motor),
      monitor_(motor.limits, bus.fresh_cycles()),
      motor_(motor, monitor_, bus.data_bitrate != 0),
      link_(link),
      tick_(tick),
      others_(std::move(others)),
      network_(drives::network_of(bus)) {
  if (drives::as_cia402(motor.drive) != nullptr) set_up_node(bus, motor, link, tick);
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
  if (drives::as_cia402(setup_.drive) == nullptr) return;
  const drives::Message quiet =
      drives::canopen::node_command(drives::canopen::NodeCommand::kPreOperational, setup_.node);
  link_.send(std::span(&quiet, 1));
}

void OneMotor::cycle(const std::function<void(bool synced, drives::Outbox&)>& ask) {
  const auto send = [this](const drives::Message& frame) { return link_.send(std::span(&frame, 1)) == 1; };
  monitor_.begin();
  const bool synced = network_ && !motor_.pauses_sync();
  bool asked = synced && send(network_->sync());
  if (network_) {
    drives::Outbox life;
    network_->sign_of_life(std::exchange(ticks_, 0), life);
    if (!life.messages().empty()) link_.send(life.messages());
  }
  drives::Outbox out;
  ask(synced, out);
  const bool sent = link_.send(out.messages()) == out.messages().size();
  if (!motor_.asked_by_sync()) asked = sent;
  if (!asked) motor_.not_asked();
  for (int k = 0; k < kPatience && (k == 0 || monitor_.age_cycles() > 0); ++k) {
    tick_();
    ++ticks_;
    std::array<drives::Message, 32> frames;
    while (const std::size_t count = link_.receive(frames)) {
      for (const drives::Message& got : std::span(frames).first(count)) {
        if (!motor_.hear(got) && others_) others_(got);
      }
    }
  }
  drives::Outbox follow_up;
  motor_.follow_up(follow_up);
  if (!follow_up.messages().empty()) link_.send(follow_up.messages());
}

void OneMotor::exchange_off() {
  cycle([this](bool synced, drives::Outbox& out) { motor_.ask_off(synced, out); });
}

bool OneMotor::switch_on() {
  for (int k = 0; k < kAnswerCycles && !monitor_.enabled(); ++k)
    cycle([this](bool synced, drives::Outbox& out) { motor_.ask({}, {.synced = synced}, out); });
  return monitor_.enabled();
}

void OneMotor::exchange(const drives::MotorCommand& joint) {
  cycle([&](bool synced, drives::Outbox& out) { motor_.ask(joint, {.stiff = true, .synced = synced}, out); });
  if (monitor_.condition(true) != drives::Condition::kLost) return;
  throw std::runtime_error(name_of(bus_, setup_) + " " +
                           drives::words_of(monitor_.trouble(true), monitor_.reading().fault) + "; it is switched off");
}

bool OneMotor::set_zero() {
  drives::Outbox out;
  if (!motor_.zero(out)) return false;
  link_.send(out.messages());
  tick_();
  std::array<drives::Message, 32> answers;
  while (link_.receive(answers) > 0) {
  }
  monitor_ = drives::MotorMonitor(setup_.limits, bus_.fresh_cycles());  // the position jumps
  motor_ = drives::MotorChannel(setup_, monitor_, bus_.data_bitrate != 0);
  return true;
}

}  // namespace pmg::can
