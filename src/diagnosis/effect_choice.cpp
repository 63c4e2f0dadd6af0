// How EffectSearch chooses among its trials: one effect after the other, and back.
#include "diagnosis/catalogue.hpp"
#include "diagnosis/effect_search.hpp"

namespace pmg::diagnosis {

namespace {

constexpr std::size_t kMostEffects = 6;
constexpr double kEqual = 0.03;      // of the gain: such a difference doesn't choose
constexpr double kClearly = 3.0;     // deviations that do
constexpr double kUnfinished = 0.5;  // of what an effect explains, that a fit without it explains as well

}  // namespace

/// Of those that convince and are nearly equal, the one with the fewest parameters; a special case unless it is clearly
/// worse. Null where none convinces.
const Trial* EffectSearch::chosen(const std::vector<Trial>& trials) const {
  const Trial* chosen = nullptr;
  double best = 0.0;
  for (const Trial& trial : trials) {
    if (!objection(trial).empty()) continue;
    if (chosen == nullptr) {  // the best comes first
      chosen = &trial;
      best = trial.comparison.log_gain;
      continue;
    }
    const bool special = contains(effect(chosen->effect).contains, trial.effect) &&
                         compared(trial.extension, chosen->extension).deviations < kClearly;
    if (trial.comparison.log_gain < (1.0 - kEqual) * best && !special) continue;
    if (trial.extension.fitted.unknowns.size() < chosen->extension.fitted.unknowns.size()) chosen = &trial;
  }
  return chosen;
}

/// What came first may only have stood for what came later; and what came last for a fit that wasn't at its end, where
/// one without it, begun from here, meets the runs by most of what it gained.
Extension EffectSearch::pruned(Extension current, const Extension& before) {
  for (std::size_t e = 0; e < current.effects.size() && !stopped_;) {
    const std::string name = current.effects[e];
    const bool newest = !contains(before.effects, name);
    const Extension rest = measured(name) != nullptr ? current : without(current, name);
    const double regained = before.fitted.squares - rest.fitted.squares;
    const bool unfinished = regained > kUnfinished * (before.fitted.squares - current.fitted.squares);
    const bool judged = measured(name) == nullptr && (!newest || unfinished);
    if (!judged || objection(trial(rest, current, name)).empty()) {
      ++e;
    } else {
      current = rest;
    }
  }
  return current;
}

/// What came first may only be what was best before the others came: whatever now does better takes its place.
Extension EffectSearch::exchanged(Extension current) {
  for (std::size_t e = 0; current.effects.size() > 1 && e < current.effects.size() && !stopped_;) {
    const std::string name = current.effects[e++];
    if (measured(name) != nullptr) continue;
    for (const Trial& other : alternatives(without(current, name), name)) {
      if (compared(current, other.extension).deviations < kClearly || !objection(other).empty()) continue;
      current = other.extension;
      e = 0;
      break;
    }
  }
  return current;
}

Extension EffectSearch::choose() {
  Extension current = with_measured();
  for (std::size_t round = 0; round < kMostEffects && !stopped_; ++round) {
    last_additions_ = additions(current);
    const Trial* next = chosen(last_additions_);
    if (next == nullptr) break;
    current = pruned(next->extension, current);
  }
  return exchanged(std::move(current));
}

}  // namespace pmg::diagnosis
