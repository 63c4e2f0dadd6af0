// EffectSearch's stepwise choice: adds effects, removes superfluous ones, exchanges proxies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/step_choice.hpp"
#include "diagnosis/effect_search.hpp"
#include "effects/catalogue.hpp"
#include "effects/strengths.hpp"

namespace pmg::diagnosis {

namespace {

constexpr double kHopeless = 0.25;  // of what is asked for, after a first fit
/// Beyond, no pair and nothing on trial is looked for again: a joint that the list doesn't explain takes and loses one
/// effect after the other, each time at the cost of a whole search.
constexpr std::size_t kMostLeftOut = 2;

}  // namespace

std::string EffectSearch::aliased(const Trial& trial, const std::vector<Trial>& round) const {
  if (!effects::has_other_sign(trial.effect, trial.extension.fitted.model)) return "";
  for (const Trial& other : round) {
    if (other.effect == trial.effect || other.comparison.log_gain <= 0.0) continue;
    if (compared(other.extension, trial.extension).deviations < options_.clearly_deviations)
      return fmt::format("its strength has the other sign than its physics, and {} is not clearly worse",
                         effects::title(other.effect));
  }
  return "";
}

bool EffectSearch::is_superfluous(const Trial& other, const Extension& current, const std::string& effect) const {
  return effects::is_nested(effect, current.forms, other.effect, other.extension.forms) &&
         !objection(trial(current, other.extension, other.effect)).empty();
}

/// True if the special case of an effect stands in its place.
bool EffectSearch::stands_for(const Trial& special, const Trial& of) const {
  if (effects::contains(effects::effect(of.effect).contains, special.effect))
    return compared(special.extension, of.extension).deviations < options_.clearly_deviations;
  return is_superfluous(of, special.extension, special.effect);
}

/// (trials, best first) => (the convincing trial with the fewest parameters among the nearly equal ones; null if none
/// is convincing). A special case wins over the effect that contains it unless it is clearly worse. Says of each trial
/// what is against it.
const Trial* EffectSearch::chosen(std::vector<Trial>& trials) const {
  const Trial* chosen = nullptr;
  double best = 0.0;
  for (Trial& trial : trials) {
    trial.against = objection(trial);
    if (trial.against.empty()) trial.against = aliased(trial, trials);
    if (!trial.against.empty()) continue;
    if (chosen == nullptr) {  // the best comes first
      chosen = &trial;
      best = trial.comparison.log_gain;
      continue;
    }
    const bool special = stands_for(trial, *chosen);
    if (trial.comparison.log_gain < (1.0 - options_.equal_gain) * best && !special) continue;
    if (trial.extension.numbers() < chosen->extension.numbers()) chosen = &trial;
  }
  return chosen;
}

/// (trials of which none is convincing, the best first) => (the best one, if that is convincing as one that is clearly
/// better than every other; else null).
const Trial* EffectSearch::clearly_best(std::vector<Trial>& trials) const {
  const bool rivalled = std::any_of(trials.begin() + 1, trials.end(), [&](const Trial& other) {
    return compared(other.extension, trials.front().extension).deviations < options_.clearly_deviations;
  });
  if (rivalled) return nullptr;
  trials.front().clearly_best = true;
  const std::string against = objection(trials.front());
  if (!against.empty()) return nullptr;
  trials.front().against = "";
  return &trials.front();
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
    const auto stands = [&] {
      Trial again = trial(rest, current, name);
      again.clearly_best = true;  // it was chosen in a round of its own
      return objection(again).empty();
    };
    if (!judged || stands()) {
      ++e;
    } else {
      current = rest;
    }
  }
  return current;
}

/// The other is better by so much on all blocks, or where the runs tell the two apart.
bool EffectSearch::clearly_better(const Extension& other, const Extension& current) const {
  const double deviations = compared(current, other).deviations;
  if (deviations >= options_.clearly_deviations) return true;
  if (!(deviations > 0.0)) return false;
  const effects::SeenSeparation seen =
      effects::seen_separation(fit_, other.fitted.model, current.fitted.model, other.held_out.mean(),
                               current.held_out.mean(), limits_.noise_squares, options_.visible_share);
  return seen.deviations >= options_.clearly_deviations && effects::told_apart(seen, apart_limits());
}

/// (extension) => (extension in which each effect is the best of those that could take its place). The effect taken
/// first was the best before the others were there. Costs a fit without each effect, and those of alternatives().
Extension EffectSearch::exchanged(Extension current) {
  for (std::size_t e = 0; current.effects.size() > 1 && e < current.effects.size() && !stopped_;) {
    const std::string name = current.effects[e++];
    if (measured(name) != nullptr) continue;
    for (const Trial& other : alternatives(current, name)) {
      if (!clearly_better(other.extension, current) ||
          effects::has_other_sign(other.effect, other.extension.fitted.model) || was_left_out(other.effect) ||
          !objection(other).empty() || is_superfluous(other, current, name))
        continue;
      current = other.extension;
      e = 0;
      break;
    }
  }
  return current;
}

effects::ApartLimits EffectSearch::apart_limits() const {
  return {.noise_squares = limits_.noise_squares,
          .deviations = options_.apart_deviations,
          .share_of_expected = options_.apart_share,
          .visible_share = options_.visible_share,
          .blocks = options_.fewest_apart_blocks};
}

/// (extension) => (extension with each effect in the best of its forms, and those that do as well). A form that isn't
/// right leaves a rest that another effect could mend, so this is done after each addition.
Extension EffectSearch::in_best_forms(Extension current) {
  const effects::FormLimits limits{.apart = apart_limits(),
                                   .better_deviations = options_.better_form_deviations,
                                   .hopeless_deviations = options_.hopeless_form_deviations,
                                   .first_iterations = static_cast<int>(options_.few_iterations),
                                   .most_iterations = static_cast<int>(options_.many_iterations)};
  for (const std::string& name : std::vector<std::string>(current.effects)) {
    const effects::Effect& family = effects::effect(name);
    const auto before = forms_compared_at_.find(name);
    const bool known = before != forms_compared_at_.end() && before->second == current.effects;
    if (family.forms.size() < 2 || measured(name) != nullptr || known) continue;
    if (!going("comparing forms of " + family.title)) return current;
    current = effects::in_best_form(fits_, current, look_at(refit_without(current, name)).screen, name, limits);
    forms_compared_at_[name] = current.effects;
  }
  return current;
}

/// (extension) => (the same, or one with a simpler form of an effect and another effect beside it, where that is
/// better). What a form's further number explains may be another effect: a profile's acceleration limit smooths
/// commands as a delay does. As many numbers need only be better, more of them by as much as a form that isn't the
/// simplest. Costs a fit and a round of additions for each effect in a form with further numbers.
Extension EffectSearch::with_simpler_forms(Extension current) {
  for (const std::string& name : std::vector<std::string>(current.effects)) {
    const effects::Effect& family = effects::effect(name);
    const std::size_t numbers = family.forms.front().parameters.size();
    const bool richer = effects::form_of(name, current.forms).parameters.size() > numbers;
    if (!richer || measured(name) != nullptr ||
        current.effects.size() >= static_cast<std::size_t>(options_.most_effects))
      continue;
    if (!going("looking beside a simpler form of " + family.title)) return current;
    const effects::StartScreen& without = look_at(refit_without(current, name)).screen;
    std::vector<effects::ScreenedStart> starts;
    for (std::size_t form = 0; form < family.forms.size(); ++form) {
      if (family.forms[form].parameters.size() > numbers) continue;
      const std::vector<effects::ScreenedStart> best = without.best(family, form, base_.scale);
      starts.insert(starts.end(), best.begin(), best.end());
    }
    const auto least = std::min_element(starts.begin(), starts.end(),
                                        [](const auto& a, const auto& b) { return a.squares < b.squares; });
    if (least == starts.end()) continue;
    effects::Forms forms = current.forms;
    forms[name] = least->form;
    Extension simple = extend(current.effects, forms, least->model);
    if (compared(simple, current).deviations < options_.better_form_deviations) {
      current = std::move(simple);  // beside effects that came later
      continue;
    }
    std::vector<Trial> beside = additions(simple);
    const Trial* other = chosen(beside);
    if (other == nullptr) continue;
    const double better = compared(current, other->extension).deviations;
    const bool as_few = other->extension.numbers() <= current.numbers();
    if (better > (as_few ? 0.0 : options_.better_form_deviations)) current = other->extension;
  }
  return current;
}

/// (extension, an effect and its special case, both in it) => (the effect alone, in each form that has its present
/// numbers, fitted from these; the best).
Extension EffectSearch::alone(const Extension& from, const std::string& effect, const std::string& special) const {
  Extension best{from.effects, {}, {}, from.forms, {}};
  std::erase(best.effects, special);
  best.forms.erase(special);
  best.fitted.squares = std::numeric_limits<double>::infinity();
  std::vector<std::string> others = best.effects;
  std::erase(others, effect);
  const calib::JointModel neither =
      fits_.without(fits_.without(from.fitted.model, special, others, from.forms), effect, others, from.forms);
  const std::vector<effects::Form>& forms = effects::effect(effect).forms;
  const std::vector<std::string>& parameters = effects::form_of(effect, from.forms).parameters;
  for (std::size_t f = 0; f < forms.size(); ++f) {
    if (forms[f].parameters != parameters) continue;
    calib::JointModel start = neither;
    for (const std::string& name : parameters) calib::set(start, name, calib::value(from.fitted.model, name));
    for (const effects::FixedValue& fixed : forms[f].fixed) calib::set(start, fixed.parameter, fixed.value);
    effects::Forms with_form = best.forms;
    with_form[effect] = f;
    Extension one = extend(best.effects, with_form, start);
    if (one.fitted.squares < best.fitted.squares) best = std::move(one);
  }
  return best;
}

Extension EffectSearch::without_special_cases(Extension current) const {
  for (const std::string& name : std::vector<std::string>(current.effects)) {
    for (const std::string& special : std::vector<std::string>(current.effects)) {
      if (!effects::contains(current.effects, name) || measured(special) != nullptr || measured(name) != nullptr ||
          !effects::is_nested(special, current.forms, name, current.forms))
        continue;
      Extension rest = alone(current, name, special);
      if (compared(rest, current).deviations < options_.clearly_deviations) current = std::move(rest);
    }
  }
  return current;
}

Extension EffectSearch::in_special_cases(Extension current) const {
  for (const std::string& name : std::vector<std::string>(current.effects)) {
    if (measured(name) != nullptr) continue;
    std::optional<Extension> special = as_special_case(current, name);
    if (special && compared(*special, current).deviations < options_.clearly_deviations) current = *std::move(special);
  }
  return current;
}

/// True if the effect is convincing beside the extension's others.
bool EffectSearch::stands(const Extension& extension, const std::string& effect) {
  return objection(trial(refit_without(extension, effect), extension, effect)).empty();
}

/// True if runs left out have a smaller mean square with it, surely in each kind. In usual blocks it may do worse and
/// it may end at the edge of its range: that may be due to another effect that is missing.
bool EffectSearch::promises(const Trial& trial) const {
  const std::vector<fitting::KindComparison>& kinds = trial.comparison.of_kind;
  const auto surely = [&](const fitting::KindComparison& kind) {
    return kind.square_deviations >= options_.deviations_on_trial;
  };
  return !kinds.empty() && std::all_of(kinds.begin(), kinds.end(), surely) &&
         stands_out_of_noise(trial.comparison.gain) && !refuted(trial);
}

/// The trial that promises most in the mean, or null.
const Trial* EffectSearch::most_promising(const std::vector<Trial>& trials) const {
  const Trial* most = nullptr;
  for (const Trial& trial : trials) {
    if ((most == nullptr || trial.comparison.gain > most->comparison.gain) && promises(trial)) most = &trial;
  }
  return most;
}

/// (trial beside an extension) => (the trial's extension and what is convincing beside it; nothing if it has no more
/// effects than the extension, or one that is not convincing in the end).
std::optional<Extension> EffectSearch::after_trial(const Trial& trial, const Extension& current) {
  on_trial_ = true;
  Extension with = completed(in_best_forms(trial.extension));
  on_trial_ = false;
  const bool all = std::all_of(with.effects.begin(), with.effects.end(), [&](const std::string& name) {
    return measured(name) != nullptr || stands(with, name);
  });
  if (!all || with.effects.size() <= current.effects.size()) return std::nullopt;
  return with;
}

/// (extension that leaves more than a model in order; no effect is convincing beside it) => (the same with one more
/// effect and what is convincing then, if all of it is in the end; nothing if there is none). Beside what is much
/// larger or still missing, forms and numbers that do not fit yet hide how much an effect explains: so it is taken on
/// trial. First the one that explains most in usual blocks, then the one that does in the mean.
std::optional<Extension> EffectSearch::with_one_on_trial(const Extension& current) {
  if (on_trial_ || !misses(current, true)) return std::nullopt;
  const double least_share = leaves_rest(current) ? options_.nearly_all_of_rest : options_.gain_of_rest;
  const std::vector<Trial> additions = last_additions_;
  std::vector<Trial> trials = additions;
  std::erase_if(trials, [&](const Trial& trial) { return trial.share_of_rest < least_share; });
  for (Trial& trial : trials) trial.on_trial = true;
  const Trial* in_usual_blocks = chosen(trials);
  std::optional<Extension> with;
  if (in_usual_blocks != nullptr) with = after_trial(*in_usual_blocks, current);
  if (with) return with;
  const Trial* in_mean = most_promising(trials);
  if (in_mean != nullptr && in_mean != in_usual_blocks) with = after_trial(*in_mean, current);
  if (!with) last_additions_ = additions;
  return with;
}

Extension EffectSearch::choose() { return completed(with_measured()); }

/// (extension) => (extension with the effects that the runs need besides).
Extension EffectSearch::completed(Extension current) {
  for (std::size_t round = 0; round < static_cast<std::size_t>(options_.most_effects) && !stopped_; ++round) {
    last_additions_ = additions(current);
    const Trial* next = chosen(last_additions_);
    if (next == nullptr && !last_additions_.empty()) next = clearly_best(last_additions_);
    if (next != nullptr) {
      current = in_best_forms(pruned(next->extension, current));
      continue;
    }
    if (left_out_.size() > kMostLeftOut) break;
    std::optional<Extension> more;
    if (leaves_rest(current)) more = with_pair(current);
    if (!more) more = with_one_on_trial(current);
    if (!more) break;
    current = in_best_forms(*std::move(more));
  }
  current = in_special_cases(without_special_cases(std::move(current)));
  return in_best_forms(with_simpler_forms(in_best_forms(exchanged(std::move(current)))));
}

Extension EffectSearch::leave_out(const Extension& from, const std::string& effect, const std::string& why) {
  left_out_.emplace_back(effect, why);
  const Extension& rest = refit_without(from, effect);
  return leaves_rest(rest) ? completed(rest) : rest;
}

bool EffectSearch::was_left_out(const std::string& effect) const {
  return std::any_of(left_out_.begin(), left_out_.end(), [&](const auto& one) { return one.first == effect; });
}

/// (effects, where to begin) => (their fit with this constant of the model free, too).
Extension EffectSearch::with_constant(const calib::Unknown& constant, const std::vector<std::string>& effects,
                                      const effects::Forms& forms, const calib::JointModel& start) {
  base_.unknowns.push_back(constant);
  Extension found = extend(effects, forms, start);
  base_.unknowns.pop_back();
  return found;
}

/// (extension) => (a first fit with this constant of the model free, too; its folds are foretold).
Extension EffectSearch::begun_with_constant(const calib::Unknown& constant, const Extension& of) {
  const effects::RolloutJacobian& known = look_at(of).screen.jacobian();
  calib::Unknowns unknowns = of.fitted.unknowns;
  calib::put(unknowns, constant);
  Extension found{of.effects,
                  fit_.fit(of.fitted.model, unknowns, static_cast<int>(options_.few_iterations), &known),
                  {},
                  of.forms,
                  {}};
  if (found.fitted.blocks.empty()) fit_.linearise(found.fitted, &known);
  found.held_out = fitting::foretold_held_out_squares(found.fitted, compare_.folds());
  return found;
}

/// The constant is free from now on, and begins where this fit has it.
void EffectSearch::free_constant(const calib::Unknown& constant, const Extension& with) {
  base_.unknowns.push_back(constant);
  std::erase(base_.constants, constant);
  calib::set(base_.model, constant.name, calib::value(with.fitted.model, constant.name));
  without_.clear();  // fits and screens with the constant as it was
  alternatives_.clear();
  latest_look_.reset();
  forms_compared_at_.clear();
}

/// Why an effect vanishes where a constant of the model is fitted in its place, or "". The constant is free from then
/// on.
std::string EffectSearch::made_of_constant(const Extension& chosen, const Extension& without,
                                           const std::string& effect) {
  const calib::JointModel start = fits_.without(chosen.fitted.model, effect, without.effects, chosen.forms);
  for (const calib::Unknown& constant : calib::Unknowns(base_.constants)) {
    if (!going(fmt::format("trying {} in its place", constant.name))) return "";
    const double gain = without.fitted.squares - chosen.fitted.squares;
    if (without.fitted.squares - begun_with_constant(constant, without).fitted.squares < kHopeless * gain) continue;
    const Extension other = with_constant(constant, without.effects, without.forms, start);
    if (compared(without, other).deviations < options_.least_deviations ||
        compared(other, chosen).deviations >= options_.least_deviations)
      continue;
    const double before = calib::value(base_.model, constant.name);
    free_constant(constant, other);
    return fmt::format("with {} at {:.3g} {} in place of {:.3g} runs left out are predicted as well without it",
                       constant.name, calib::value(base_.model, constant.name), constant.unit(), before);
  }
  return "";
}

/// (chosen extension) => (the same with a constant of the model free that predicts runs left out better). It is no
/// cause: however little it explains, the effects' numbers and their rivals would have to make up for it.
std::optional<Extension> EffectSearch::with_a_constant_that_shows(const Extension& chosen) {
  for (const calib::Unknown& constant : calib::Unknowns(base_.constants)) {
    if (!going(fmt::format("trying {} beside the effects", constant.name))) return std::nullopt;
    const Extension begun = begun_with_constant(constant, chosen);
    if (compared(chosen, begun).deviations < kHopeless * options_.least_deviations) continue;
    Extension other = with_constant(constant, chosen.effects, chosen.forms, chosen.fitted.model);
    if (compared(chosen, other).deviations < options_.least_deviations) continue;
    free_constant(constant, other);
    return in_best_forms(exchanged(std::move(other)));
  }
  return std::nullopt;
}

/// (extension, comparison with it without an effect, the integrator's error at it) => why the effect mends this error,
/// or "". Costs two fits at half the step where the effect explains less than the error.
std::string EffectSearch::made_of_step(const Extension& chosen, const Trial& last, double step_error_rad) {
  const Extension& without = refit_without(chosen, last.effect);
  const double gain = without.fitted.squares - chosen.fitted.squares;
  const bool large = gain > std::pow(step_error_rad, 2) * fit_.blocks().all_samples();
  if (large || !(gain > 0.0) || !std::isfinite(step_error_rad) || !going("fitting at half the step")) return "";
  const effects::NestedFit finer(calib::with_step(bench_, fit_.runs(), 0.5 * fit_.runs().front().step_s()),
                                 fit_.threads());
  const auto squares = [&](const Extension& extension) {
    return finer.fit(extension.fitted.model, extension.fitted.unknowns, static_cast<int>(options_.few_iterations))
        .squares;
  };
  const double stays = (squares(without) - squares(chosen)) / gain;
  if (stays > options_.stays_at_half_step) return "";
  return fmt::format("it explains less than the simulation's step is off: with half the step {:.0f} % of its gain stay",
                     100.0 * std::max(0.0, stays));
}

Settled EffectSearch::settled(Extension chosen) {
  for (;;) {
    (void)going("fitting with what is known of the simulation's numbers");
    Extension with_priors = refit_with_priors(chosen);
    if (with_priors.fitted.squares < options_.settled_squares * chosen.fitted.squares) chosen = with_priors;
    const double step_error_rad =
        limits_.recordings_have_step || chosen.effects.empty()
            ? 0.0
            : calib::integration_error(bench_, fit_.runs(), chosen.fitted.model, fit_.threads()).rms_rad;
    std::string weakest, why;
    double least = std::numeric_limits<double>::infinity();
    for (const std::string& name : chosen.effects) {
      if (measured(name) != nullptr || !going("a last look at " + effects::title(name))) continue;
      const Extension without = refit_without(chosen, name);
      Trial last = trial(without, chosen, name);
      last.clearly_best = true;  // as far as it had to be when it was taken
      std::string against =
          last.comparison.log_gain > 0.0 ? doubt(last) : "runs left out are predicted no better with it";
      if (against.empty() && !shown(name) && is_small(last)) against = kSmall;
      if (against.empty()) against = unsure(name, with_priors.forms, with_priors.fitted);
      if (against.empty()) against = made_of_step(chosen, last, step_error_rad);
      if (against.empty()) against = made_of_constant(chosen, without, name);
      if (against.empty() || last.comparison.log_gain >= least) continue;
      least = last.comparison.log_gain;
      weakest = name;
      why = against;
    }
    if (!weakest.empty()) {
      chosen = leave_out(chosen, weakest, why);
      continue;
    }
    std::optional<Extension> with = with_a_constant_that_shows(chosen);
    if (!with) return {std::move(chosen), std::move(with_priors)};
    chosen = *std::move(with);
  }
}

}  // namespace pmg::diagnosis
