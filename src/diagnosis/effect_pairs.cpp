// EffectSearch's pairs: two effects, each of which looks wrong without the other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/unknown.hpp"
#include "diagnosis/effect_search.hpp"
#include "effects/catalogue.hpp"
#include "effects/pair_screen.hpp"
#include "effects/strengths.hpp"

namespace pmg::diagnosis {

namespace {

const effects::Form& form(const effects::EffectStart& start) { return start.effect->forms[start.start.form]; }

/// The first start's model with the second one's effect in it.
calib::JointModel both(const effects::ScreenedPair& pair) {
  calib::JointModel model = pair.first->start.model;
  const effects::Form& second = form(*pair.second);
  for (const std::string& parameter : second.parameters)
    calib::set(model, parameter, calib::value(pair.second->start.model, parameter));
  for (const effects::FixedValue& fixed : second.fixed) calib::set(model, fixed.parameter, fixed.value);
  return model;
}

/// The two effects that were added last.
std::pair<std::string, std::string> newest(const Extension& pair) {
  return {*std::prev(pair.effects.end(), 2), pair.effects.back()};
}

/// True if the two have a parameter in common or one is the other's special case.
bool are_related(const effects::EffectStart& a, const effects::EffectStart& b) {
  const std::vector<std::string>&of_a = form(a).parameters, &of_b = form(b).parameters;
  return effects::contains(a.effect->contains, b.effect->name) ||
         effects::contains(b.effect->contains, a.effect->name) ||
         std::any_of(of_a.begin(), of_a.end(),
                     [&](const std::string& parameter) { return effects::contains(of_b, parameter); });
}

}  // namespace

bool EffectSearch::leaves_rest(const Extension& extension) const {
  const double rest = usual_rest(extension);
  return rest > (options_.remains_of_noise - 1.0) * std::max(limits_.noise_squares, 1e-300) &&
         rest > options_.remains_of_beginning * usual_rest(base_extension_);
}

/// Why the extension is not convincing with both effects, or "": each must be, given the other.
std::string EffectSearch::objection_to_pair(const Extension& pair, const std::string& first,
                                            const std::string& second) {
  for (const std::string& name : {first, second}) {
    if (effects::has_other_sign(name, pair.fitted.model)) return "the other sign than its physics";
    if (std::string why = objection(trial(refit_without(pair, name), pair, name)); !why.empty()) return why;
  }
  return "";
}

std::optional<Extension> EffectSearch::as_special_case(const Extension& from, const std::string& effect) const {
  std::optional<Extension> best;
  for (const std::string& name : effects::effect(effect).contains) {
    if (effects::contains(from.effects, name) || was_left_out(name)) continue;
    Extension special{from.effects, {}, {}, from.forms, {}};
    std::replace(special.effects.begin(), special.effects.end(), effect, name);
    special.forms.erase(effect);
    const std::vector<effects::Form>& forms = effects::effect(name).forms;
    for (std::size_t f = 0; f < forms.size(); ++f) {
      special.forms[name] = f;
      if (!effects::is_nested(name, special.forms, effect, from.forms)) continue;
      calib::JointModel start = fits_.without(from.fitted.model, effect, special.effects, special.forms);
      for (const effects::FixedValue& fixed : forms[f].fixed) calib::set(start, fixed.parameter, fixed.value);
      special.fitted =
          fit_.fit(start, fits_.unknowns(special.effects, special.forms), static_cast<int>(options_.few_iterations));
      if (!best || special.fitted.squares < best->fitted.squares) best = special;
    }
  }
  if (best) best = extend(best->effects, best->forms, best->fitted.model);
  return best;
}

/// (extension that no single effect improves) => (the same with the best pair of effects of which each is convincing
/// beside the other; nothing if there is none). Costs a look at every effect, short fits of thirty pairs, and some to
/// their end.
std::optional<Extension> EffectSearch::with_pair(const Extension& current) {
  std::vector<effects::EffectStart> starts;
  for (const effects::Effect& one : effects::catalogue()) {
    if (effects::contains(current.effects, one.name) || was_left_out(one.name)) continue;
    if (!going(fmt::format("looking at {} beside others", one.title))) return std::nullopt;
    for (const effects::ScreenedStart& start : screened_starts(current, one, true)) starts.push_back({&one, start});
  }
  const effects::StartScreen& screen = look_at(current).screen;
  std::vector<effects::ScreenedPair> pairs = effects::screened_pairs(screen, starts);
  std::erase_if(pairs, [](const auto& pair) { return are_related(*pair.first, *pair.second); });
  std::vector<Extension> fitted;
  std::set<std::pair<const effects::Form*, const effects::Form*>> seen;
  for (const effects::ScreenedPair& pair : pairs) {
    if (seen.size() >= static_cast<std::size_t>(options_.fitted_pairs)) break;
    if (!seen.emplace(&form(*pair.first), &form(*pair.second)).second) continue;
    if (!going(fmt::format("fitting {} and {}", pair.first->effect->title, pair.second->effect->title)))
      return std::nullopt;
    Extension extension{current.effects, {}, {}, current.forms, {}};
    for (const effects::EffectStart* one : {pair.first, pair.second}) {
      extension.effects.push_back(one->effect->name);
      extension.forms[one->effect->name] = one->start.form;
    }
    extension.fitted = fit_.fit(both(pair), fits_.unknowns(extension.effects, extension.forms),
                                static_cast<int>(options_.few_iterations), &screen.jacobian());
    fitted.push_back(std::move(extension));
  }
  std::stable_sort(fitted.begin(), fitted.end(),
                   [](const Extension& a, const Extension& b) { return a.fitted.squares < b.fitted.squares; });
  fitted.resize(std::min(fitted.size(), static_cast<std::size_t>(options_.finished_pairs)));
  std::optional<Extension> best;
  const auto better = [&](const Extension& one) {
    return compared(current, one).log_gain > 0.0 && (!best || compared(*best, one).log_gain > 0.0);
  };
  for (const Extension& few : fitted) {
    const Extension pair = in_special_cases(extend(few.effects, few.forms, few.fitted.model));
    const auto [first, second] = newest(pair);
    if (better(pair) && objection_to_pair(pair, first, second).empty()) {
      best = pair;
      continue;
    }
    // Beside another effect, a fit may have come to where one of the two does all alone.
    for (const auto& [left, stays] : {std::pair(first, second), std::pair(second, first)}) {
      const Extension& single = refit_without(pair, left);
      if (better(single) && objection(trial(current, single, stays)).empty()) best = single;
    }
  }
  return best;
}

}  // namespace pmg::diagnosis
