// A base model extended by effects of the catalogue, each in one of its forms.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "effects/catalogue.hpp"
#include "effects/nested_fit.hpp"
#include "fitting/folds.hpp"

namespace pmg::effects {

/// The model without further effects. Every extension refits its unknowns, so that an effect gets no credit for a
/// residual that the base model can absorb. Parameters that bench.yaml calls unknown are fitted over their full range,
/// parameters known from a calibration or a data sheet within their tolerance.
struct BaseModel {
  calib::JointModel model;
  calib::Unknowns unknowns;
  BenchScale scale;
  /// Numbers that the model has by default, no data sheet gives, and the runs may see: not free, but tried in the place
  /// of an effect before it is believed.
  calib::Unknowns constants{};
};

/// By effect the index of its form in Effect::forms. An effect that isn't listed has its first form.
using Forms = std::map<std::string, std::size_t>;
const Form& form_of(const std::string& effect, const Forms& forms);

/// True if an effect's form has every number of another effect's form, and more.
bool is_nested(const std::string& effect, const Forms& its_forms, const std::string& in, const Forms& forms);

/// True for a form by which something comes late: a delay, a lag, or a sample and hold.
bool is_late(const Form& form);

/// A form that the runs don't tell from the one in a model.
struct OpenForm {
  std::string name;
  std::map<std::string, double> values;  ///< of its parameters, as they fit
};

/// The base model extended by some effects.
struct Extension {
  std::vector<std::string> effects;
  NestedModel fitted;
  fitting::HeldOut held_out;
  Forms forms;
  std::map<std::string, std::vector<OpenForm>> open_forms;  ///< by effect

  double held_out_squares() const { return held_out.mean().sum(); }
  /// How many numbers were chosen by the runs: the fit's unknowns, and the periods and steps that are searched.
  std::size_t numbers() const;
};

/// Fits extensions of one base model to one set of runs. Refers to its arguments: all must outlive it.
class ExtensionFits {
 public:
  ExtensionFits(const bench::Bench& bench, const NestedFit& fit, const BaseModel& base,
                const fitting::BlockComparison& compare)
      : bench_(bench), fit_(fit), base_(base), compare_(compare) {}

  /// The unknowns of the base model, then those of the effects' forms over their whole range.
  calib::Unknowns unknowns(const std::vector<std::string>& effects, const Forms& forms) const;
  /// The model with the parameters of all forms of the effect as in the base model, except those that the form of a
  /// kept effect shares.
  calib::JointModel without(calib::JointModel model, const std::string& effect, const std::vector<std::string>& kept,
                            const Forms& forms) const;
  /// Fitted, linearised, and predicted where each fold is left out.
  Extension fitted(const std::vector<std::string>& effects, const Forms& forms, const calib::JointModel& start,
                   int most_iterations) const;

  const NestedFit& fit() const { return fit_; }
  const BaseModel& base() const { return base_; }
  const fitting::BlockComparison& compare() const { return compare_; }

 private:
  const bench::Bench& bench_;
  const NestedFit& fit_;
  const BaseModel& base_;
  const fitting::BlockComparison& compare_;
};

}  // namespace pmg::effects
