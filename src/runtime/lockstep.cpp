#include "runtime/lockstep.hpp"

#include <cmath>

namespace pmg::runtime {

namespace {
constexpr double kTickPeriod_s = static_cast<double>(ControlCycle::kPeriod_ns) * 1e-9;
constexpr double kGaitPeriodBeforeWalking_s = 1.0;  // what averages run over until the generator has told a period
}  // namespace

Lockstep::Lockstep(const model::RobotModel& robot, hal::Hal& bus, Plant& plant, Tick& tick, const Scenario& scenario,
                   TickLog* log, const LockstepOptions& options)
    : plant_(plant),
      tick_(tick),
      scenario_(scenario),
      log_(log),
      options_(options),
      inbox_(link_.stop),
      bus_cycle_(bus, link_, robot, clock_),
      control_cycle_(tick, link_, inbox_, clock_),
      player_(scenario),
      metrics_(robot.standing_height_m, kTickPeriod_s),
      gait_period_s_(kGaitPeriodBeforeWalking_s) {}

LockstepOutcome Lockstep::run() {
  const auto ticks = static_cast<std::int64_t>(std::ceil(scenario_.duration_s() / kTickPeriod_s - 1e-9));
  timing_.reserve(static_cast<std::size_t>(ticks));
  for (std::int64_t k = 0; k < ticks; ++k) {
    if (interrupted && interrupted()) {
      outcome_.interrupted = true;
      break;
    }
    advance();
    if (plant_.diverged()) {
      outcome_.diverged = true;
      break;
    }
    const double time_s = static_cast<double>(k) * kTickPeriod_s;
    control(time_s);
    measure(time_s);
    outcome_.duration_s = time_s + kTickPeriod_s;
    if (after_tick) after_tick({time_s, scenario_.duration_s(), player_.current(), tick_.result()});
  }
  outcome_.fell = metrics_.fell();
  outcome_.fell_at_s = metrics_.fell_at_s();
  outcome_.tracking = metrics_.summary();
  outcome_.reference_slip = slip_.summary();
  return outcome_;
}

void Lockstep::advance() {
  static_assert(ControlCycle::kPeriod_ns % hal::BusCycle::kPeriod_ns == 0);
  for (std::int64_t step = 0; step < ControlCycle::kPeriod_ns / hal::BusCycle::kPeriod_ns; ++step) {
    clock_.advance_to(clock_.now_ns() + hal::BusCycle::kPeriod_ns);
    bus_cycle_.run();
  }
}

void Lockstep::control(double time_s) {
  player_.step(time_s, clock_.now_ns());
  inbox_.put(player_.drive());
  inbox_.put(player_.request());
  const Mode before = tick_.result().mode;
  control_cycle_.run(clock_.now_ns());
  const TickResult& result = tick_.result();
  timing_.add(time_s, result.times);
  if (log_ != nullptr) log_->write(control_cycle_.record());
  if (result.mode == Mode::kFault && before != Mode::kFault) outcome_.faults.push_back(result.fault);

  if (!options_.always_hoisted) {
    hoist_.step(player_.current().hoist_without_policy && !options_.balanced_by_policy, kTickPeriod_s);
    plant_.set_hoist(hoist_.lift_m(), hoist_.engaged());
  }
}

void Lockstep::measure(double time_s) {
  const TickResult& result = tick_.result();
  const bool holding = result.mode == Mode::kStand || result.mode == Mode::kWalk;
  if (holding) slip_.add(result.reference, result.optimised);
  if (result.reference.phase_rate_per_s > 0.0) gait_period_s_ = 1.0 / result.reference.phase_rate_per_s;

  const sim::Truth truth = plant_.truth();
  const bool hoisted = options_.always_hoisted || hoist_.carrying();
  if (log_ != nullptr) log_->write_truth(static_cast<std::int64_t>(std::llround(time_s * 1e9)), truth, hoisted);
  if (hoisted) outcome_.hoisted_s += kTickPeriod_s;
  // Before standing nobody asked for anything yet; a fault, in contrast, is held against the user's command to the end.
  const bool judged = !hoisted && (holding || result.mode == Mode::kFault);
  if (judged) {
    const Command asked = result.mode == Mode::kStand ? Command{} : player_.current().command;
    metrics_.add(truth, asked, gait_period_s_);
  } else {
    metrics_.skip(truth);
  }
}

}  // namespace pmg::runtime
