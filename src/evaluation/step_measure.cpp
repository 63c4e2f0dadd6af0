#include "evaluation/step_measure.hpp"

#include <limits>

#include "control/control_cycle.hpp"

namespace pmg::evaluation {

namespace {

Errors over(const Errors& sums, double seconds) {
  Errors mean{};
  for (std::size_t e = 0; e < kErrors && seconds > 0.0; ++e) mean[e] = sums[e] / seconds;
  return mean;
}

}  // namespace

void StepMeasure::add(double time_s, const control::TickResult& result, const model::GroundTruth& truth, bool hoisted,
                      const sil::ScenarioStep& step) {
  const bool judged =
      time_s < step.start_s + step.duration_s - step.unjudged_s - 0.5 * control::ControlCycle::kPeriod_s;
  if (!judged || &step != step_) close_step();
  step_ = judged ? &step : nullptr;
  measure_.add(result, truth, hoisted, step.command);  // averages over a gait period go on
  if (!judged) before_ = total();
}

void StepMeasure::count_as_fallen(double from_s, const control::TickResult& result, model::GroundTruth last) {
  last.p_WB.setZero();
  control::TickResult held = result;
  if (held.mode != control::Mode::kStand) held.mode = control::Mode::kWalk;
  for (double time_s = from_s; time_s < scenario_.duration_s() - 1e-9; time_s += control::ControlCycle::kPeriod_s) {
    add(time_s, held, last, false, scenario_.at(time_s));
  }
}

void StepMeasure::report(TrialResult& result) {
  close_step();
  step_ = nullptr;
  result.judged_s = within_.seconds + beyond_.seconds;
  result.errors = over(within_.errors, within_.seconds);
  result.errors_raw = over(within_.raw, within_.seconds);
  if (beyond_.seconds > 0.0) result.errors_beyond_reach = over(beyond_.errors, beyond_.seconds);
  result.step_errors = step_errors_;
}

StepMeasure::Sums StepMeasure::total() const {
  const sil::TrackingSummary now = measure_.outcome().tracking;
  Sums sums{{now.lin_vel_mae_m_s, now.yaw_vel_mae_rad_s, now.roll_mae_rad, now.pitch_mae_rad, now.height_mae_m},
            {now.lin_vel_raw_mae_m_s, now.yaw_vel_raw_mae_rad_s, now.roll_raw_mae_rad, now.pitch_raw_mae_rad,
             now.height_raw_mae_m},
            now.followed_s};
  for (std::size_t e = 0; e < kErrors; ++e) {
    sums.errors[e] *= sums.seconds;
    sums.raw[e] *= sums.seconds;
  }
  return sums;
}

void StepMeasure::close_step() {
  if (step_ == nullptr) return;
  const Sums now = total();
  const double seconds = now.seconds - before_.seconds;
  Errors mean;
  mean.fill(std::numeric_limits<double>::quiet_NaN());
  if (seconds > 0.5 * control::ControlCycle::kPeriod_s) {
    Sums& group = step_->beyond_reach ? beyond_ : within_;
    for (std::size_t e = 0; e < kErrors; ++e) {
      mean[e] = (now.errors[e] - before_.errors[e]) / seconds;
      group.errors[e] += now.errors[e] - before_.errors[e];
      group.raw[e] += now.raw[e] - before_.raw[e];
    }
    group.seconds += seconds;
  }
  step_errors_.push_back(mean);
  before_ = now;
}

}  // namespace pmg::evaluation
