// EffectSearch's reasons against an effect.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/unknown.hpp"
#include "diagnosis/effect_search.hpp"
#include "effects/catalogue.hpp"
#include "effects/intervals.hpp"
#include "effects/strengths.hpp"

namespace pmg::diagnosis {

namespace {

/// A strength that stopped at a bound of its range other than neutral, or null. The order of a wave counts too: with
/// no more than one period over the range of motion it is any smooth torque's proxy.
const calib::Unknown* at_edge(const std::string& effect, const effects::Forms& forms,
                              const effects::NestedModel& fitted, const calib::JointModel& neutral) {
  const std::vector<std::string> strengths = effects::strengths(effect, forms);
  const std::vector<std::string>& parameters = effects::form_of(effect, forms).parameters;
  for (std::size_t i = 0; i < fitted.unknowns.size(); ++i) {
    const calib::Unknown& u = fitted.unknowns[i];
    const bool order = effects::is_order(u.name) && effects::contains(parameters, u.name);
    if (!order && !effects::contains(strengths, u.name)) continue;
    const double x = u.value(fitted.coordinates[static_cast<Eigen::Index>(i)]), edge = 1e-6 * (u.upper - u.lower);
    const double none = std::clamp(calib::value(neutral, u.name), u.lower, u.upper);
    if ((x <= u.lower + edge || x >= u.upper - edge) && (order || std::abs(x - none) > edge)) return &u;
  }
  return nullptr;
}

/// Why none of an effect's strengths is surely another than in the model without it, nor all together, or "". Of
/// several strengths the folds may disagree how much belongs to which: whether they need any is said by what they
/// predict.
std::string maybe_neutral(const std::vector<std::string>& strengths, const effects::NestedModel& fitted,
                          const calib::JointModel& neutral, const std::vector<fitting::Fold>& folds,
                          double noise_squares, const effects::IntervalOptions& options) {
  const std::vector<evidence::Interval> intervals = parameter_intervals(fitted, folds, noise_squares, options);
  std::string why;
  std::vector<Eigen::Index> coordinates;
  std::vector<double> none_at;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const calib::Unknown& u = fitted.unknowns[i];
    if (!effects::contains(strengths, u.name)) continue;
    const evidence::Interval& x = intervals[i];
    const double none = std::clamp(calib::value(neutral, u.name), u.lower, u.upper);
    if (none < x.low || none > x.high) return "";
    why = fmt::format("{} may as well be {:.3g}: {:.3g} ({:.3g} to {:.3g})", u.name, none, x.value, x.low, x.high);
    coordinates.push_back(static_cast<Eigen::Index>(i));
    none_at.push_back(u.coordinate(none));
  }
  constexpr double kUnlikely = 0.05;
  const Eigen::Map<const Eigen::VectorXd> none(none_at.data(), std::ssize(none_at));
  const bool sure =
      coordinates.size() > 1 && effects::chance_of(fitted, coordinates, none, noise_squares, options) < kUnlikely;
  return sure ? "" : why;
}

}  // namespace

double prior_weight(const effects::NestedModel& fitted) {
  return fitted.squares / static_cast<double>(std::max<std::size_t>(1, fitted.blocks.size()));
}

bool EffectSearch::refuted(const Trial& trial) const {
  if (!effects::contains(evidence_.doubted, trial.effect)) return false;
  const effects::NestedModel& fitted = trial.extension.fitted;
  const auto [known, fresh] = refuted_.try_emplace({trial.effect, fitted.squares}, false);
  if (fresh) {
    std::vector<std::string> kept = trial.extension.effects;
    std::erase(kept, trial.effect);
    known->second = power_.refutes(trial.effect, fitted.model,
                                   fits_.without(fitted.model, trial.effect, kept, trial.extension.forms));
  }
  return known->second;
}

/// The gain that counts [rad^2]. An uncalibrated model may leave outlier blocks: then the gain of the geometric mean
/// counts, too.
double EffectSearch::gain_of(const Trial& trial) const {
  const bool from_scratch = limits_.healthy_squares <= limits_.noise_squares;
  return from_scratch ? std::max(trial.comparison.gain, trial.comparison.usual_gain) : trial.comparison.gain;
}

/// True if what the effect explains is small against the initial residual, and what the model misses without it doesn't
/// ask for it.
bool EffectSearch::is_small(const Trial& trial) const {
  const fitting::Comparison& c = trial.comparison;
  const double beginning =
      std::max(0.0, base_extension_.held_out_squares() / fit_.blocks().all_samples() - limits_.noise_squares);
  // A second effect that only mends the first one's form leaves a rest itself, or mends what a verdict forgives.
  const double least = std::pow(limits_.of_beginning, 2), usual = usual_rest(base_extension_);
  const bool few_blocks = beginning > options_.mean_of_few_blocks * usual && c.usual_gain >= least * usual;
  const bool sure = c.deviations >= options_.all_of_rest_deviations;
  const bool nearly_all = trial.share_of_rest >= options_.nearly_all_of_rest;
  const bool all = sure && trial.clearly_best && trial.share_of_rest >= options_.all_of_rest;
  // What leaves half of the residual, noise and all, in usual blocks shows that there was less noise than repeats say.
  const bool halves = sure && nearly_all && c.log_gain >= options_.halved_log_gain;
  const bool counts = all || halves || (trial.missed_alone && (few_blocks || nearly_all));
  return gain_of(trial) < least * beginning && !counts;
}

bool EffectSearch::stands_out_of_noise(double gain) const {
  return std::sqrt(std::max(0.0, gain)) >= limits_.of_noise * std::sqrt(limits_.noise_squares);
}

std::string EffectSearch::objection(const Trial& trial) const {
  const fitting::Comparison& c = trial.comparison;
  if (shown(trial.effect)) {  // half-second blocks hardly detect an effect that is constant over a run
    return c.log_gain > 0.0 && c.folds_won >= options_.least_folds_won
               ? doubt(trial)
               : "runs left out are predicted no better with it";
  }
  const double gain = gain_of(trial);
  if (gain <= 0.0) return "runs left out are predicted no better with it";
  if (trial.share_of_rest <= 0.0) return "what is left is no more than models that are in order leave";
  if (c.deviations < (trial.on_trial ? options_.deviations_on_trial : options_.least_deviations)) {
    return fmt::format("its gain on runs left out is only {:.1f} of its deviations", c.deviations);
  }
  if (!trial.on_trial && c.folds_won < options_.least_folds_won)
    return fmt::format("better in only {:.0f} % of the folds", 100.0 * c.folds_won);
  if (!stands_out_of_noise(gain)) return "what it explains is small beside the noise";
  if (!trial.on_trial && is_small(trial)) return kSmall;
  if (trial.share_of_rest < limits_.of_rest) {
    return fmt::format("it explains {:.0f} % of what is left: model-form errors of other effects can explain as much",
                       100.0 * trial.share_of_rest);
  }
  if (const std::string why = doubt(trial); !why.empty()) return why;
  return refuted(trial) ? "ruled out: a model-free check should detect this strength and does not" : "";
}

/// Why the effect is no cause whatever it gains on average, or "": worse where one kind of folds is left out, its
/// numbers unsure, or its torque another effect's.
std::string EffectSearch::doubt(const Trial& trial) const {
  for (const fitting::KindComparison& kind : trial.comparison.of_kind) {
    if (std::min(kind.deviations, kind.square_deviations) < -options_.worse_deviations)
      return fmt::format("runs of a {} left out are predicted worse with it, by {:.1f} deviations", kind.kind,
                         -std::min(kind.deviations, kind.square_deviations));
  }
  const effects::NestedModel& fitted = trial.extension.fitted;
  const effects::Forms& forms = trial.extension.forms;
  if (fitted.blocks.empty()) return "";
  // What one torque does, the other effect would do alone.
  const bool needed = trial.missed_alone && trial.share_of_rest >= options_.nearly_all_of_rest;
  for (const std::string& other : trial.extension.effects) {
    if (other == trial.effect) continue;
    if (at_edge(other, forms, fitted, base_.model) != nullptr)
      return fmt::format("with it {} ends at the edge of its range", effects::title(other));
    const double alike = effects::likeness(fitted, forms, base_.model, trial.effect, other);
    if (!needed && alike * alike > options_.one_torque)
      return fmt::format("on these runs it is the torque of {} by another name", effects::title(other));
  }
  return unsure(trial.effect, forms, fitted);
}

std::string EffectSearch::unsure(const std::string& effect, const effects::Forms& forms,
                                 const effects::NestedModel& fitted, const std::vector<fitting::Fold>* folds) const {
  if (const calib::Unknown* u = at_edge(effect, forms, fitted, base_.model))
    return fmt::format("{} ends at the edge of its range, {:.3g} to {:.3g} {}", u->name, u->lower, u->upper, u->unit());
  if (effects::fades_unseen(effect, forms, fitted.model, base_.scale.speed_rad_s))
    return "less than half of its friction fades at the speeds of these runs: they can't tell it from Coulomb friction";
  effects::NestedModel known = fitted;  // without the priors gains, inertia and friction may scale together
  if (known.prior_weight == 0.0) known.prior_weight = prior_weight(known);
  return maybe_neutral(effects::strengths(effect, forms), known, base_.model,
                       folds != nullptr ? *folds : compare_.folds(), limits_.noise_squares, options_.intervals);
}

}  // namespace pmg::diagnosis
