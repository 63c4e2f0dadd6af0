#include "sil/lockstep.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::sil {

namespace {
constexpr std::int64_t kReservedTicks = 60'000;  // ten minutes; a longer run grows
}

void hold_for_one_tick(sim::World& world, const model::JointCommand& command) noexcept {
  for (int cycle = 0; cycle < control::ControlCycle::kBusCycles; ++cycle) world.step(command);
}

Lockstep::Lockstep(const model::RobotModel& robot, hal::Hal& bus, Plant& plant, control::Tick& tick,
                   const Scenario& scenario, recording::TickLog* log, const LockstepOptions& options)
    : plant_(plant),
      tick_(tick),
      scenario_(scenario),
      log_(log),
      options_(options),
      inbox_(link_.stop),
      bus_cycle_(bus, link_, robot, clock_, tick.guard()),
      control_cycle_(tick, link_, inbox_, clock_),
      player_(scenario),
      measure_(robot.standing_height_m) {
  if (log_ != nullptr) scenario_log_.emplace(*log_, scenario_);
}

RunOutcome Lockstep::run() {
  const auto ticks =
      static_cast<std::int64_t>(std::ceil(scenario_.duration_s() / control::ControlCycle::kPeriod_s - 1e-9));
  timing_.reserve(static_cast<std::size_t>(std::min(ticks, kReservedTicks)));
  bool ended_early = false;
  for (std::int64_t k = 0; k < ticks; ++k) {
    ended_early = interrupted && interrupted();
    if (ended_early) break;
    advance();
    if (plant_.diverged()) break;
    const double time_s = static_cast<double>(k) * control::ControlCycle::kPeriod_s;
    control(time_s);
    measure(time_s);
    if (after_tick) after_tick({time_s, scenario_.duration_s(), player_.current(), tick_.result()});
  }
  RunOutcome outcome = measure_.outcome();
  outcome.interrupted = ended_early;
  outcome.diverged = plant_.diverged();
  return outcome;
}

void Lockstep::advance() {
  for (int cycle = 0; cycle < control::ControlCycle::kBusCycles; ++cycle) {
    clock_.advance_to(clock_.now_ns() + hal::BusCycle::kPeriod_ns);
    if (bus_sleeps && bus_sleeps()) {
      while_bus_sleeps();
    } else {
      bus_cycle_.run();
    }
  }
}

void Lockstep::control(double time_s) {
  player_.step(time_s, clock_.now_ns());
  inbox_.put(player_.drive());
  inbox_.put(player_.request());
  if (const auto arms = lead_arms ? lead_arms(time_s) : std::nullopt) {
    const control::DriveMessage& driver = player_.drive();
    inbox_.put(control::ArmsMessage{.source = driver.source,
                                    .sequence = driver.sequence,
                                    .stamp_ns = driver.stamp_ns,
                                    .received_ns = driver.received_ns,
                                    .lease_s = driver.lease_s,
                                    .arm = *arms});
  }
  if (!control_sleeps || !control_sleeps()) {
    // A tick that begins so much late ends so much late: here its own work takes no time.
    const double late_s = overrun_s ? overrun_s() : 0.0;
    control_cycle_.run(clock_.now_ns() - std::llround(late_s * 1e9));
  }
  timing_.add(time_s, tick_.result().times);
  if (log_ != nullptr) {
    scenario_log_->write(clock_.now_ns(), player_.number());
    log_->write(control_cycle_.record());
  }
  if (after_record) after_record(control_cycle_.record());

  if (!options_.always_hoisted) {
    hoist_.step(support(), control::ControlCycle::kPeriod_s);
    plant_.set_hoist(hoist_.lift_m(), hoist_.engaged());
  }
}

/// A policy that is still rehearsed balances nobody: until it has the drives the robot is supported as without one.
Support Lockstep::support() noexcept {
  balanced_ = balanced_ || (options_.balanced_by_policy && control::runs_policy(tick_.result().maker));
  const bool waits = control::policy_waits(tick_.result().maker);
  return balanced_ || (options_.balanced_by_policy && !waits) ? Support::kNone
                                                              : player_.current().support_without_policy();
}

void Lockstep::measure(double time_s) {
  const model::GroundTruth truth = plant_.truth();
  const bool hoisted = options_.always_hoisted || hoist_.carrying();
  if (log_ != nullptr) log_->write_truth(static_cast<std::int64_t>(std::llround(time_s * 1e9)), truth, hoisted);
  measure_.add(tick_.result(), truth, hoisted, player_.current().command);
}

}  // namespace pmg::sil
