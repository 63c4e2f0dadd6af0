#include "operator/keyboard_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "operator/robot_text.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

namespace {

std::string command_row(const char* label, const double* u) {
  return fmt::format("{:<10}{:+9.2f}{:+9.2f}{:+9.2f}{:+9.2f}{:+9.2f}{:+9.2f}", label, u[kVx], u[kVy], u[kOmega],
                     u[kPitch], u[kRoll], u[kHeight]);
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
  return text;
}

}  // namespace

std::optional<CommandLimits> command_limits(const pmg_msgs::robot_info_t& info) {
  const auto options = nlohmann::json::parse(info.options, nullptr, false);
  if (!options.is_object() || !options.contains("command")) return std::nullopt;
  CommandLimits limits;
  for (std::size_t i = 0; i < kChannels; ++i) {
    for (const auto& [end, values] : {std::pair{"lower", &limits.lower}, std::pair{"upper", &limits.upper}}) {
      const nlohmann::json::json_pointer place(fmt::format("/command/{}/{}", end, kChannelNames[i]));
      if (!options.contains(place) || !options[place].is_number()) return std::nullopt;
      (*values)[i] = options[place].get<double>();
    }
    // Zero is always allowed: what a key that is let go asks for.
    if (!(limits.lower[i] <= 0.0 && limits.upper[i] >= 0.0)) return std::nullopt;
  }
  return limits;
}

std::vector<std::string> driving_lines(const KeyboardDriver& driver, const RobotNews* news, double silence_s) {
  std::vector<std::string> lines;
  if (news == nullptr) return {printable(fmt::format("{}: {}", driver.robot(), driver.text()))};
  const pmg_msgs::status_t& status = news->status;
  const bool silent = silence_s > kGone_s;
  lines.push_back(fmt::format("{}: {}   {}", printable(driver.robot()),
                              silent ? "NOT HEARD" : upper_case(mode_name(status.mode)), printable(driver.text())));
  lines.push_back(fmt::format("{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}", "", "forwards", "left", "turn", "bend", "lean",
                              "height"));
  lines.push_back(fmt::format("{:<10}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}", "", "m/s", "m/s", "rad/s", "rad", "rad", "m"));
  lines.push_back(command_row("asked", driver.asked().u.data()));
  if (news->reference) lines.push_back(command_row("taken", news->reference->command));
  lines.push_back(fmt::format("{:<10}{}", "limited", limits_text(*news)));
  lines.push_back(fmt::format("{:<10}{}", "fault", status.fault.empty() ? "none" : printable(status.fault)));
  const std::string age = status.command_age_s < 0.0 ? "" : fmt::format(", last command {:.0f} ms old", status.command_age_s * 1e3);
  lines.push_back(fmt::format("{:<10}{}{}; heard {:.0f} ms ago", "driven by",
                              status.driving_source.empty() ? "nobody" : printable(status.driving_source), age,
                              silence_s * 1e3));
  if (news->info) {
    lines.push_back(fmt::format("{:<10}{}, backend {}", "policy", printable(news->info->policy),
                                printable(news->info->backend)));
  }
  return lines;
}

std::vector<std::string> key_lines(KeyReport report, const std::string& closing) {
  std::vector<std::string> lines = {
      "W S   forwards, backwards (or arrows)     I K   rise, squat",
      "A D   turn left, right (or arrows)        O U   bend forwards, back",
      "Q E   step to the left, right             J L   lean left, right",
      "Shift faster      Space  velocity to zero N     upright again",
      "Esc   DAMPS AT ONCE (so does Backspace)   Enter stand (after a stop, too)",
      "R     reset a fault                       H G   hoist: lift, set down",
  };
  lines.push_back(report == KeyReport::kPressAndRelease
                      ? "A key that is let go brings velocity to zero, then Stand. " + closing
                      : "Each press is a step; a second without any key brings velocity to zero. " + closing);
  return lines;
}

}  // namespace pmg::ops
