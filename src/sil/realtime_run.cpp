#include "sil/realtime_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace pmg::sil {

namespace {
constexpr std::chrono::milliseconds kPoll{20};
constexpr double kReserved_s = 600.0;  // of timing, at most; a run may go on for ever
}  // namespace

RealtimeRun::RealtimeRun(const model::RobotModel& model, SimulatedRobot& robot, runtime::Controller& controller,
                         const Scenario& scenario, recording::TickLog* log, bool hoists)
    : robot_(robot),
      controller_(controller),
      scenario_(scenario),
      log_(log),
      hoists_(hoists),
      player_(scenario),
      measure_(model.standing_height_m),
      bus_cycles_(controller.outbox()) {
  if (log_ != nullptr) scenario_log_.emplace(*log_, scenario_);
  timing_.reserve(static_cast<std::size_t>(
                      std::ceil(std::min(scenario.duration_s(), kReserved_s) / control::ControlCycle::kPeriod_s)) +
                  1);
}

RunOutcome RealtimeRun::run() {
  controller_.start([this] { operators ? operators() : speak(); }, [this] { record(); });
  bool ended_early = false;
  while (!spoken_.load() && controller_.failure().empty() && !robot_.diverged() && !ended_early) {
    std::this_thread::sleep_for(kPoll);
    ended_early = interrupted && interrupted();
  }
  measuring_.store(false);
  controller_.stop();
  if (!controller_.failure().empty()) throw std::runtime_error(controller_.failure());
  RunOutcome outcome = measure_.outcome();
  outcome.interrupted = ended_early;
  outcome.diverged = robot_.diverged();
  for (faults::Fault& fault : outcome.faults) fault.stamp_ns -= first_tick_ns_;
  return outcome;
}

void RealtimeRun::speak() {
  if (start_ns_ == 0) start_ns_ = next_ns_ = clock_.now_ns();
  const double time_s = static_cast<double>(clock_.now_ns() - start_ns_) * 1e-9;
  if (time_s >= scenario_.duration_s()) spoken_.store(true);
  player_.step(time_s, clock_.now_ns());
  spoken_step_.store(player_.number());
  // A full inbox means that the control thread stands still; the next message will do.
  controller_.inbox().put(player_.drive());
  controller_.inbox().put(player_.request());
  robot_.support(hoists_ ? player_.current().support_without_policy() : Support::kNone);
  next_ns_ = std::max(next_ns_ + control::ControlCycle::kPeriod_ns, clock_.now_ns());
  std::this_thread::sleep_for(std::chrono::nanoseconds(next_ns_ - clock_.now_ns()));
}

void RealtimeRun::record() {
  control::ControllerOutbox& outbox = controller_.outbox();
  while (outbox.records.pop(record_)) {
    bus_cycles_.take_until(record_.timing.woke_ns, bus_);
    record_tick();
    bus_.start_anew();
  }
}

void RealtimeRun::record_tick() {
  const control::TickResult& result = record_.result;
  if (record_.drive_count > 0) asked_ = record_.drives[record_.drive_count - 1].command;
  const hal::TruthSample* truth = robot_.take_truth(record_.state.bus_sample);
  if (log_ != nullptr) {
    if (const std::size_t step = spoken_step_.load(); step > 0) scenario_log_->write(record_.now_ns, step);
    log_->write(record_);
    log_->write_timing(record_, bus_, controller_.outbox().dropped());
    if (truth != nullptr) log_->write_truth(record_.now_ns, truth->truth, truth->hoisted);
  }
  if (!measuring_.load()) return;
  if (ticks_ == 0) first_tick_ns_ = record_.now_ns;
  const double time_s = static_cast<double>(ticks_++) * control::ControlCycle::kPeriod_s;
  timing_.add(time_s, result.times);
  if (truth != nullptr) measure_.add(result, truth->truth, truth->hoisted, asked_);
  if (after_tick) after_tick({time_s, scenario_.duration_s(), scenario_.at(time_s), result});
}

}  // namespace pmg::sil
