// Stepwise search for the effects that the runs need: nested extensions of the base model, chosen by cross-validation.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/base_model.hpp"
#include "diagnosis/direct_evidence.hpp"
#include "diagnosis/options.hpp"
#include "effects/folds.hpp"
#include "effects/start_screen.hpp"
#include "evidence/power.hpp"
#include "work/progress.hpp"

namespace pmg::diagnosis {

/// The base model extended by some effects.
struct Extension {
  std::vector<std::string> effects;
  effects::NestedModel fitted;
  Eigen::VectorXd held_out;  ///< squares of each block by fits without its fold [rad^2]

  double held_out_squares() const { return held_out.sum(); }
};

/// One effect tried, and its gain.
struct Trial {
  std::string effect;
  fitting::Comparison comparison;  ///< extension without the effect against extension with it
  double share_of_rest = 0.0;      ///< gain as a share of the squares above a healthy model's without the effect
  Extension extension;
};

struct SearchLimits {
  double noise_squares = 0.0;  ///< mean square that no model goes below [rad^2]
  /// Mean square that a correct model may leave [rad^2]. The search stops below it.
  double healthy_squares = 0.0;
  /// Lower limits: an effect's amplitude as a share of the noise, and of the initial residual; its gain as a share of
  /// the residual above a correct model's.
  double of_noise, of_beginning, of_rest;
};

class EffectSearch {
 public:
  EffectSearch(const bench::Bench& bench, const effects::NestedFit& fit, BaseModel base, SearchLimits limits,
               DirectEvidence evidence, const JointDiagnosisOptions& options, work::Progress progress);

  /// The base fitted, no effects in it.
  const Extension& base() const { return base_extension_; }
  /// (runs) => (extension): effects read off the recordings first; then effects are added one by one while the folds
  /// prefer the extension, left out again where they are superfluous, and exchanged where another is clearly better.
  /// Costs some hundred rollouts of all runs for each effect that is added.
  Extension choose();
  /// (extension without an effect, that effect) => (fits of other effects in its place, the best first). Costs up to
  /// five fits; nothing when asked again, as choose() and the explanation of its result do.
  const std::vector<Trial>& alternatives(const Extension& without, const std::string& effect);
  /// (extension) => (fits with one more effect each, the best first). Costs up to eight fits.
  std::vector<Trial> additions(const Extension& to);
  /// (extension, effect) => (extension without the effect, fitted again to its end). Costs one fit; nothing when asked
  /// again.
  const Extension& refit_without(const Extension& extension, const std::string& effect);

  /// (extension) => (the same effects, fitted again with priors on the base model's numbers: half of each tolerance is
  /// one standard deviation). Without priors the base model takes over part of the effects. Two starts: the extension,
  /// and the base model as given. Costs three fits.
  Extension refit_with_priors(const Extension& extension) const;

  /// The effect's parameter as read off the recordings; null where it is not.
  const MeasuredCause* measured(const std::string& effect) const;
  /// A model-free check detects the effect, not its size.
  bool shown(const std::string& effect) const;
  /// A model-free check should detect the effect at its fitted strength and does not. Costs simulated checks, once for
  /// each fit of an effect in doubt.
  bool refuted(const Trial& trial) const;

  /// Why the trial is not convincing, or "".
  std::string objection(const Trial& trial) const;
  fitting::Comparison compared(const Extension& first, const Extension& second) const;
  /// Geometric mean of the blocks' mean squares beyond the noise [rad^2]. Outlier blocks have little influence (a joint
  /// that stuck in the simulation but not in the recording).
  double usual_rest(const Extension& extension) const;
  /// The effects that the last round of choose() did not take, with their gains.
  const std::vector<Trial>& last_additions() const { return last_additions_; }
  const BaseModel& base_model() const { return base_; }

 private:
  std::vector<effects::Unknown> unknowns(const std::vector<std::string>& effects) const;
  calib::JointModel reset(calib::JointModel model, const std::string& effect,
                          const std::vector<std::string>& kept) const;
  Extension with_measured() const;
  Extension extend(const std::vector<std::string>& effects, const calib::JointModel& start) const;
  Trial trial(const Extension& without, const Extension& with, const std::string& effect) const;
  std::vector<Trial> tried(const Extension& without, double most, bool all_evident);
  const Trial* chosen(const std::vector<Trial>& trials) const;
  Extension pruned(Extension current, const Extension& before);
  Extension exchanged(Extension current);
  std::vector<effects::ScreenedStart> screened_starts(const effects::StartScreen& screen, const effects::Effect& effect,
                                                      bool measured) const;
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
  Extension base_extension_;
  std::vector<Trial> last_additions_;
  // What was fitted before, by an effect and the squares of the extension that it was asked of.
  std::map<std::pair<std::string, double>, Extension> without_;
  std::map<std::pair<std::string, double>, std::vector<Trial>> alternatives_;
  bool stopped_ = false;
};

}  // namespace pmg::diagnosis
