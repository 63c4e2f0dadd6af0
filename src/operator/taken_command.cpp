#include "operator/taken_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace pmg::ops {

namespace {

constexpr double kStill = 1e-4;  ///< m/s, rad/s, rad or m in a tick: below the slowest ramp
constexpr std::array<const char*, kChannels> kShortNames = {"vx", "vy", "omega", "pitch", "roll", "height"};
constexpr std::array<const char*, kChannels> kUnits = {"m/s", "m/s", "rad/s", "rad", "rad", "m"};

/// From ROBOT_INFO's configuration (control::control_json); nothing if it lacks the key.
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

/// Rounded for people: to a hundredth, near zero to a thousandth.
bool alike(double a, double b) { return std::abs(a - b) <= 0.01 * std::max({std::abs(a), std::abs(b), 0.1}); }

/// "limited: vx 50 -> 0.8 m/s (range -0.5 to 0.8)", and whether the ranges alone explain it.
std::string words(const Command& asked, const RobotNews& news, bool settled) {
  std::string text;
  int channels = 0;
  bool by_ranges = true;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const double wanted = asked.u[i], realised = news.reference->command[i];
    if (wanted == 0.0 || alike(wanted, realised)) continue;
    ++channels;
    text += fmt::format("{}{} {:.3g} -> {:.3g} {}{}", text.empty() ? "limited: " : "; ", kShortNames[i], wanted,
                        realised, kUnits[i], settled ? "" : " so far");
    const auto range = range_of(news, i);
    const bool outside = range && (wanted < range->first || wanted > range->second);
    if (outside) text += fmt::format(" (range {:.3g} to {:.3g})", range->first, range->second);
    const double allowed = outside ? std::clamp(wanted, range->first, range->second) : wanted;
    by_ranges = by_ranges && (!settled || alike(realised, allowed));
  }
  if (channels > 0 && !by_ranges) {
    text += fmt::format("; {} more than the clips and the joints' ranges allow",
                        channels > 1 ? "together they are" : "it is");
  }
  return text;
}

}  // namespace

std::string TakenCommand::step(const RobotNews& news, std::int64_t now_ns, bool last) {
  if (told_ || !news.reference || !news.reference->command_limited) return "";
  const pmg_msgs::reference_t& reference = *news.reference;
  if (!std::equal(asked_.u.begin(), asked_.u.end(), std::begin(reference.user))) return "";
  const bool still =
      still_since_ns_ >= 0 && std::equal(realised_.begin(), realised_.end(), std::begin(reference.command),
                                         [](double before, double now) { return std::abs(before - now) < kStill; });
  if (!still) {
    still_since_ns_ = now_ns;
    std::copy_n(std::begin(reference.command), kChannels, realised_.begin());
  }
  const bool settled = now_ns - still_since_ns_ >= kSettled_ns && news.info;
  if (!settled && !last) return "";
  told_ = true;
  return words(asked_, news, settled);
}

}  // namespace pmg::ops
