#include "sil/run_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "control/mode_text.hpp"

namespace pmg::sil {

std::string progress_text(const RunProgress& progress) {
  const std::string of = std::isfinite(progress.duration_s) ? fmt::format(" / {:.1f}", progress.duration_s) : "";
  return fmt::format("{:6.1f}{} s  {:8} {}", progress.time_s, of,
                     control::mode_text(progress.result.mode, control::hanging(progress.result.maker)),
                     progress.step.text);
}

std::string run_text(const RunOutcome& outcome, const nlohmann::ordered_json& summary) {
  const TrackingSummary& tracking = outcome.tracking;
  const gco::SlipSummary& slip = outcome.reference_slip;
  std::string text = fmt::format(
      "{}: {:.1f} s simulated ({:.1f} s on the gantry), {:.1f}x real time, {}{}{}\n",
      summary["scenario"].get<std::string>(), outcome.duration_s, outcome.hoisted_s,
      summary["realtime_factor"].get<double>(), outcome.fell ? "FELL" : "did not fall",
      outcome.interrupted ? ", interrupted" : "",
      outcome.cut.commands > 0 ? fmt::format(", COMMAND CUT for {:.1f} s: {}", outcome.cut.for_s, cut_text(outcome.cut))
                               : "");
  text += fmt::format(
      "tracking over {:.1f} s: velocity {:.3f} m/s, yaw {:.3f} rad/s, pitch {:.3f} rad, roll {:.3f} rad, height {:.3f} "
      "m\n",
      tracking.followed_s, tracking.lin_vel_mae_m_s, tracking.yaw_vel_mae_rad_s, tracking.pitch_mae_rad,
      tracking.roll_mae_rad, tracking.height_mae_m);
  text +=
      fmt::format("reference slip: single support {:.4f} m/s at most, double support {:.4f} m/s mean, {:.4f} m/s p95\n",
                  slip.single_support_max_m_s, slip.double_support_mean_m_s, slip.double_support_p95_m_s);
  if (outcome.hanging_s > 0.0) {
    text += fmt::format("the feet carried nothing for {:.1f} s: there the policy did not run, nor did the robot walk\n",
                        outcome.hanging_s);
  }
  if (outcome.diverged) text += "the simulation diverged\n";
  for (const auto& fault : summary["faults"]) {
    text += fmt::format("fault at {:.2f} s: {}\n", fault["t_s"].get<double>(), fault["text"].get<std::string>());
  }
  if (summary.contains("punctuality")) {
    for (const char* thread : {"control", "bus"}) {
      const auto& times = summary["punctuality"][thread];
      text += fmt::format("{} thread: {} cycles, wake-up p50 {:.0f} us, p99 {:.0f} us, {} delayed by the host\n",
                          thread, times["cycles"].get<std::int64_t>(), times["wake_us"]["p50"].get<double>(),
                          times["wake_us"]["p99"].get<double>(), times["delayed_count"].get<std::int64_t>());
    }
  }
  return text;
}

}  // namespace pmg::sil
