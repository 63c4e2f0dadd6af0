#include "operator/taken_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace pmg::ops {

namespace {

constexpr double kSame = 1e-4;  ///< m/s, rad/s, rad or m: far below what anybody asks for
constexpr std::array<const char*, kChannels> kNames = {"vx", "vy", "omega", "pitch", "roll", "height"};
constexpr std::array<const char*, kChannels> kUnits = {"m/s", "m/s", "rad/s", "rad", "rad", "m"};

/// As ROBOT_INFO's configuration has it (runtime::control_json); nothing where it doesn't.
std::optional<std::pair<double, double>> range_of(const RobotNews& news, std::size_t channel) {
  if (!news.info) return std::nullopt;
  const auto options = nlohmann::json::parse(news.info->options, nullptr, false);
  const auto end = [&](const char* which) -> std::optional<double> {
    const nlohmann::json::json_pointer place(fmt::format("/command/{}/{}", which, kChannelNames[channel]));
    if (!options.is_object() || !options.contains(place) || !options[place].is_number()) return std::nullopt;
    return options[place].get<double>();
  };
  const auto lower = end("lower"), upper = end("upper");
  if (!lower || !upper) return std::nullopt;
  return std::pair{*lower, *upper};
}

std::string why(const RobotNews& news, std::size_t channel, double asked, double realised) {
  const auto range = range_of(news, channel);
  if (!range || (asked >= range->first - kSame && asked <= range->second + kSame)) {
    return "all of it together is more than the clips and the joints' ranges allow";
  }
  const std::string text = fmt::format("its range is {:.3g} to {:.3g}", range->first, range->second);
  const bool all_of_it = std::abs(realised - std::clamp(asked, range->first, range->second)) < kSame;
  return all_of_it ? text : text + ", and all of it together is more than the clips and the joints' ranges allow";
}

}  // namespace

std::string TakenCommand::step(const RobotNews& news, std::int64_t now_ns, bool last) {
  if (told_ || !news.reference || !news.reference->command_limited) return "";
  const pmg_msgs::reference_t& reference = *news.reference;
  if (!std::equal(asked_.u.begin(), asked_.u.end(), std::begin(reference.user))) return "";
  const bool still =
      still_since_ns_ >= 0 && std::equal(realised_.begin(), realised_.end(), std::begin(reference.command),
                                         [](double before, double now) { return std::abs(before - now) < kSame; });
  if (!still) {
    still_since_ns_ = now_ns;
    std::copy_n(std::begin(reference.command), kChannels, realised_.begin());
  }
  const bool settled = now_ns - still_since_ns_ >= kSettled_ns && news.info;
  if (!settled && !last) return "";
  told_ = true;
  std::string text;
  for (std::size_t i = 0; i < kChannels; ++i) {
    if (std::abs(asked_.u[i] - reference.command[i]) < kSame) continue;
    if (!settled && std::abs(asked_.u[i]) < kSame) continue;
    text += fmt::format("{}{} {:.3g} {} is {} {:.3g} ({})", text.empty() ? "" : "; ", kNames[i], asked_.u[i], kUnits[i],
                        settled ? "driven as" : "limited, and has come to", reference.command[i],
                        why(news, i, asked_.u[i], reference.command[i]));
  }
  return text;
}

}  // namespace pmg::ops
