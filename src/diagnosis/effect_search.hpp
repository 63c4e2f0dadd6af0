// Stepwise search for the effects that the runs need: nested extensions of the base model, chosen by cross-validation.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/base_model.hpp"
#include "diagnosis/direct_evidence.hpp"
#include "diagnosis/options.hpp"
#include "effects/folds.hpp"
#include "effects/form_choice.hpp"
#include "effects/start_screen.hpp"
#include "evidence/power.hpp"
#include "work/progress.hpp"

namespace pmg::diagnosis {

using effects::Extension;

/// One effect tried, and its gain.
struct Trial {
  std::string effect;
  fitting::Comparison comparison;  ///< extension without the effect against extension with it
  double share_of_rest = 0.0;      ///< gain as a share of the squares above a healthy model's without the effect
  Extension extension;
  std::string against{};      ///< why it was not taken where it was tried; "" if it was, or might have been
  bool missed_alone = true;   ///< without it more would remain than a verdict forgives (remains_of_noise)
  bool clearly_best = false;  ///< of its round, in which nothing else is convincing
  bool on_trial = false;      ///< to be judged once what it needs beside it is there
};

/// A chosen extension, and its fit with priors. `chosen` is that fit where it is better.
struct Settled {
  Extension chosen, with_priors;
};

struct SearchLimits {
  double noise_squares = 0.0;  ///< mean square that no model goes below [rad^2]
  /// Mean square that a correct model may leave [rad^2]. The search stops below it.
  double healthy_squares = 0.0;
  /// Lower limits: an effect's amplitude as a share of the noise, and of the initial residual; its gain as a share of
  /// the residual above a correct model's.
  double of_noise, of_beginning, of_rest;
  /// A finer step leaves no lower residual: the recordings have this step, and no error of it.
  bool recordings_have_step = false;
};

/// from_scratch: without a model several effects are missing, so weaker ones must be found beside stronger ones.
SearchLimits search_limits(const JointDiagnosisOptions& options, double noise_squares, bool from_scratch);

/// Weight of the priors on the base model's numbers [rad^2]. A block's residuals are correlated: each block counts as
/// one observation, and so does each prior.
double prior_weight(const effects::NestedModel& fitted);

class EffectSearch {
 public:
  EffectSearch(const bench::Bench& bench, const effects::NestedFit& fit, BaseModel base, SearchLimits limits,
               DirectEvidence evidence, const JointDiagnosisOptions& options, work::Progress progress);

  /// The base fitted, no effects in it.
  const Extension& base() const { return base_extension_; }
  /// (runs) => (extension): effects read off the recordings first; then effects are added one by one while the folds
  /// prefer the extension, left out again where they are superfluous, and exchanged where another is clearly better.
  /// At the end each effect takes the best of its forms. Costs some hundred rollouts of all runs for each effect that
  /// is added.
  Extension choose();
  /// (extension, its effect) => (fits of other effects in its place, the best first; a sample and hold in the place of
  /// what makes something late comes last). Costs up to five fits; nothing when asked again, as choose() and the
  /// explanation of its result do.
  const std::vector<Trial>& alternatives(const Extension& current, const std::string& effect);
  /// (extension) => (fits with one more effect each, the best first). Costs up to eight fits.
  std::vector<Trial> additions(const Extension& to);
  /// (extension, effect) => (extension without the effect, fitted again to its end). Costs one fit; nothing when asked
  /// again.
  const Extension& refit_without(const Extension& extension, const std::string& effect);

  /// (extension) => (the same effects, fitted again with priors on the base model's numbers: half of each tolerance is
  /// one standard deviation). Without priors the base model takes over part of the effects. Two starts: the extension,
  /// and the base model as given. Costs three fits.
  Extension refit_with_priors(const Extension& extension) const;

  /// The parameters of an extension's effects that are fitted and not read off.
  std::vector<std::string> fitted_parameters(const Extension& extension) const;

  /// (extension with priors) => (its fit, from other values of its effects' parameters where that ends lower).
  effects::NestedModel from_other_starts(const Extension& with_priors) const;

  /// (chosen extension) => (the same without the effects that don't stand up to a last look, chosen and with priors).
  /// In turn the weakest effect leaves that does not predict runs left out better, or some kind of them worse, or whose
  /// numbers are unsure in the fit with priors. left_out() says why. Costs a fit with priors for each effect that
  /// leaves.
  Settled settled(Extension chosen);
  /// The extension without an effect that turned out to be none. Where that leaves more than a verdict forgives,
  /// another effect may have its place: the search goes on from there, and does not come back to an effect that was
  /// left out.
  Extension leave_out(const Extension& from, const std::string& effect, const std::string& why);
  /// Effects that were chosen and left again, with the reason.
  const std::vector<std::pair<std::string, std::string>>& left_out() const { return left_out_; }

  /// (extension, its effect) => (the effect's special case in its place, fitted; in the form that explains the most of
  /// those of which the effect has all parameters; nothing if it has none). A play of zero is a shaft that bends.
  std::optional<Extension> as_special_case(const Extension& from, const std::string& effect) const;

  /// (extension) => (the same without effects of which another one has every number, where that one does their part,
  /// too). Play takes the place of the soft shaft that stood for it, with the sensor on the side where that had it.
  /// Costs a fit of each form for each such pair.
  Extension without_special_cases(Extension current) const;
  /// (extension) => (the same with an effect's special case in its place where the effect is not clearly better than
  /// that). Costs a fit for each effect that has one.
  Extension in_special_cases(Extension current) const;

  /// True if another effect has every number of this effect's form and a further one, and explains less beside it than
  /// a second effect must: friction that differs a little by direction is the friction.
  bool is_superfluous(const Trial& other, const Extension& current, const std::string& effect) const;

  /// The effect's parameter as read off the recordings; null where it is not.
  const MeasuredCause* measured(const std::string& effect) const;
  /// A model-free check detects the effect, not its size.
  bool shown(const std::string& effect) const;
  /// A model-free check should detect the effect at its fitted strength and does not. Costs simulated checks, once for
  /// each fit of an effect in doubt.
  bool refuted(const Trial& trial) const;

  static constexpr const char* kSmall = "what it explains is small against the initial residual";
  double gain_of(const Trial& trial) const;
  bool is_small(const Trial& trial) const;
  /// True if this gain [rad^2] is large enough beside the noise.
  bool stands_out_of_noise(double gain) const;
  /// Why the trial is not convincing, or "".
  std::string objection(const Trial& trial) const;
  /// Why the effect's numbers in this linearised fit are none, or "": the 95 % intervals of its strengths contain the
  /// neutral values, or the strengths ended at the edge of their ranges. folds: of the fit's runs; null: of the
  /// search's.
  std::string unsure(const std::string& effect, const effects::Forms& forms, const effects::NestedModel& fitted,
                     const std::vector<fitting::Fold>* folds = nullptr) const;
  /// Why an effect of the other sign than its physics is not taken, or "": another effect of the round is not clearly
  /// worse.
  std::string aliased(const Trial& trial, const std::vector<Trial>& round) const;
  fitting::Comparison compared(const Extension& first, const Extension& second) const;
  /// When the runs tell two models apart: two effects as well as two forms of one.
  effects::ApartLimits apart_limits() const;
  /// Geometric mean of the blocks' mean squares beyond the noise [rad^2]. Outlier blocks have little influence (a joint
  /// that stuck in the simulation but not in the recording).
  double usual_rest(const Extension& extension) const;
  /// The effects that the last round of choose() did not take, with their gains.
  const std::vector<Trial>& last_additions() const { return last_additions_; }
  const BaseModel& base_model() const { return base_; }
  bool stopped() const { return stopped_; }  ///< by an interruption
  std::size_t runs() const { return fit_.runs().size(); }

 private:
  Extension with_measured() const;
  Extension completed(Extension current);
  bool was_left_out(const std::string& effect) const;
  Extension with_constant(const calib::Unknown& constant, const std::vector<std::string>& effects,
                          const effects::Forms& forms, const calib::JointModel& start);
  Extension begun_with_constant(const calib::Unknown& constant, const Extension& of);
  void free_constant(const calib::Unknown& constant, const Extension& with);
  std::optional<Extension> with_a_constant_that_shows(const Extension& chosen);
  std::string made_of_constant(const Extension& chosen, const Extension& without, const std::string& effect);
  std::string made_of_step(const Extension& chosen, const Trial& last, double step_error_rad);
  Extension extend(const std::vector<std::string>& effects, const effects::Forms& forms,
                   const calib::JointModel& start) const;
  Trial trial(const Extension& without, const Extension& with, const std::string& effect) const;
  std::string doubt(const Trial& trial) const;
  Extension at_best_period(Extension extension, const std::string& effect) const;
  Extension begun(const Extension& without, const std::string& effect,
                  const std::vector<effects::ScreenedStart>& starts, const effects::RolloutJacobian& known) const;
  std::optional<Trial> hold_in_its_place(const Extension& current, const std::string& effect);
  std::vector<Trial> tried(const Extension& without, double most, bool all_evident);
  bool stands_for(const Trial& special, const Trial& of) const;
  const Trial* chosen(std::vector<Trial>& trials) const;
  const Trial* clearly_best(std::vector<Trial>& trials) const;
  /// More remains in usual blocks than a verdict forgives (remains_of_noise), or if that counts, on average.
  bool misses(const Extension& extension, bool on_average_too) const;
  bool leaves_rest(const Extension& extension) const;
  std::string objection_to_pair(const Extension& pair, const std::string& first, const std::string& second);
  std::optional<Extension> with_pair(const Extension& current);
  bool stands(const Extension& extension, const std::string& effect);
  bool promises(const Trial& trial) const;
  const Trial* most_promising(const std::vector<Trial>& trials) const;
  std::optional<Extension> after_trial(const Trial& trial, const Extension& current);
  std::optional<Extension> with_one_on_trial(const Extension& current);
  Extension pruned(Extension current, const Extension& before);
  bool clearly_better(const Extension& other, const Extension& current) const;
  Extension exchanged(Extension current);
  Extension in_best_forms(Extension current);
  Extension with_simpler_forms(Extension current);
  Extension alone(const Extension& from, const std::string& effect, const std::string& special) const;
  /// A screen of an extension, and the starts of effects that it was asked for.
  struct Look {
    effects::StartScreen screen;
    double squares = 0.0;  // of the extension's fit
    std::vector<std::string> effects{};
    std::map<std::string, std::vector<effects::ScreenedStart>> starts{};
  };
  const Look& look_at(const Extension& extension);
  std::vector<effects::ScreenedStart> screened_starts(const Extension& extension, const effects::Effect& effect,
                                                      bool measured);
  bool going(const std::string& text);

  const bench::Bench& bench_;
  const effects::NestedFit& fit_;
  BaseModel base_;
  SearchLimits limits_;
  DirectEvidence evidence_;
  JointDiagnosisOptions options_;
  mutable evidence::CheckPower power_;
  mutable std::map<std::pair<std::string, double>, bool> refuted_;  // by effect and squares of the fit
  work::Progress progress_;
  fitting::BlockComparison compare_;
  effects::ExtensionFits fits_;
  Extension base_extension_;
  std::vector<Trial> last_additions_;
  std::vector<std::pair<std::string, std::string>> left_out_;
  // What was fitted before, by an effect and the squares of the extension that it was asked of.
  std::map<std::pair<std::string, double>, Extension> without_;
  std::map<std::pair<std::string, double>, std::vector<Trial>> alternatives_;
  std::map<std::string, std::vector<std::string>> forms_compared_at_;  // beside which effects
  std::optional<Look> latest_look_;
  bool on_trial_ = false;  // an effect is, at present
  bool stopped_ = false;
};

}  // namespace pmg::diagnosis
