#include "report/series_samples.hpp"

#include <limits>

#include "control/mode.hpp"
#include "io/plain_text.hpp"

namespace pmg::report {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

constexpr double kLoadedFoot_N = 20.0;  // as in the metrics: below it a foot counts as unloaded
constexpr double kDelayed_us = 2000.0;  // one bus cycle; a longer delay has its cause on the host
constexpr std::int64_t kListedDelays = 30;

void append_row(const std::vector<double>& row, RunSeries::JointSamples& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i].push_back(static_cast<float>(row[i]));
}

/// A new text begins a new stretch.
void extend(std::vector<RunSeries::Stretch>& stretches, double t_s, const std::string& text) {
  if (!stretches.empty()) stretches.back().to_s = t_s;
  if (stretches.empty() || stretches.back().text != text) stretches.push_back({t_s, t_s, text});
}

}  // namespace

void append(const pmg_msgs::robot_state_t& message, double t_s, RunSeries& run) {
  run.state.t_s.push_back(t_s);
  append_row(message.q_rad, run.state.q_rad);
  append_row(message.torque_Nm, run.state.torque_Nm);
  append_row(message.temperature_degC, run.state.temperature_degC);
}

void append(const pmg_msgs::reference_t& message, double t_s, RunSeries& run) {
  auto& to = run.reference;
  to.t_s.push_back(t_s);
  append_row(message.q_ref_rad, to.q_ref_rad);
  for (std::size_t channel = 0; channel < kChannels; ++channel) {
    to.user[channel].push_back(message.user[channel]);
    to.command[channel].push_back(message.command[channel]);
    to.optimised[channel].push_back(message.optimised[channel]);
  }
  for (std::size_t foot = 0; foot < 2; ++foot) {
    to.contact[foot].add(t_s, message.contact[foot] != 0, kLongestGap_s);
    to.slip_before_m_s[foot].push_back(message.slip_before_m_s[foot]);
    to.slip_after_m_s[foot].push_back(message.slip_after_m_s[foot]);
  }
  to.not_converged += message.gco_status == pmg_msgs::reference_t::NOT_CONVERGED;
  to.command_limited += message.command_limited != 0;
  to.joint_clamped += message.joint_clamped != 0;
}

void append(const pmg_msgs::status_t& message, double t_s, RunSeries& run) {
  extend(run.modes, t_s, to_string(static_cast<control::Mode>(message.mode)));
  extend(run.sources, t_s, io::plain_text(message.driving_source));
  extend(run.hanging, t_s, message.hanging ? "hanging, no policy" : "");
  run.status.t_s.push_back(t_s);
  run.status.limited_position.push_back(message.limited_position);
  run.status.limited_rate.push_back(message.limited_rate);
  run.status.limited_torque.push_back(message.limited_torque);
  ++run.status.ticks;
  run.status.position_ticks += message.limited_position > 0;
  run.status.rate_ticks += message.limited_rate > 0;
  run.status.torque_ticks += message.limited_torque > 0;
}

void add_times(RunTiming& to, double tick_us, double generator_us, double gco_us, double policy_us) {
  ++to.ticks;
  to.tick_us.add(tick_us);
  const auto stage = [](Sampled& times, double time_us) { times.add(time_us > 0.0 ? time_us : kNone); };  // 0: not run
  stage(to.generator_us, generator_us);
  stage(to.gco_us, gco_us);
  stage(to.policy_us, policy_us);
}

void append(const pmg_msgs::timing_t& message, double t_s, RunSeries& run) {
  auto& to = run.timing;
  const bool cycles = message.bus_cycles > 0;
  add_times(to, us(message.tick_ns), us(message.generator_ns), us(message.gco_ns), us(message.policy_ns));
  to.wake_us.add(us(message.wake_ns));
  to.bus_wake_us.add(cycles ? us(message.bus_wake_max_ns) : kNone);
  to.bus_exchange_us.add(cycles ? us(message.bus_exchange_max_ns) : kNone);
  const auto delay = [&](double late_us, const char* thread) {
    if (!(late_us > kDelayed_us)) return;
    if (to.delay_count++ < kListedDelays) to.delays.push_back({t_s, late_us, thread});
  };
  delay(us(message.wake_ns), "control");
  if (cycles) delay(us(message.bus_wake_max_ns), "bus");
  to.missed_ticks = message.missed_ticks;
  to.bus_missed_cycles = message.bus_missed_cycles;
  to.dropped_records = message.dropped_records;
}

void append(const pmg_msgs::ground_truth_t& message, const std::array<double, kChannels>& measured, double t_s,
            RunSeries& run) {
  auto& to = run.truth;
  to.t_s.push_back(t_s);
  for (std::size_t channel = 0; channel < kChannels; ++channel)
    to.measured[channel].push_back(message.hoisted != 0 ? kNone : measured[channel]);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    to.loaded[foot].add(t_s, message.foot_force_N[foot] > kLoadedFoot_N, kLongestGap_s);
    to.foot_slip_m_s[foot].push_back(message.foot_slip_m_s[foot]);
  }
  extend(run.hoisted, t_s, message.hoisted != 0 ? "on the gantry" : "");
}

void append(const pmg_msgs::tick_input_t& message, double t_s, RunSeries& run) {
  if (message.guard_trip == pmg_msgs::tick_input_t::CONTROL_FROZEN)
    run.guard_trips.push_back({t_s, "the bus guard damped: no fresh command from the control thread"});
  if (message.guard_trip == pmg_msgs::tick_input_t::COMMAND_NOT_FINITE)
    run.guard_trips.push_back({t_s, "the bus guard damped: a command that was no number"});
  if (message.stop) run.stops.push_back({t_s, "stop"});
}

pmg_msgs::robot_info_t plain(pmg_msgs::robot_info_t info) {
  for (std::string* text :
       {&info.robot, &info.model, &info.software, &info.policy, &info.backend, &info.bundle, &info.options}) {
    *text = io::plain_text(*text);
  }
  for (auto* texts : {&info.refused, &info.joint_names, &info.bundle_file}) {
    for (std::string& text : *texts) text = io::plain_text(text);
  }
  return info;
}

}  // namespace pmg::report
