#include "diagnosis/effect_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/unknown.hpp"
#include "effects/catalogue.hpp"
#include "effects/other_starts.hpp"
#include "effects/period.hpp"

namespace pmg::diagnosis {

namespace {

std::vector<std::string> with(std::vector<std::string> effects, const std::string& effect) {
  effects.push_back(effect);
  return effects;
}

std::vector<std::string> less(std::vector<std::string> effects, const std::string& effect) {
  std::erase(effects, effect);
  return effects;
}

bool better(const Trial& a, const Trial& b) { return a.comparison.log_gain > b.comparison.log_gain; }

std::vector<std::string> periods(std::vector<std::string> parameters) {
  std::erase_if(parameters, [](const std::string& name) { return !effects::is_period(name); });
  return parameters;
}

}  // namespace

SearchLimits search_limits(const JointDiagnosisOptions& options, double noise_squares, bool from_scratch) {
  if (from_scratch) {
    return {.noise_squares = noise_squares,
            .healthy_squares = noise_squares,
            .of_noise = options.scratch_amplitude_of_noise,
            .of_beginning = options.scratch_amplitude_of_beginning,
            .of_rest = options.scratch_gain_of_rest};
  }
  return {.noise_squares = noise_squares,
          .healthy_squares = 0.0,
          .of_noise = options.amplitude_of_noise,
          .of_beginning = options.amplitude_of_beginning,
          .of_rest = options.gain_of_rest};
}

EffectSearch::EffectSearch(const bench::Bench& bench, const effects::NestedFit& fit, BaseModel base,
                           SearchLimits limits, DirectEvidence evidence, const JointDiagnosisOptions& options,
                           work::Progress progress)
    : bench_(bench),
      fit_(fit),
      base_(std::move(base)),
      limits_(limits),
      evidence_(std::move(evidence)),
      options_(options),
      power_(bench, fit.runs(), base_.scale.quantum_rad, options_.signatures),
      progress_(std::move(progress)),
      compare_(fit.blocks(), folds(fit), limits.noise_squares),
      fits_(bench_, fit_, base_, compare_),
      base_extension_(extend({}, {}, base_.model)) {}

/// The screen of the extension asked for last is kept: one at a time, because its Jacobian takes a row for each sample.
const EffectSearch::Look& EffectSearch::look_at(const Extension& extension) {
  if (!latest_look_ || latest_look_->squares != extension.fitted.squares ||
      latest_look_->effects != extension.effects) {
    latest_look_.reset();
    latest_look_.emplace(Look{{fit_, extension.fitted}, extension.fitted.squares, extension.effects});
  }
  return *latest_look_;
}

bool EffectSearch::going(const std::string& text) {
  if (!progress_(work::kUnknownShare, text)) stopped_ = true;
  return !stopped_;
}

Extension EffectSearch::extend(const std::vector<std::string>& effects, const effects::Forms& forms,
                               const calib::JointModel& start) const {
  return fits_.fitted(effects, forms, start, static_cast<int>(options_.many_iterations));
}

const MeasuredCause* EffectSearch::measured(const std::string& effect) const {
  const std::vector<MeasuredCause>& all = evidence_.measured;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const MeasuredCause& cause) { return cause.effect == effect; });
  return found == all.end() ? nullptr : &*found;
}

bool EffectSearch::shown(const std::string& effect) const { return effects::contains(evidence_.shown, effect); }

Extension EffectSearch::with_measured() const {
  if (evidence_.measured.empty()) return base_extension_;
  calib::JointModel model = base_extension_.fitted.model;
  std::vector<std::string> effects;
  for (const MeasuredCause& cause : evidence_.measured) {
    calib::set(model, cause.parameter, cause.value.value);
    effects.push_back(cause.effect);
  }
  return extend(effects, {}, model);
}

const Extension& EffectSearch::refit_without(const Extension& extension, const std::string& effect) {
  const auto [known, fresh] = without_.try_emplace({effect, extension.fitted.squares});
  if (fresh) {
    const std::vector<std::string> kept = less(extension.effects, effect);
    known->second = extend(kept, extension.forms, fits_.without(extension.fitted.model, effect, kept, extension.forms));
    known->second.forms.erase(effect);
  }
  return known->second;
}

Extension EffectSearch::refit_with_priors(const Extension& extension) const {
  const effects::NestedModel& loose = extension.fitted;
  const bool known = std::any_of(loose.unknowns.begin(), loose.unknowns.end(),
                                 [](const calib::Unknown& u) { return u.deviation > 0.0; });
  if (!known) return extension;
  const double weight = prior_weight(loose);
  calib::JointModel given = loose.model;
  calib::Unknowns effects_only;
  for (const calib::Unknown& u : loose.unknowns) {
    if (u.deviation > 0.0)
      calib::set(given, u.name, u.value(u.expected));
    else
      effects_only.push_back(u);
  }
  given = fit_.fit(given, effects_only, static_cast<int>(options_.many_iterations)).model;
  Extension best = extension;
  double least = std::numeric_limits<double>::infinity();
  for (const calib::JointModel& start : {given, loose.model}) {
    effects::NestedModel fitted =
        fit_.fit(start, loose.unknowns, static_cast<int>(options_.many_iterations), nullptr, weight);
    const double cost = fitting::cost(fitted);
    if (cost >= least) continue;
    least = cost;
    best.fitted = std::move(fitted);
  }
  if (best.fitted.blocks.empty()) fit_.linearise(best.fitted);
  best.held_out = fit_.held_out_squares(best.fitted, compare_.folds());
  return best;
}

std::vector<std::string> EffectSearch::fitted_parameters(const Extension& extension) const {
  std::vector<std::string> found;
  for (const std::string& name : extension.effects) {
    if (measured(name) != nullptr) continue;
    const effects::Form& form = effects::form_of(name, extension.forms);
    found.insert(found.end(), form.parameters.begin(), form.parameters.end());
  }
  return found;
}

effects::NestedModel EffectSearch::from_other_starts(const Extension& with_priors) const {
  const int iterations = static_cast<int>(options_.many_iterations);
  std::vector<std::string> parameters = fitted_parameters(with_priors);
  effects::NestedModel model = effects::from_other_periods(fit_, with_priors.fitted, periods(parameters), iterations);
  std::erase_if(parameters, effects::is_period);
  return effects::from_other_starts(fit_, std::move(model), parameters, iterations);
}

bool EffectSearch::misses(const Extension& extension, bool on_average_too) const {
  const double forgiven = (options_.remains_of_noise - 1.0) * limits_.noise_squares;
  const double mean_rest = extension.held_out_squares() / fit_.blocks().all_samples() - limits_.noise_squares;
  return usual_rest(extension) > forgiven || (on_average_too && mean_rest > forgiven);
}

Trial EffectSearch::trial(const Extension& without, const Extension& with, const std::string& effect) const {
  Trial found{effect, compare_(without.held_out, with.held_out), 0.0, with};
  const double rest = without.held_out_squares() / fit_.blocks().all_samples() - limits_.healthy_squares;
  found.share_of_rest = rest > 0.0 ? found.comparison.gain / rest : 0.0;
  if (limits_.healthy_squares <= limits_.noise_squares) {
    const double usual = usual_rest(without);
    if (usual > 0.0) found.share_of_rest = std::max(found.share_of_rest, found.comparison.usual_gain / usual);
  }
  found.missed_alone = misses(without, found.comparison.deviations >= options_.all_of_rest_deviations);
  return found;
}

/// The best starts of an effect's forms; if wanted, also the strength that a model-free check measures, in the first
/// form.
std::vector<effects::ScreenedStart> EffectSearch::screened_starts(const Extension& extension,
                                                                  const effects::Effect& effect, bool measured) {
  look_at(extension);
  const effects::StartScreen& screen = latest_look_->screen;
  const auto [known, fresh] = latest_look_->starts.try_emplace(effect.name);
  if (fresh) known->second = screen.best_of_forms(effect, base_.scale, options_.worth_fitting_form);
  std::vector<effects::ScreenedStart> starts = known->second;
  const auto evident = evidence_.evident.find(effect.name);
  if (!measured || evident == evidence_.evident.end() || evident->second.empty()) return starts;
  const std::vector<effects::ScreenedStart> further = screen.at(effect, 0, evident->second);
  starts.insert(starts.end(), further.begin(), further.end());
  return starts;
}

/// (extension, an effect, its starts) => (first fit with the effect, from the best of the starts; its folds are
/// foretold).
Extension EffectSearch::begun(const Extension& without, const std::string& effect,
                              const std::vector<effects::ScreenedStart>& starts,
                              const effects::RolloutJacobian& known) const {
  const std::vector<std::string> effects = with(without.effects, effect);
  Extension best;
  best.fitted.squares = std::numeric_limits<double>::infinity();
  for (const effects::ScreenedStart& start : starts) {
    effects::Forms forms = without.forms;
    forms[effect] = start.form;
    const effects::NestedModel fitted =
        fit_.fit(start.model, fits_.unknowns(effects, forms), static_cast<int>(options_.few_iterations), &known);
    if (fitted.squares < best.fitted.squares) best = {effects, fitted, {}, forms, {}};
  }
  if (best.fitted.blocks.empty()) fit_.linearise(best.fitted, &known);
  best.held_out = fitting::foretold_held_out_squares(best.fitted, compare_.folds());
  return best;
}

/// (extension) => (trials of the effects that it lacks): screened by the linearised fit, the most promising ones
/// fitted.
std::vector<Trial> EffectSearch::tried(const Extension& current, double most, bool all_evident) {
  struct Promising {
    const effects::Effect* effect = nullptr;
    std::vector<effects::ScreenedStart> starts;
  };
  std::vector<Promising> promising;
  for (const effects::Effect& one : effects::catalogue()) {
    if (effects::contains(current.effects, one.name) || (all_evident && was_left_out(one.name))) continue;
    if (!going(fmt::format("looking at {}", one.title))) return {};
    std::vector<effects::ScreenedStart> starts = screened_starts(current, one, all_evident);
    if (!starts.empty()) promising.push_back({&one, std::move(starts)});
  }
  std::stable_sort(promising.begin(), promising.end(), [this](const Promising& a, const Promising& b) {
    const bool a_shown = shown(a.effect->name), b_shown = shown(b.effect->name);
    return a_shown != b_shown ? a_shown : a.starts.front().squares < b.starts.front().squares;
  });
  const auto evident = [&](const std::string& name) { return all_evident && evidence_.evident.contains(name); };
  const auto last = promising.begin() + std::min<std::ptrdiff_t>(std::ssize(promising), std::lround(most));
  promising.erase(std::remove_if(last, promising.end(), [&](const Promising& p) { return !evident(p.effect->name); }),
                  promising.end());
  const effects::RolloutJacobian& known = look_at(current).screen.jacobian();
  std::vector<Trial> trials;
  for (const Promising& p : promising) {
    if (!going(fmt::format("fitting {}", p.effect->title))) return {};
    trials.push_back(trial(current, begun(current, p.effect->name, p.starts, known), p.effect->name));
  }
  std::stable_sort(trials.begin(), trials.end(), better);
  // After few iterations a fit may still lie in a valley (load friction as a proxy for Coulomb friction). So the fit
  // with the lowest squares is always finished, whatever its folds say so far.
  const auto closest = std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return a.extension.fitted.squares < b.extension.fitted.squares;
  });
  // What isn't finished has foretold folds; where these say that it may be chosen, they are rolled out.
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const bool among_best = t < static_cast<std::size_t>(options_.finished_effects) || evident(trials[t].effect);
    const bool worth = trials[t].comparison.log_gain >= options_.worth_finishing * trials.front().comparison.log_gain;
    const bool finish =
        (among_best && worth) || shown(trials[t].effect) || trials.begin() + static_cast<std::ptrdiff_t>(t) == closest;
    if (!finish && !worth) continue;
    if (!going(fmt::format("finishing {}", effects::effect(trials[t].effect).title))) return {};
    Extension begun = trials[t].extension;
    if (finish)
      begun = at_best_period(extend(begun.effects, begun.forms, begun.fitted.model), trials[t].effect);
    else
      begun.held_out = fit_.held_out_squares(begun.fitted, compare_.folds());
    trials[t] = trial(current, begun, trials[t].effect);
  }
  std::stable_sort(trials.begin(), trials.end(), better);
  return trials;
}

/// (extension, its effect) => (the same at the period that is best once the other numbers follow). Where a hold is
/// missed, other numbers make up for part of it: beside them a shorter period does better than the right one.
Extension EffectSearch::at_best_period(Extension extension, const std::string& effect) const {
  const effects::NestedModel better =
      effects::from_other_periods(fit_, extension.fitted, periods(effects::form_of(effect, extension.forms).parameters),
                                  static_cast<int>(options_.few_iterations));
  if (!(better.squares < extension.fitted.squares)) return extension;
  extension.fitted = better;
  extension.held_out = fit_.held_out_squares(better, compare_.folds());
  return extension;
}

/// (extension, its effect) => (a sample and hold in the place of what makes something late, fitted; nothing where the
/// effect is none such). It begins with the numbers that the rest has beside the effect: fitted without it, these make
/// up for most of the wait, and there a hold of the right period explains nothing.
std::optional<Trial> EffectSearch::hold_in_its_place(const Extension& current, const std::string& effect) {
  const effects::Effect& hold = effects::effect("hold");
  if (!effects::is_late(effects::form_of(effect, current.forms)) || effects::contains(current.effects, hold.name) ||
      !going(fmt::format("fitting {} in the place of {}", hold.title, effects::title(effect))))
    return std::nullopt;
  Extension rest{less(current.effects, effect), {}, {}, current.forms, {}};
  rest.forms.erase(effect);
  rest.fitted = fit_.fit(fits_.without(current.fitted.model, effect, rest.effects, rest.forms),
                         fits_.unknowns(rest.effects, rest.forms), 0);
  const effects::StartScreen screen(fit_, rest.fitted);
  std::vector<effects::ScreenedStart> starts;
  for (std::size_t form = 0; form < hold.forms.size(); ++form) {
    const std::vector<effects::ScreenedStart> best = screen.best(hold, form, base_.scale);
    if (!best.empty()) starts.push_back(best.front());
  }
  if (starts.empty()) return std::nullopt;
  const Extension first = begun(rest, hold.name, starts, screen.jacobian());
  const Extension whole = at_best_period(extend(first.effects, first.forms, first.fitted.model), hold.name);
  return trial(refit_without(current, effect), whole, hold.name);
}

std::vector<Trial> EffectSearch::additions(const Extension& to) { return tried(to, options_.fitted_effects, true); }

double EffectSearch::usual_rest(const Extension& extension) const {
  Eigen::VectorXd squares(static_cast<Eigen::Index>(extension.fitted.blocks.size()));
  for (Eigen::Index b = 0; b < squares.size(); ++b) {
    squares[b] = extension.fitted.blocks[static_cast<std::size_t>(b)].squares;
  }
  return std::max(0.0, std::exp(compare_.mean_log_square(squares)) - 2.0 * limits_.noise_squares);
}

fitting::Comparison EffectSearch::compared(const Extension& first, const Extension& second) const {
  return compare_(first.held_out, second.held_out);
}

const std::vector<Trial>& EffectSearch::alternatives(const Extension& current, const std::string& effect) {
  const Extension& without = refit_without(current, effect);
  const auto [known, fresh] = alternatives_.try_emplace({effect, without.fitted.squares});
  if (!fresh) return known->second;
  known->second = tried(without, options_.exchanged_effects, false);
  if (std::optional<Trial> hold = hold_in_its_place(current, effect)) {
    const auto twin = std::find_if(known->second.begin(), known->second.end(),
                                   [&](const Trial& trial) { return trial.effect == hold->effect; });
    if (twin != known->second.end()) {
      if (!better(*hold, *twin)) hold = *twin;
      known->second.erase(twin);
    }
    known->second.push_back(*std::move(hold));
  }
  // An effect that contains this one as a special case explains as much: the simpler one stands.
  std::erase_if(known->second, [&](const Trial& trial) {
    return trial.effect == effect || effects::contains(effects::effect(trial.effect).contains, effect);
  });
  return known->second;
}

}  // namespace pmg::diagnosis
