#include "operator/robot_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "io/clock.hpp"
#include "io/plain_text.hpp"
#include "operator/command_text.hpp"
#include "operator/taken_command.hpp"
#include "operator/way_up.hpp"
#include "operator/words.hpp"
#include "pmg/command.hpp"
#include "pmg/types.hpp"
#include "pmg/variant.hpp"

namespace pmg::ops {

namespace {

constexpr double kNotEstimated = -1.0;  // status_t.foot_load

struct Hottest {
  double temperature_degC;
  std::string joint;
};

std::optional<Hottest> hottest(const RobotNews& news) {
  if (!news.state || news.state->temperature_degC.empty()) return std::nullopt;
  const std::vector<double>& temperature_degC = news.state->temperature_degC;
  const auto found = std::ranges::max_element(temperature_degC);
  const auto index = static_cast<std::size_t>(found - temperature_degC.begin());
  const bool named = news.info && index < news.info->joint_names.size();
  return Hottest{*found, named ? news.info->joint_names[index] : fmt::format("joint {}", index)};
}

/// The policy's variant (docs/reference/file-formats.md) in the configuration in force; pmg if the configuration has
/// none.
std::string variant(const pmg_msgs::robot_info_t& info) {
  const auto options = nlohmann::json::parse(info.options, nullptr, false);
  if (!options.is_object() || !options.contains("variant") || !options["variant"].is_string()) {
    return to_string(Variant::kPmg);
  }
  return options["variant"].get<std::string>();
}

std::string mode_text(const pmg_msgs::status_t& status) {
  return fmt::format("{}{}", mode_name(status.mode),
                     status.hanging           ? ", hanging"
                     : status.footing_unknown ? ", feet not judged yet"
                                              : "");
}

std::string driver(const pmg_msgs::status_t& status) {
  return status.driving_source.empty() ? "nobody" : status.driving_source;
}

std::string command_text(const double (&u)[kChannels]) {
  return fmt::format("vx {:+.2f}  vy {:+.2f}  omega {:+.2f}  pitch {:+.2f}  roll {:+.2f}  h {:+.3f}", u[kVx], u[kVy],
                     u[kOmega], u[kPitch], u[kRoll], u[kHeight]);
}

/// Counts of ignored messages, only those above zero.
std::string network_text(const pmg_msgs::link_t& link) {
  std::string text = fmt::format("{} accepted", link.accepted);
  for (const auto& [count, reason] :
       {std::pair{link.malformed, "malformed"}, std::pair{link.other_version, "of another version"},
        std::pair{link.other_robot, "for another robot"}, std::pair{link.not_fresh, "recorded or unsealed"},
        std::pair{link.no_key, "without a key"}, std::pair{link.flooded, "too many"},
        std::pair{link.other_source, "while another drives"}, std::pair{link.out_of_order, "out of order"},
        std::pair{link.late, "late"}, std::pair{link.not_finite, "not finite"},
        std::pair{link.no_lease, "without lease"}, std::pair{link.no_hoist, "for a hoist that isn't there"},
        std::pair{link.no_arms, "for arms that aren't there"}}) {
    if (count > 0) text += fmt::format(", {} {}", count, reason);
  }
  return text;
}

std::string timing_text(const RobotNews& news) {
  return fmt::format("wake-up p50 {:.0f} p99 {:.0f} us   tick p50 {:.0f} p99 {:.0f} us", news.wake_us.percentile(50),
                     news.wake_us.percentile(99), news.tick_us.percentile(50), news.tick_us.percentile(99));
}

/// From the state that the newest tick started from to that tick [s]; messages of one tick have STATUS' stamp.
std::optional<double> state_age_s(const RobotNews& news) {
  if (!news.state) return std::nullopt;
  return 1e-9 * static_cast<double>(news.status.stamp_ns - news.state->stamp_ns);
}

/// What somebody at a shell does next so that the robot stands; empty: nothing.
std::string next_text(const RobotNews& news, double silence_s) {
  return way_up(posture(news, news.heard_ns + io::nanoseconds(silence_s)), shell_manner());
}

}  // namespace

std::string limits_text(const RobotNews& news) {
  const pmg_msgs::status_t& status = news.status;
  std::string text = fmt::format("joints by range {}, speed {}, torque {}", status.limited_position,
                                 status.limited_rate, status.limited_torque);
  const pmg_msgs::reference_t* reference = reference_in_force(news);
  if (reference != nullptr && reference->command_limited) {
    const std::string why = beyond_reach(reference->user, news);
    text += why.empty() ? "; command" : fmt::format("; command: {}", why);
  }
  if (status.gco_held) text += "; ground-aware optimisation held";
  if (status.policy_held) text += "; policy held";
  return text;
}

std::string one_line(const RobotNews& news, double silence_s) {
  const pmg_msgs::status_t& status = news.status;
  std::string line = fmt::format("{:<12} {:<8} driven by {:<16}", status.robot, mode_text(status), driver(status));
  if (const pmg_msgs::reference_t* reference = reference_in_force(news)) {
    line += fmt::format(" vx {:+.2f} vy {:+.2f} omega {:+.2f}", reference->command[kVx], reference->command[kVy],
                        reference->command[kOmega]);
  }
  if (!news.tick_us.empty()) line += fmt::format(" tick p99 {:.0f} us", news.tick_us.percentile(99));
  if (!status.fault.empty()) line += "  FAULT " + status.fault;
  if (silence_s > kGone_s) line += fmt::format("  NOT HEARD for {:.0f} s", silence_s);
  return io::plain_text(line);
}

std::vector<std::string> screen(const RobotNews& news, double silence_s) {
  const pmg_msgs::status_t& status = news.status;
  std::vector<std::string> lines;
  const auto add = [&](const char* label, const std::string& text) {
    lines.push_back(io::plain_text(fmt::format("{:<11}{}", label, text)));
  };
  std::string who = status.robot;
  if (news.info) {
    who += fmt::format("   model {}   policy {}   backend {}", news.info->model, news.info->policy, news.info->backend);
  }
  add("robot", who);
  if (const auto trained = news.info ? variant_named(variant(*news.info)) : std::nullopt;
      trained && is_baseline(*trained)) {
    add("BASELINE", fmt::format("{}: a policy for comparison, not the controller's own", variant(*news.info)));
  }
  if (news.info) {
    add("software", fmt::format("{}   bundle {:.12}", news.info->software, news.info->bundle));
  }
  add("mode", fmt::format("{}{}", mode_text(status),
                          silence_s > kGone_s ? fmt::format("   NOT HEARD for {:.0f} s", silence_s) : ""));
  add("fault", status.fault.empty() ? "none" : status.fault);
  if (const std::string next = next_text(news, silence_s); !next.empty())
    for (std::string& line : io::wrapped(io::plain_text(fmt::format("{:<11}{}", "next", next)), 79, 11))
      lines.push_back(std::move(line));
  add("driven by", status.command_age_s < 0.0
                       ? driver(status) + "   no command yet"
                       : fmt::format("{}   last command {:.2f} s ago", driver(status), status.command_age_s));
  if (const pmg_msgs::reference_t* reference = reference_in_force(news)) {
    add("asked", command_text(reference->user));
    add("u", command_text(reference->command));
    add("u'", command_text(reference->optimised));
    add("gait", fmt::format("phase {:.2f}   left {}   right {}", reference->phase, reference->contact[0] ? "##" : "..",
                            reference->contact[1] ? "##" : ".."));
  }
  if (status.foot_load[kLeft] != kNotEstimated) {
    add("feet carry", fmt::format("left {:.0f} %  right {:.0f} % of the weight{}", 100.0 * status.foot_load[kLeft],
                                  100.0 * status.foot_load[kRight],
                                  status.hanging || status.footing_unknown ? ": the policy isn't run" : ""));
  }
  if (const auto age_s = state_age_s(news)) add("state", fmt::format("{:.1f} ms old", 1e3 * *age_s));
  add("limited", limits_text(news));
  if (const auto hot = hottest(news))
    add("hottest", fmt::format("{:.0f} degC at {}", hot->temperature_degC, hot->joint));
  if (news.timing) add("timing", timing_text(news));
  if (news.timing)
    add("lost", fmt::format("ticks missed {}   ticks not logged {}   answers {}", news.timing->missed_ticks,
                            news.timing->dropped_records, news.timing->dropped_acks));
  add("real-time", status.realtime ? "granted" : "NOT granted");
  if (news.link) add("messages", network_text(*news.link));
  if (news.info) {
    for (const std::string& refused : news.info->refused) add("refused", refused);
  }
  if (news.sessions > 2) add("WARNING", "several controllers speak under this name");
  return lines;
}

nlohmann::ordered_json news_json(const RobotNews& news, double silence_s) {
  const pmg_msgs::status_t& status = news.status;
  nlohmann::ordered_json json{
      {"robot", status.robot},
      {"session", status.session},
      {"mode", mode_name(status.mode)},
      {"fault_code", status.fault_code},
      {"fault", status.fault},
      {"driving_source", status.driving_source},
      {"command_age_s", status.command_age_s},
      {"silence_s", silence_s},
      {"realtime", status.realtime != 0},
      {"gco_held", status.gco_held != 0},
      {"policy_held", status.policy_held != 0},
      {"hanging", status.hanging != 0},
      {"footing_unknown", status.footing_unknown != 0},
      {"limited",
       {{"position", status.limited_position}, {"rate", status.limited_rate}, {"torque", status.limited_torque}}}};
  if (const std::string next = next_text(news, silence_s); !next.empty()) json["next"] = next;
  if (const auto tilt = tilt_rad(news)) json["tilt_rad"] = *tilt;
  if (const auto age_s = state_age_s(news)) json["state_age_s"] = *age_s;
  if (news.info) {
    json["info"] = {{"model", news.info->model},      {"software", news.info->software}, {"policy", news.info->policy},
                    {"variant", variant(*news.info)}, {"backend", news.info->backend},   {"bundle", news.info->bundle},
                    {"refused", news.info->refused}};
  }
  if (const pmg_msgs::reference_t* reference = reference_in_force(news)) {
    json["user"] = command_json(reference->user);
    json["command"] = command_json(reference->command);
    json["optimised"] = command_json(reference->optimised);
    json["phase"] = reference->phase;
    json["contact"] = {reference->contact[0] != 0, reference->contact[1] != 0};
  }
  if (status.foot_load[kLeft] != kNotEstimated) json["foot_load"] = {status.foot_load[kLeft], status.foot_load[kRight]};
  if (const auto hot = hottest(news)) {
    json["hottest"] = {{"temperature_degC", hot->temperature_degC}, {"joint", hot->joint}};
  }
  if (news.timing) {
    json["timing"] = {{"wake_p50_us", news.wake_us.percentile(50)}, {"wake_p99_us", news.wake_us.percentile(99)},
                      {"tick_p50_us", news.tick_us.percentile(50)}, {"tick_p99_us", news.tick_us.percentile(99)},
                      {"missed_ticks", news.timing->missed_ticks},  {"dropped_records", news.timing->dropped_records},
                      {"dropped_acks", news.timing->dropped_acks}};
  }
  if (news.link) {
    const pmg_msgs::link_t& link = *news.link;
    json["messages"] = {{"accepted", link.accepted},
                        {"malformed", link.malformed},
                        {"other_version", link.other_version},
                        {"other_robot", link.other_robot},
                        {"not_fresh", link.not_fresh},
                        {"no_key", link.no_key},
                        {"flooded", link.flooded},
                        {"other_source", link.other_source},
                        {"out_of_order", link.out_of_order},
                        {"late", link.late},
                        {"not_finite", link.not_finite},
                        {"no_lease", link.no_lease},
                        {"no_hoist", link.no_hoist}};
  }
  return json;
}

}  // namespace pmg::ops
