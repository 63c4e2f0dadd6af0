#include "sil/run_measure.hpp"

#include "control/control_cycle.hpp"

namespace pmg::sil {

namespace {
constexpr double kGaitPeriodBeforeWalking_s = 1.0;  // what averages run over until the generator has told a period
}  // namespace

RunMeasure::RunMeasure(double standing_height_m)
    : metrics_(standing_height_m, control::ControlCycle::kPeriod_s), gait_period_s_(kGaitPeriodBeforeWalking_s) {}

void RunMeasure::add(const control::TickResult& result, const model::GroundTruth& truth, bool hoisted,
                     const Command& asked) {
  add_reference(result);
  add_truth(result, truth, hoisted, asked);
}

void RunMeasure::add_reference(const control::TickResult& result) {
  ++ticks_;
  if (control::hanging(result.maker)) sums_.hanging_s += control::ControlCycle::kPeriod_s;
  if (result.mode == control::Mode::kFault && last_mode_ != control::Mode::kFault) sums_.faults.push_back(result.fault);
  last_mode_ = result.mode;

  if (control::upright(result.mode)) {
    slip_.add(result.reference, result.optimised);
    cuts_.add(result.user, result.reference.command, result.reference.command_limited);
  } else {
    cuts_.skip();
  }
  if (result.reference.phase_rate_per_s > 0.0) gait_period_s_ = 1.0 / result.reference.phase_rate_per_s;
}

void RunMeasure::add_truth(const control::TickResult& result, const model::GroundTruth& truth, bool hoisted,
                           const Command& asked) {
  if (hoisted) sums_.hoisted_s += control::ControlCycle::kPeriod_s;
  // Before standing nobody asked for anything yet; a fault, in contrast, is held against the user's command to the end.
  const bool judged = !hoisted && (control::upright(result.mode) || result.mode == control::Mode::kFault);
  if (judged) {
    metrics_.add(truth, result.mode == control::Mode::kStand ? Command{} : asked, gait_period_s_);
  } else {
    metrics_.skip(truth);
  }
}

RunOutcome RunMeasure::outcome() const {
  RunOutcome outcome = sums_;
  outcome.duration_s = static_cast<double>(ticks_) * control::ControlCycle::kPeriod_s;
  outcome.fell = metrics_.fell();
  outcome.fell_at_s = metrics_.fell_at_s();
  outcome.tracking = metrics_.summary();
  outcome.reference_slip = slip_.summary();
  outcome.cut = cuts_.worst();
  return outcome;
}

}  // namespace pmg::sil
