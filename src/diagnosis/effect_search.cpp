#include "diagnosis/effect_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit_problem.hpp"
#include "effects/catalogue.hpp"

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

}  // namespace

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
      base_extension_(extend({}, base_.model)) {}

bool EffectSearch::going(const std::string& text) {
  if (!progress_(work::kUnknownShare, text)) stopped_ = true;
  return !stopped_;
}

/// The unknowns of the base model, then those of the effects over their whole range.
std::vector<effects::Unknown> EffectSearch::unknowns(const std::vector<std::string>& effects) const {
  std::vector<effects::Unknown> found = base_.unknowns;
  for (const std::string& name : effects) {
    for (const std::string& parameter : effects::effect(name).parameters) {
      if (effects::is_jagged(parameter)) continue;
      const effects::Unknown full = effects::unknown(parameter, bench_, base_.scale);
      const auto there =
          std::find_if(found.begin(), found.end(), [&](const effects::Unknown& u) { return u.name == parameter; });
      if (there == found.end())
        found.push_back(full);
      else
        *there = full;
    }
  }
  return found;
}

/// The model with the effect's parameters neutral, except those that a kept effect shares.
calib::JointModel EffectSearch::reset(calib::JointModel model, const std::string& effect,
                                      const std::vector<std::string>& kept) const {
  for (const std::string& parameter : effects::effect(effect).parameters) {
    const bool shared = std::any_of(kept.begin(), kept.end(), [&](const std::string& name) {
      return effects::contains(effects::effect(name).parameters, parameter);
    });
    if (!shared) calib::set(model, parameter, calib::value(base_.model, parameter));
  }
  return model;
}

Extension EffectSearch::extend(const std::vector<std::string>& effects, const calib::JointModel& start) const {
  Extension extension{effects, fit_.fit(start, unknowns(effects), static_cast<int>(options_.many_iterations)), {}};
  fit_.linearise(extension.fitted);
  extension.held_out = fit_.held_out_squares(extension.fitted, compare_.folds());
  return extension;
}

const MeasuredCause* EffectSearch::measured(const std::string& effect) const {
  const std::vector<MeasuredCause>& all = evidence_.measured;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const MeasuredCause& cause) { return cause.effect == effect; });
  return found == all.end() ? nullptr : &*found;
}

bool EffectSearch::refuted(const Trial& trial) const {
  if (!effects::contains(evidence_.doubted, trial.effect)) return false;
  const effects::NestedModel& fitted = trial.extension.fitted;
  const auto [known, fresh] = refuted_.try_emplace({trial.effect, fitted.squares}, false);
  if (fresh) {
    known->second = power_.refutes(trial.effect, fitted.model,
                                   reset(fitted.model, trial.effect, less(trial.extension.effects, trial.effect)));
  }
  return known->second;
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
  return extend(effects, model);
}

const Extension& EffectSearch::refit_without(const Extension& extension, const std::string& effect) {
  const auto [known, fresh] = without_.try_emplace({effect, extension.fitted.squares});
  if (fresh) {
    const std::vector<std::string> kept = less(extension.effects, effect);
    known->second = extend(kept, reset(extension.fitted.model, effect, kept));
  }
  return known->second;
}

Extension EffectSearch::refit_with_priors(const Extension& extension) const {
  const effects::NestedModel& loose = extension.fitted;
  const bool known = std::any_of(loose.unknowns.begin(), loose.unknowns.end(),
                                 [](const effects::Unknown& u) { return u.deviation > 0.0; });
  if (!known) return extension;
  // A block's residuals are correlated: each block counts as one observation, and so does each prior.
  const double weight = loose.squares / static_cast<double>(std::max<std::size_t>(1, loose.blocks.size()));
  calib::JointModel given = loose.model;
  std::vector<effects::Unknown> effects_only;
  for (const effects::Unknown& u : loose.unknowns) {
    if (u.deviation > 0.0)
      calib::set(given, u.name, u.expected);
    else
      effects_only.push_back(u);
  }
  given = fit_.fit(given, effects_only, static_cast<int>(options_.many_iterations)).model;
  Extension best = extension;
  double least = std::numeric_limits<double>::infinity();
  for (const calib::JointModel& start : {given, loose.model}) {
    effects::NestedModel fitted =
        fit_.fit(start, loose.unknowns, static_cast<int>(options_.many_iterations), nullptr, weight);
    const double squares = fitted.squares + prior(fitted).squares;
    if (squares >= least) continue;
    least = squares;
    best.fitted = std::move(fitted);
  }
  fit_.linearise(best.fitted);
  best.held_out = fit_.held_out_squares(best.fitted, compare_.folds());
  return best;
}

Trial EffectSearch::trial(const Extension& without, const Extension& with, const std::string& effect) const {
  Trial found{effect, compare_(without.held_out, with.held_out), 0.0, with};
  const double rest = without.held_out_squares() / fit_.blocks().all_samples() - limits_.healthy_squares;
  found.share_of_rest = rest > 0.0 ? found.comparison.gain / rest : 0.0;
  if (limits_.healthy_squares <= limits_.noise_squares) {
    const double usual = usual_rest(without);
    if (usual > 0.0) found.share_of_rest = std::max(found.share_of_rest, found.comparison.usual_gain / usual);
  }
  return found;
}

std::string EffectSearch::objection(const Trial& trial) const {
  const fitting::Comparison& c = trial.comparison;
  if (shown(trial.effect)) {  // half-second blocks hardly detect an effect that is constant over a run
    return c.log_gain > 0.0 && c.folds_won >= options_.least_folds_won
               ? ""
               : "runs left out are predicted no better with it";
  }
  // An uncalibrated model may leave outlier blocks: then the gain of the geometric mean counts, too.
  const bool from_scratch = limits_.healthy_squares <= limits_.noise_squares;
  const double gain = from_scratch ? std::max(c.gain, c.usual_gain) : c.gain;
  if (gain <= 0.0) return "runs left out are predicted no better with it";
  if (trial.share_of_rest <= 0.0) return "what is left is no more than models that are in order leave";
  const double amplitude = std::sqrt(gain);
  const double beginning =
      std::max(0.0, base_extension_.held_out_squares() / fit_.blocks().all_samples() - limits_.noise_squares);
  if (c.deviations < options_.least_deviations) {
    return fmt::format("its gain on runs left out is only {:.1f} of its deviations", c.deviations);
  }
  if (c.folds_won < options_.least_folds_won)
    return fmt::format("better in only {:.0f} % of the folds", 100.0 * c.folds_won);
  if (amplitude < limits_.of_noise * std::sqrt(limits_.noise_squares))
    return "what it explains is small beside the noise";
  if (amplitude < limits_.of_beginning * std::sqrt(beginning)) return "what it explains is small beside what was wrong";
  if (trial.share_of_rest < limits_.of_rest) {
    return fmt::format("it explains {:.0f} % of what is left, as others' forms not being quite right would",
                       100.0 * trial.share_of_rest);
  }
  return refuted(trial) ? "the recordings would show it without a model at the strength that fits, and don't" : "";
}

/// The best two starts of an effect; if wanted, also the strength that a model-free check measures.
std::vector<effects::ScreenedStart> EffectSearch::screened_starts(const effects::StartScreen& screen,
                                                                  const effects::Effect& effect, bool measured) const {
  std::vector<effects::ScreenedStart> starts = screen.best(effect, base_.scale);
  starts.resize(std::min<std::size_t>(2, starts.size()));
  const auto evident = evidence_.evident.find(effect.name);
  if (!measured || evident == evidence_.evident.end() || evident->second.empty()) return starts;
  const std::vector<effects::ScreenedStart> further = screen.at(effect, evident->second);
  starts.insert(starts.end(), further.begin(), further.end());
  return starts;
}

/// (extension) => (trials of the effects that it lacks): screened by the linearised fit, the most promising ones
/// fitted.
std::vector<Trial> EffectSearch::tried(const Extension& current, double most, bool all_evident) {
  struct Promising {
    const effects::Effect* effect = nullptr;
    std::vector<effects::ScreenedStart> starts;
  };
  const effects::StartScreen screen(fit_, current.fitted);
  std::vector<Promising> promising;
  for (const effects::Effect& one : effects::catalogue()) {
    if (effects::contains(current.effects, one.name)) continue;
    if (!going(fmt::format("looking at {}", one.title))) return {};
    std::vector<effects::ScreenedStart> starts = screened_starts(screen, one, all_evident);
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
  std::vector<Trial> trials;
  for (const Promising& p : promising) {
    if (!going(fmt::format("fitting {}", p.effect->title))) return {};
    const std::vector<std::string> effects = with(current.effects, p.effect->name);
    Extension best;
    best.fitted.squares = std::numeric_limits<double>::infinity();
    for (const effects::ScreenedStart& start : p.starts) {
      const effects::NestedModel fitted =
          fit_.fit(start.model, unknowns(effects), static_cast<int>(options_.few_iterations), &screen.jacobian());
      if (fitted.squares < best.fitted.squares) best = {effects, fitted, {}};
    }
    fit_.linearise(best.fitted, &screen.jacobian());
    best.held_out = fit_.held_out_squares(best.fitted, compare_.folds());
    trials.push_back(trial(current, best, p.effect->name));
  }
  const auto better = [](const Trial& a, const Trial& b) { return a.comparison.log_gain > b.comparison.log_gain; };
  std::stable_sort(trials.begin(), trials.end(), better);
  // After few iterations a fit may still lie in a valley (load friction as a proxy for Coulomb friction). So the fit
  // with the lowest squares is always finished, whatever its folds say so far.
  const auto closest = std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return a.extension.fitted.squares < b.extension.fitted.squares;
  });
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const bool among_best = t < static_cast<std::size_t>(options_.finished_effects) || evident(trials[t].effect);
    const bool worth =
        among_best && trials[t].comparison.log_gain >= options_.worth_finishing * trials.front().comparison.log_gain;
    if (!worth && !shown(trials[t].effect) && trials.begin() + static_cast<std::ptrdiff_t>(t) != closest) continue;
    if (!going(fmt::format("finishing {}", effects::effect(trials[t].effect).title))) return {};
    trials[t] = trial(current, extend(trials[t].extension.effects, trials[t].extension.fitted.model), trials[t].effect);
  }
  std::stable_sort(trials.begin(), trials.end(), better);
  return trials;
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

const std::vector<Trial>& EffectSearch::alternatives(const Extension& without, const std::string& effect) {
  const auto [known, fresh] = alternatives_.try_emplace({effect, without.fitted.squares});
  if (!fresh) return known->second;
  known->second = tried(without, options_.exchanged_effects, false);
  // An effect that contains this one as a special case explains as much: the simpler one stands.
  std::erase_if(known->second, [&](const Trial& trial) {
    return trial.effect == effect || effects::contains(effects::effect(trial.effect).contains, effect);
  });
  return known->second;
}

}  // namespace pmg::diagnosis
