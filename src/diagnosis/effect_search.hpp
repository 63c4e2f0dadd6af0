// Which effects of the catalogue the runs ask for: nested extensions, chosen by folds.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnosis/base_model.hpp"
#include "diagnosis/direct_evidence.hpp"
#include "diagnosis/folds.hpp"

namespace pmg::diagnosis {

/// The base with some effects in it.
struct Extension {
  std::vector<std::string> effects;
  NestedModel fitted;
  Eigen::VectorXd held_out;  ///< squares by block, from folds

  double held_out_squares() const { return held_out.sum(); }
};

/// How an effect fared.
struct Trial {
  std::string effect;
  Comparison comparison;       ///< of the extension without it with the one that has it
  double share_of_rest = 0.0;  ///< of what was above a healthy model's without it
  Extension extension;
};

struct SearchLimits {
  double noise_squares = 0.0;  ///< mean square that no model goes below [rad^2]
  /// What may be left by a model that is in order [rad^2]: nothing is looked for below it.
  double healthy_squares = 0.0;
  /// What an effect's amplitude must reach: shares of the noise's, and of what was wrong in the beginning; and its
  /// gain: of what is left beyond a healthy model.
  double of_noise = 1.2, of_beginning = 0.1, of_rest = 0.35;
};

/// Called now and then with what is done; false ends the search with what is known.
using SearchProgress = std::function<bool(const std::string& text)>;

class EffectSearch {
 public:
  EffectSearch(const bench::Bench& bench, const NestedFit& fit, BaseModel base, SearchLimits limits,
               DirectEvidence evidence, SearchProgress progress);

  /// The base fitted, no effects in it.
  const Extension& base() const { return base_extension_; }
  /// What is measured stands; effects are added to it one by one while folds say so, exchanged where another does
  /// better, and left out again where they have become superfluous.
  Extension choose();
  /// Fits of other effects in the place of the one that has been left out, the best first.
  std::vector<Trial> alternatives(const Extension& without, const std::string& effect);
  /// What the effects that aren't in the extension would add to it, the best first.
  std::vector<Trial> additions(const Extension& to);
  Extension without(const Extension& extension, const std::string& effect) const;

  /// The same effects where the rest of the model may leave what is given only as far as a calibration errs: loose, it
  /// takes over part of the effects, and its own start may have kept it there.
  Extension settled(const Extension& extension) const;

  /// The effect's, where recordings show it by themselves; else null.
  const MeasuredCause* measured(const std::string& effect) const;
  /// Recordings show it by themselves, though not how much.
  bool shown(const std::string& effect) const;
  /// Recordings would show it by themselves, and don't.
  bool refuted(const std::string& effect) const;

  /// Why the trial isn't convincing, or "".
  std::string objection(const Trial& trial) const;
  Comparison compared(const Extension& first, const Extension& second) const;
  /// Mean square of a usual block beyond the noise [rad^2]: their geometric mean, on which single blocks that went
  /// another way altogether (a joint that stuck, and didn't in the recording) have little say.
  double usual_rest(const Extension& extension) const;
  /// Of the last round of choose(): what the effects that it didn't take would have added.
  const std::vector<Trial>& last_additions() const { return last_additions_; }
  const BaseModel& base_model() const { return base_; }

 private:
  std::vector<Unknown> unknowns(const std::vector<std::string>& effects) const;
  calib::JointModel reset(calib::JointModel model, const std::string& effect,
                          const std::vector<std::string>& kept) const;
  Extension with_measured() const;
  Extension extend(const std::vector<std::string>& effects, const calib::JointModel& start, int iterations) const;
  Trial trial(const Extension& without, const Extension& with, const std::string& effect) const;
  std::vector<Trial> tried(const Extension& without, std::size_t most);
  const Trial* chosen(const std::vector<Trial>& trials) const;
  Extension pruned(Extension current, const Extension& before);
  Extension exchanged(Extension current);
  bool going(const std::string& text);

  const bench::Bench& bench_;
  const NestedFit& fit_;
  BaseModel base_;
  SearchLimits limits_;
  DirectEvidence evidence_;
  SearchProgress progress_;
  BlockComparison compare_;
  Extension base_extension_;
  std::vector<Trial> last_additions_;
  bool stopped_ = false;
};

}  // namespace pmg::diagnosis
