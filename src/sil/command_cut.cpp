#include "sil/command_cut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "control/control_cycle.hpp"
#include "operator/command_text.hpp"

namespace pmg::sil {

namespace {

constexpr std::array kNames = {"forward", "sideways", "turn", "pitch", "roll", "height"};
static_assert(kNames.size() == kChannels);

double share_cut(const Command& asked, const Command& admitted) {
  double most = 0.0;
  for (std::size_t i = 0; i < kChannels; ++i)
    if (!ops::alike(asked.u[i], admitted.u[i])) most = std::max(most, ops::share_apart(asked.u[i], admitted.u[i]));
  return most;
}

}  // namespace

std::string cut_text(const CommandCut& of_run) {
  std::string text;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const double asked = of_run.asked.u[i], admitted = of_run.admitted.u[i];
    if (ops::alike(asked, admitted)) continue;
    text += fmt::format("{}{} {:.3g} {} asked, {:.3g} {} admitted", text.empty() ? "" : "; ", kNames[i], asked,
                        ops::kCommandUnits[i], admitted, ops::kCommandUnits[i]);
  }
  if (of_run.commands > 1) text += fmt::format(" (the worst of {} commands)", of_run.commands);
  return text;
}

nlohmann::ordered_json cut_json(const CommandCut& of_run) {
  if (of_run.commands == 0) return nullptr;
  return {{"for_s", of_run.for_s},
          {"commands", of_run.commands},
          {"worst", {{"asked", ops::command_json(of_run.asked.u)}, {"admitted", ops::command_json(of_run.admitted.u)}}},
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
