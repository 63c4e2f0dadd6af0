// EffectSearch's stepwise choice: adds effects, removes superfluous ones, exchanges proxies.
#include "diagnosis/effect_search.hpp"
#include "effects/catalogue.hpp"

namespace pmg::diagnosis {

/// (trials, best first) => (the convincing trial with the fewest parameters among the nearly equal ones; null if none
/// is convincing). A special case wins over the effect that contains it unless it is clearly worse.
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
    const bool special = effects::contains(effects::effect(chosen->effect).contains, trial.effect) &&
                         compared(trial.extension, chosen->extension).deviations < options_.clearly_deviations;
    if (trial.comparison.log_gain < (1.0 - options_.equal_gain) * best && !special) continue;
    if (trial.extension.fitted.unknowns.size() < chosen->extension.fitted.unknowns.size()) chosen = &trial;
  }
  return chosen;
}

/// (extension, the one before its newest effect) => (extension without superfluous effects). An earlier effect may be a
/// proxy for a later one. The newest effect may only have helped a fit that had not converged: then a refit without it,
/// started from here, regains more than half of its gain. Costs a fit for each effect.
Extension EffectSearch::pruned(Extension current, const Extension& before) {
  for (std::size_t e = 0; e < current.effects.size() && !stopped_;) {
    const std::string name = current.effects[e];
    const bool newest = !effects::contains(before.effects, name);
    const Extension rest = measured(name) != nullptr ? current : refit_without(current, name);
    const double regained = before.fitted.squares - rest.fitted.squares;
    const bool unfinished = regained > options_.regained_share * (before.fitted.squares - current.fitted.squares);
    const bool judged = measured(name) == nullptr && (!newest || unfinished);
    if (!judged || objection(trial(rest, current, name)).empty()) {
      ++e;
    } else {
      current = rest;
    }
  }
  return current;
}

/// (extension) => (extension in which each effect is the best of those that could take its place). The effect taken
/// first was the best before the others were there. Costs a fit without each effect, and those of alternatives().
Extension EffectSearch::exchanged(Extension current) {
  for (std::size_t e = 0; current.effects.size() > 1 && e < current.effects.size() && !stopped_;) {
    const std::string name = current.effects[e++];
    if (measured(name) != nullptr) continue;
    for (const Trial& other : alternatives(refit_without(current, name), name)) {
      if (compared(current, other.extension).deviations < options_.clearly_deviations || !objection(other).empty())
        continue;
      current = other.extension;
      e = 0;
      break;
    }
  }
  return current;
}

Extension EffectSearch::choose() {
  Extension current = with_measured();
  for (std::size_t round = 0; round < static_cast<std::size_t>(options_.most_effects) && !stopped_; ++round) {
    last_additions_ = additions(current);
    const Trial* next = chosen(last_additions_);
    if (next == nullptr) break;
    current = pruned(next->extension, current);
  }
  return exchanged(std::move(current));
}

}  // namespace pmg::diagnosis
