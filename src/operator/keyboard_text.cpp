#include "operator/keyboard_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/plain_text.hpp"
#include "operator/command_text.hpp"
#include "operator/robot_text.hpp"
#include "operator/words.hpp"

namespace pmg::ops {

namespace {

constexpr std::array kOrder = {kVx, kVy, kOmega, kPitch, kRoll, kHeight};

constexpr std::size_t kLeastState = 8;  // mode and what to do in four lines, and the commands

struct Row {
  std::string label, value;
};

constexpr std::array<std::pair<const char*, const char*>, 12> kMeanings = {{
    {"W S", "forwards, backwards (or arrows)"},
    {"A D", "turn left, right (or arrows)"},
    {"Q E", "step to the left, right"},
    {"Shift", "faster"},
    {"Space", "velocity to zero"},
    {"Esc", "DAMPS AT ONCE (Backspace, too)"},
    {"I K", "rise, squat"},
    {"O U", "bend forwards, back"},
    {"J L", "lean left, right"},
    {"N", "upright again"},
    {"Enter", "stand, after a stop, too"},
    {"H G R", "hoist up, down; reset a fault"},
}};

std::string command_row(const char* label, const double* u) {
  std::string row = fmt::format("{:<10}", label);
  for (const Channel channel : kOrder) row += fmt::format("{:+10.2f}", u[channel]);
  return row;
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
  return text;
}

std::string time_words(double time_s) {
  return time_s < 1.0 ? fmt::format("{:.0f} ms", time_s * 1e3) : fmt::format("{:.0f} s", time_s);
}

std::vector<Row> head_rows(const RobotDriver& driver, const RobotNews* news, double silence_s) {
  const char* mode = news == nullptr       ? "not heard"
                     : silence_s > kGone_s ? "no longer heard"
                                           : mode_name(news->status.mode);
  return {{driver.robot() + " " + upper_case(mode), driver.text()}};
}

std::vector<Row> status_rows(const RobotNews& news, double silence_s) {
  const pmg_msgs::status_t& status = news.status;
  const std::string who = status.driving_source.empty() ? "nobody" : status.driving_source;
  const std::string age =
      status.command_age_s < 0.0 ? "" : fmt::format(", last command {} old", time_words(status.command_age_s));
  std::vector<Row> rows = {{"fault", status.fault.empty() ? "none" : status.fault},
                           {"limited", limits_text(news)},
                           {"driven by", fmt::format("{}{}; heard {} ago", who, age, time_words(silence_s))}};
  if (news.info) {
    rows.push_back({"policy", fmt::format("{}, backend {}", news.info->policy, news.info->backend)});
  }
  return rows;
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
    // A released key commands zero, so zero is always allowed.
    if (!(limits.lower[i] <= 0.0 && limits.upper[i] >= 0.0)) return std::nullopt;
  }
  return limits;
}

std::vector<std::string> driving_lines(const RobotDriver& driver, const RobotNews* news, double silence_s) {
  std::vector<std::string> lines;
  const auto add = [&lines](const std::string& text, std::size_t indent) {
    constexpr std::size_t kWidth = 79;  // what a terminal cuts off isn't read
    for (std::string& line : io::wrapped(io::plain_text(text), kWidth, indent)) lines.push_back(std::move(line));
  };
  for (const Row& row : head_rows(driver, news, silence_s)) add(row.label + "   " + row.value, 4);
  if (news == nullptr) return lines;
  lines.push_back(fmt::format("{:<10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}", "", "forwards", "left", "turn", "bend",
                              "lean", "height"));
  lines.push_back(
      fmt::format("{:<10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}", "", "m/s", "m/s", "rad/s", "rad", "rad", "m"));
  lines.push_back(command_row("asked", driver.asked().u.data()));
  if (const auto* reference = reference_in_force(*news)) lines.push_back(command_row("taken", reference->command));
  for (const Row& row : status_rows(*news, silence_s)) add(fmt::format("{:<10}{}", row.label, row.value), 10);
  return lines;
}

DrivingTable driving_table(const RobotDriver& driver, const RobotNews* news, double silence_s) {
  std::vector<Row> rows = head_rows(driver, news, silence_s);
  if (news != nullptr) {
    constexpr std::array kLabels = {"forwards", "left", "turn", "bend", "lean", "height"};
    for (std::size_t i = 0; i < kChannels; ++i) {
      const std::size_t channel = kOrder[i];
      const pmg_msgs::reference_t* reference = reference_in_force(*news);
      const std::string taken =
          reference != nullptr ? fmt::format("{:+.2f} {} taken", reference->command[channel], kCommandUnits[channel])
                               : "";
      rows.push_back({kLabels[i], fmt::format("{:+.2f} asked   {}", driver.asked().u[channel], taken)});
    }
    for (const Row& row : status_rows(*news, silence_s)) rows.push_back(row);
  }
  DrivingTable table;
  for (const Row& row : rows) {
    const char* const separator = &row == rows.data() ? "" : "\n";
    table.labels.append(separator).append(io::plain_text(row.label));
    table.values.append(separator).append(io::plain_text(row.value));
  }
  return table;
}

std::vector<std::string> key_lines() {
  std::vector<std::string> lines;
  constexpr std::size_t kRows = (kMeanings.size() + 1) / 2;
  for (std::size_t i = 0; i < kRows; ++i) {
    lines.push_back(fmt::format("{:<6}{:<36}", kMeanings[i].first, kMeanings[i].second));
    if (i + kRows < kMeanings.size()) {
      lines.back() += fmt::format("{:<6}{}", kMeanings[i + kRows].first, kMeanings[i + kRows].second);
    }
  }
  lines.emplace_back("Each press is a step; a second without any key stops. Ctrl-C ends.");
  return lines;
}

std::vector<std::string> fitted(std::vector<std::string> state, const std::vector<std::string>& keys,
                                std::size_t rows) {
  const std::size_t all = state.size() + keys.size(), over = all > rows ? all - rows : 0;
  const std::size_t of_state = std::min(over, state.size() > kLeastState ? state.size() - kLeastState : 0);
  const std::size_t of_keys = std::min(over - of_state, keys.empty() ? 0 : keys.size() - 1);
  state.resize(state.size() - of_state);
  if (all < rows) state.emplace_back();
  state.insert(state.end(), keys.begin() + static_cast<std::ptrdiff_t>(of_keys), keys.end());
  return state;
}

DrivingTable key_table() {
  DrivingTable table;
  for (const auto& [keys, meaning] : kMeanings) {
    table.labels += std::string(keys) + "\n";
    table.values += std::string(meaning) + "\n";
  }
  table.labels += "let go\nV\nmouse";
  table.values += "velocity to zero, then Stand\nfrom behind, or from the front\nleft turns, right shifts, wheel zooms";
  return table;
}

}  // namespace pmg::ops
