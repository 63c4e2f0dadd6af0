// Tick records for tests of their writers: numbered, 10 ms apart, healthy or with a fault.
#pragma once

#include <cstdint>

#include "control/controller_outbox.hpp"
#include "control/fixtures.hpp"
#include "control/tick_record.hpp"
#include "io/clock.hpp"

namespace pmg::test {

/// Replaces the control and the bus thread for an outbox, on its own clock.
class RecordSource {
 public:
  explicit RecordSource(const model::RobotModel& robot) {
    record_.state = standing_state(robot);
    record_.result.command.q = robot.q_stand();
    record_.result.mode = control::Mode::kWalk;
    record_.tick = -1;
    record_.drives[0].source = control::Source::make("tester", 7);
    record_.drives[0].lease_s = 0.5;
    record_.drives[0].command[kVx] = 0.4;
    record_.drive_count = 1;
    record_.requests[0].source = record_.drives[0].source;
    record_.requests[0].mode = control::Mode::kWalk;
  }

  /// Puts one tick and its five bus cycles into the outbox, as Controller does.
  void tick(control::ControllerOutbox& outbox) {
    clock.advance_to(clock.now_ns() + 10'000'000);
    for (int cycle = 4; cycle >= 0; --cycle) {
      const std::int64_t planned_ns = clock.now_ns() - 2'000'000 * (cycle + 1);
      const control::CycleTiming timing{planned_ns, planned_ns + 20'000 + 1000 * cycle, planned_ns + 150'000, missed};
      outbox.put(timing);
    }
    const std::int64_t now_ns = clock.now_ns();
    ++record_.tick;
    record_.now_ns = record_.state.stamp_ns = now_ns;
    record_.state.bus_sample += 5;
    record_.drives[0].sequence = record_.tick;
    record_.drives[0].received_ns = record_.requests[0].received_ns = now_ns;
    record_.request_count = record_.tick == 0 ? 1 : 0;
    record_.timing = {now_ns - 30'000, now_ns, now_ns + 250'000, 0};
    outbox.put(record_);
  }
  void ticks(int count, control::ControllerOutbox& outbox) {
    for (int k = 0; k < count; ++k) tick(outbox);
  }

  /// In force from the next tick on, until reset().
  void fault(faults::FaultCode code, int joint = -1) {
    record_.result.mode = control::Mode::kFault;
    record_.result.fault = {
        .code = code, .joint = joint, .value = 95.0, .limit = 90.0, .stamp_ns = clock.now_ns() + 10'000'000};
  }
  void reset() {
    record_.result.mode = control::Mode::kDamping;
    record_.result.fault = {};
  }

  io::SimulationClock clock;
  std::int64_t missed = 0;

 private:
  control::TickRecord record_;
};

}  // namespace pmg::test
