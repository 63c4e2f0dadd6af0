#include "report/run_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "control/mode.hpp"
#include "pages/histogram.hpp"
#include "sil/summary.hpp"

namespace pmg::report {

namespace {

constexpr std::size_t kShownHash = 12;  // hexadecimal digits, enough to distinguish bundles

nlohmann::ordered_json events_json(const std::vector<RunSeries::Event>& events) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const RunSeries::Event& event : events) json.push_back({{"t_s", event.t_s}, {"text", event.text}});
  return json;
}

nlohmann::ordered_json times_json(const Sampled& times_us) {
  return {{"p50", pages::percentile(times_us.values(), 0.50)}, {"p99", pages::percentile(times_us.values(), 0.99)}};
}

}  // namespace

std::vector<bool> holding(const RunSeries& run, std::span<const double> t_s) {
  std::vector<bool> held(t_s.size(), run.modes.empty());
  std::size_t at = 0;
  for (std::size_t i = 0; i < t_s.size() && !run.modes.empty(); ++i) {
    while (at + 1 < run.modes.size() && run.modes[at + 1].from_s <= t_s[i]) ++at;
    const std::string& mode = run.modes[at].text;
    held[i] = run.modes[at].from_s <= t_s[i] &&
              (mode == to_string(control::Mode::kStand) || mode == to_string(control::Mode::kWalk));
  }
  return held;
}

std::string tracking_text(const RunSeries& run) {
  const sil::TrackingSummary& t = run.tracking;
  if (t.followed_s <= 0.0) return "";
  return fmt::format(
      "Mean absolute errors over {:.1f} s{}: velocity {:.3f} m/s, yaw rate {:.3f} rad/s, roll {:.3f} rad, "
      "pitch {:.3f} rad, height {:.3f} m; its loaded feet slip at {:.4f} m/s.",
      t.followed_s, run.fell ? ", what came after the fall included" : " on its own feet", t.lin_vel_mae_m_s,
      t.yaw_vel_mae_rad_s, t.roll_mae_rad, t.pitch_mae_rad, t.height_mae_m, t.foot_slip_mean_m_s);
}

std::string limited_text(const RunSeries& run) {
  if (run.limited.empty()) return "";
  const LimitedJoint& most = run.limited.front();
  std::string text = fmt::format("Limited: {} by {}, first at {:.2f} s", run.joint_names[most.joint], most.reasons(),
                                 most.stretches.front().from_s);
  if (run.limited.size() == 2) {
    text += fmt::format("; and {}", run.joint_names[run.limited[1].joint]);
  } else if (run.limited.size() > 2) {
    text += fmt::format("; and {} more joints", run.limited.size() - 1);
  }
  return text + ".";
}

double hanging_s(const RunSeries& run) {
  double all_s = 0.0;
  for (const RunSeries::Stretch& stretch : run.hanging) all_s += stretch.to_s - stretch.from_s;
  return all_s;
}

work::Worth worth_of_reading(const RunSeries& run) {
  work::Worth worth;
  worth.add_if(run.interrupted, work::Grade::kInterrupted, run.name + ": the rest of the log was not read");
  for (const std::string& problem : run.problems)
    worth.add(work::Grade::kPartial, fmt::format("{}: {}", run.name, problem));
  return worth;
}

work::Worth worth_of(const RunSeries& run) {
  work::Worth worth;
  worth.add_if(!run.faults.empty(), work::Grade::kMissed, "the robot faulted");
  worth.add_if(run.fell, work::Grade::kMissed, "the robot fell");
  worth.add_if(run.cut.commands > 0, work::Grade::kPartial,
               "the command was cut, and the robot did what was admitted: " + sil::cut_text(run.cut));
  worth.add_if(run.modes.empty(), work::Grade::kOpen, "the log doesn't say whether there was a fault");
  worth.add_if(hanging_s(run) > 0.5 * run.duration_s, work::Grade::kOpen, "the feet carried nothing for most of it");
  return worth;
}

std::string verdict(const RunSeries& run) {
  std::string text = run.name + ": ";
  if (run.identified) {
    const auto& info = run.info;
    text += info.robot == info.model ? info.robot : fmt::format("{} (a {})", info.robot, info.model);
    text += fmt::format(", policy {}", info.policy.empty() ? "unknown" : info.policy);
    if (!info.bundle.empty()) text += ", bundle " + info.bundle.substr(0, kShownHash);
  } else {
    text += "unknown robot";
  }
  text += fmt::format(", {:.1f} s. ", run.duration_s);
  if (run.faults.empty()) {
    text += run.modes.empty() ? "Whether there was a fault is unknown" : "No fault";
  } else {
    text += fmt::format("FAULT at {:.2f} s: {}", run.faults.front().t_s, run.faults.front().text);
    if (run.faults.size() > 1) text += fmt::format(" (and {} more)", run.faults.size() - 1);
  }
  if (run.fell) {
    text += fmt::format(". FELL at {:.2f} s", run.fell_at_s);
  } else if (!run.truth.t_s.empty()) {
    text += ", did not fall";
  }
  text += ".";
  if (run.cut.commands > 0)
    text += fmt::format(" COMMAND CUT for {:.1f} s: {}.", run.cut.for_s, sil::cut_text(run.cut));
  if (hanging_s(run) > 0.0) {
    text += fmt::format(" For {:.1f} s the feet carried nothing and the policy was not run.", hanging_s(run));
  }
  for (const std::string& more : {tracking_text(run), limited_text(run)}) {
    if (!more.empty()) text += " " + more;
  }
  return text;
}

nlohmann::ordered_json run_json(const RunSeries& run) {
  using nlohmann::ordered_json;
  ordered_json modes = ordered_json::object(), errors = ordered_json::object();
  for (const RunSeries::Stretch& mode : run.modes) {
    modes[mode.text] = modes.value(mode.text, 0.0) + mode.to_s - mode.from_s;
  }
  for (std::size_t i = 0; i < run.joint_tracking.size(); ++i)
    errors[run.joint_names[i]] = run.joint_tracking[i].error_rms_rad;
  ordered_json limited = ordered_json::array(), steps = ordered_json::array();
  for (const LimitedJoint& one : run.limited) {
    limited.push_back({{"joint", run.joint_names[one.joint]},
                       {"first_s", one.stretches.front().from_s},
                       {"longest_s", one.longest_s},
                       {"position_ticks", one.ticks[0]},
                       {"rate_ticks", one.ticks[1]},
                       {"torque_ticks", one.ticks[2]}});
  }
  for (const RunSeries::Step& step : run.steps) {
    steps.push_back({{"number", step.number}, {"from_s", step.from_s}, {"to_s", step.to_s}, {"text", step.text}});
  }
  const bool judged = run.tracking.followed_s > 0.0;
  ordered_json json = {
      {"log", run.name},
      {"robot", run.info.robot},
      {"model", run.info.model},
      {"software", run.info.software},
      {"policy", run.info.policy},
      {"backend", run.info.backend},
      {"bundle", run.info.bundle},
      {"duration_s", run.duration_s},
      {"fell", run.fell},
      {"fell_at_s", run.fell ? ordered_json(run.fell_at_s) : ordered_json(nullptr)},
      {"faults", events_json(run.faults)},
      {"guard_trips", events_json(run.guard_trips)},
      {"modes_s", modes},
      {"hanging_s", hanging_s(run)},
      {"tracking_rms_rad", errors},
      {"tracking", judged ? sil::tracking_json(run.tracking) : ordered_json(nullptr)},
      {"reference_slip", sil::reference_slip_json(run.reference_slip)},
      {"command_cut", sil::cut_json(run.cut)},
      {"scenario", run.scenario.empty() ? ordered_json(nullptr) : ordered_json(run.scenario)},
      {"steps", steps},
      {"limited_joints", limited},
      {"limited_ticks",
       {{"position", run.status.position_ticks}, {"rate", run.status.rate_ticks}, {"torque", run.status.torque_ticks}}},
      {"timing_us", {{"tick", times_json(run.timing.tick_us)}, {"wake", times_json(run.timing.wake_us)}}},
      {"lost_ticks", run.lost_ticks},
      {"problems", run.problems}};
  work::Worth whole = worth_of_reading(run);
  whole.add(worth_of(run));
  add_to(json, whole);
  add_to(json["reading"], worth_of_reading(run));
  return json;
}

}  // namespace pmg::report
