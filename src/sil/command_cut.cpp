#include "sil/command_cut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "control/control_cycle.hpp"

namespace pmg::sil {

namespace {

constexpr std::array<const char*, kChannels> kNames = {"forward", "sideways", "turn", "pitch", "roll", "height"};
constexpr std::array<const char*, kChannels> kUnits = {"m/s", "m/s", "rad/s", "rad", "rad", "m"};
constexpr double kSmallest = 0.1;  ///< m/s, rad/s, rad, m: below it a share says nothing

/// Of one channel.
double share_cut(double asked, double admitted) {
  return std::abs(asked - admitted) / std::max({std::abs(asked), std::abs(admitted), kSmallest});
}

/// Less than this is rounding for people, as in operator/taken_command.cpp.
bool cut(double asked, double admitted) { return share_cut(asked, admitted) > 0.01; }

double share_cut(const Command& asked, const Command& admitted) {
  double most = 0.0;
  for (std::size_t i = 0; i < kChannels; ++i)
    if (cut(asked.u[i], admitted.u[i])) most = std::max(most, share_cut(asked.u[i], admitted.u[i]));
  return most;
}

nlohmann::ordered_json command_json(const Command& command) {
  nlohmann::ordered_json json;
  for (std::size_t i = 0; i < kChannels; ++i) json[kChannelNames[i]] = command.u[i];
  return json;
}

}  // namespace

std::string cut_text(const CommandCut& of_run) {
  std::string text;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const double asked = of_run.asked.u[i], admitted = of_run.admitted.u[i];
    if (!cut(asked, admitted)) continue;
    text += fmt::format("{}{} {:.3g} {} asked, {:.3g} {} admitted", text.empty() ? "" : "; ", kNames[i], asked,
                        kUnits[i], admitted, kUnits[i]);
  }
  if (of_run.commands > 1) text += fmt::format(" (the worst of {} commands)", of_run.commands);
  return text;
}

nlohmann::ordered_json cut_json(const CommandCut& of_run) {
  if (of_run.commands == 0) return nullptr;
  return {{"for_s", of_run.for_s},
          {"commands", of_run.commands},
          {"worst", {{"asked", command_json(of_run.asked)}, {"admitted", command_json(of_run.admitted)}}},
          {"text", cut_text(of_run)}};
}

void CommandCuts::add(const Command& asked, const Command& admitted, bool beyond) {
  if (!(asked == asked_)) end();
  ticks_ += beyond;
  beyond_ = beyond;
  asked_ = asked;
  admitted_ = admitted;
}

void CommandCuts::skip() { end(); }

void CommandCuts::end() {
  const double share = share_cut(asked_, admitted_);
  if (beyond_ && share > 0.0) {
    ++commands_;
    cut_ticks_ += ticks_;
    const double much = share * static_cast<double>(ticks_);
    if (much > worst_) {
      worst_ = much;
      worst_asked_ = asked_;
      worst_admitted_ = admitted_;
    }
  }
  ticks_ = 0;
  beyond_ = false;
}

CommandCut CommandCuts::worst() const {
  CommandCuts ended = *this;
  ended.end();
  return {.for_s = static_cast<double>(ended.cut_ticks_) * control::ControlCycle::kPeriod_s,
          .commands = ended.commands_,
          .asked = ended.worst_asked_,
          .admitted = ended.worst_admitted_};
}

}  // namespace pmg::sil
