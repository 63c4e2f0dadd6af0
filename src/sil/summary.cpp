#include "sil/summary.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace pmg::sil {

namespace {

nlohmann::ordered_json stage_json(const StageTiming& timing, std::int64_t control::StageTimes::*stage) {
  const Percentiles times = timing.percentiles(stage);
  return {{"p50", times.p50_us}, {"p99", times.p99_us}};
}

}  // namespace

nlohmann::ordered_json tracking_json(const TrackingSummary& tracking) {
  return {{"lin_vel_mae_m_s", tracking.lin_vel_mae_m_s},
          {"lin_vel_raw_mae_m_s", tracking.lin_vel_raw_mae_m_s},
          {"yaw_vel_mae_rad_s", tracking.yaw_vel_mae_rad_s},
          {"yaw_vel_raw_mae_rad_s", tracking.yaw_vel_raw_mae_rad_s},
          {"roll_mae_rad", tracking.roll_mae_rad},
          {"roll_raw_mae_rad", tracking.roll_raw_mae_rad},
          {"pitch_mae_rad", tracking.pitch_mae_rad},
          {"pitch_raw_mae_rad", tracking.pitch_raw_mae_rad},
          {"height_mae_m", tracking.height_mae_m},
          {"height_raw_mae_m", tracking.height_raw_mae_m},
          {"foot_slip_mean_m_s", tracking.foot_slip_mean_m_s},
          {"followed_s", tracking.followed_s}};
}

nlohmann::ordered_json reference_slip_json(const gco::SlipSummary& slip) {
  return {{"before_mean_m_s", slip.before_mean_m_s},
          {"after_mean_m_s", slip.after_mean_m_s},
          {"single_support_max_m_s", slip.single_support_max_m_s},
          {"double_support_mean_m_s", slip.double_support_mean_m_s},
          {"double_support_p95_m_s", slip.double_support_p95_m_s},
          {"lower_foot_height_max_m", slip.lower_foot_height_max_m},
          {"other_foot_height_max_m", slip.other_foot_height_max_m},
          {"not_converged_ticks", slip.not_converged_ticks}};
}

nlohmann::ordered_json summary_json(const RunIdentity& run, const RunOutcome& outcome, const StageTiming& timing,
                                    const model::RobotModel& robot) {
  nlohmann::ordered_json faults = nlohmann::ordered_json::array();
  for (const faults::Fault& fault : outcome.faults) {
    faults.push_back({{"t_s", static_cast<double>(fault.stamp_ns) * 1e-9},
                      {"code", to_string(fault.code)},
                      {"text", describe(fault, robot)}});
  }
  nlohmann::ordered_json json = {
      {"robot", run.robot},
      {"scenario", run.scenario},
      {"policy", run.policy},
      {"variant", run.variant.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(run.variant)},
      {"seed", run.seed},
      {"fell", outcome.fell},
      {"fell_at_s", outcome.fell ? nlohmann::ordered_json(outcome.fell_at_s) : nlohmann::ordered_json(nullptr)},
      {"diverged", outcome.diverged},
      {"interrupted", outcome.interrupted},
      {"duration_s", outcome.duration_s},
      {"hoisted_s", outcome.hoisted_s},
      {"hanging_s", outcome.hanging_s},
      {"wall_s", run.wall_s},
      {"realtime_factor", run.wall_s > 0.0 ? outcome.duration_s / run.wall_s : 0.0},
      {"tracking", tracking_json(outcome.tracking)},
      {"reference_slip", reference_slip_json(outcome.reference_slip)},
      {"command_cut", cut_json(outcome.cut)},
      {"timing_us",
       {{"tick", stage_json(timing, &control::StageTimes::tick_ns)},
        {"generator", stage_json(timing, &control::StageTimes::generator_ns)},
        {"gco", stage_json(timing, &control::StageTimes::gco_ns)},
        {"policy", stage_json(timing, &control::StageTimes::policy_ns)}}},
      {"faults", faults}};
  return json;
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json) {
  std::ofstream out(file);
  out << json.dump(2) << '\n';
  if (!out.flush()) throw std::runtime_error(file.string() + ": can't be written");
}

}  // namespace pmg::sil
