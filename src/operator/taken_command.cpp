#include "operator/taken_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "operator/command_text.hpp"
#include "operator/keyboard_text.hpp"

namespace pmg::ops {

namespace {

constexpr double kStill = 1e-4;  ///< m/s, rad/s, rad or m in a tick: below the slowest ramp
constexpr std::array kShortNames = {"vx", "vy", "omega", "pitch", "roll", "height"};
static_assert(kShortNames.size() == kChannels);

/// "limited: vx 50 -> 0.8 m/s (range -0.5 to 0.8)", and whether the ranges alone explain it.
std::string words(const Command& asked, const RobotNews& news, bool settled) {
  const std::optional<CommandLimits> limits = news.info ? command_limits(*news.info) : std::nullopt;
  std::string text;
  int channels = 0;
  bool by_ranges = true;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const double wanted = asked.u[i], realised = news.reference->command[i];
    if (wanted == 0.0 || alike(wanted, realised)) continue;
    ++channels;
    text += fmt::format("{}{} {:.3g} -> {:.3g} {}{}", text.empty() ? "limited: " : "; ", kShortNames[i], wanted,
                        realised, kCommandUnits[i], settled ? "" : " so far");
    const double allowed = limits ? std::clamp(wanted, limits->lower[i], limits->upper[i]) : wanted;
    if (allowed != wanted) text += fmt::format(" (range {:.3g} to {:.3g})", limits->lower[i], limits->upper[i]);
    by_ranges = by_ranges && (!settled || alike(realised, allowed));
  }
  if (channels > 0 && !by_ranges) {
    const std::string reach = beyond_reach(asked.u.data(), news);
    text += !reach.empty() ? "; " + reach
                           : fmt::format("; {} more than the clips and the joints' ranges allow",
                                         channels > 1 ? "together they are" : "it is");
  }
  return text;
}

}  // namespace

std::string beyond_reach(const double* asked, const RobotNews& news) {
  const std::optional<CommandLimits> limits = news.info ? command_limits(*news.info) : std::nullopt;
  if (!limits) return "";
  const auto options = nlohmann::json::parse(news.info->options, nullptr, false);
  const auto reach = options["command"].find("velocities_together");
  if (reach == options["command"].end() || !reach->is_number()) return "";
  double sum = 0.0;
  for (std::size_t i = 0; i < kVelocityChannels; ++i) {
    const double end = asked[i] < 0.0 ? limits->lower[i] : limits->upper[i];
    if (asked[i] != 0.0 && end != 0.0) sum += std::min(1.0, asked[i] / end);
  }
  if (sum <= reach->get<double>() + 1e-6) return "";
  return fmt::format("the velocities together are {:.0f} % of their ranges, the clips give {:.0f} %", 100.0 * sum,
                     100.0 * reach->get<double>());
}

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
