#include "drives/motor_channel.hpp"

namespace pmg::drives {

MotorChannel::MotorChannel(const MotorSetup& setup, MotorMonitor& monitor, bool fd)
    : setup_(&setup), monitor_(&monitor), protocol_(setup.drive->protocol(setup.node, setup.limits, fd)) {}

void MotorChannel::ask(const MotorCommand& wanted, const Cycle& cycle, Outbox& out) noexcept {
  asked_ = asked_by_sync() ? cycle.synced : cycle.urgent || !monitor_->pauses();
  if (!asked_ && !asked_by_sync()) return;
  const bool enabling = !monitor_->enabled() && !cycle.stiff;
  if (asked_) monitor_->ask(enabling && !asked_by_sync());
  protocol_->order({.command = setup_->transmission.to_motor(wanted),
                    .stiff = cycle.stiff,
                    .enabling = enabling,
                    .silent = monitor_->silent()},
                   out);
}

void MotorChannel::ask_off(bool synced, Outbox& out) noexcept {
  asked_ = synced || !asked_by_sync();
  if (asked_) monitor_->ask(false);
  protocol_->off(out);
}

void MotorChannel::not_asked() noexcept {
  if (asked_) monitor_->take_back();
  asked_ = false;
}

bool MotorChannel::hear(const Message& message) noexcept {
  const Heard heard = protocol_->hear(message);
  switch (heard.what) {
    case Heard::What::kForeign:
      return false;
    case Heard::What::kReading:
      monitor_->hear(heard.reading);
      return true;
    case Heard::What::kPart:
      monitor_->hear_stray();
      return true;
    case Heard::What::kBootUp:
      monitor_->restarted();
      return true;
    case Heard::What::kNoted:
      return true;
  }
  return true;
}

void MotorChannel::follow_up(Outbox& out) noexcept {
  protocol_->follow_up(monitor_->reading(), freshness(), out);
  monitor_->refuse_gains(protocol_->refuses_gains());
}

Freshness MotorChannel::freshness() const noexcept {
  if (!monitor_->answered() || monitor_->silent()) return Freshness::kNone;
  const bool fresh = monitor_->believed() && monitor_->fresh();
  return fresh ? Freshness::kFresh : Freshness::kLate;
}

void MotorChannel::interrupt() noexcept {
  if (!protocol_->tells_whether_it_follows()) monitor_->interrupt();
}

}  // namespace pmg::drives
