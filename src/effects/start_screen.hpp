// A cheap screen of start values of an effect's forms: rollouts with the effect, the other unknowns refitted linearly.
#pragma once

#include <memory>
#include <vector>

#include "effects/catalogue.hpp"
#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// A model with the effect in it: a promising start of a fit.
struct ScreenedStart {
  calib::JointModel model;
  double squares = 0.0;  ///< expected after the linear refit of the other unknowns [rad^2]
  std::size_t form = 0;  ///< of Effect::forms
};

/// Values of the form's parameters in a model, in their order.
std::vector<double> values_of(const Form& form, const calib::JointModel& model);

class StartScreen {
 public:
  /// Costs the model's Jacobian. The fit must outlive it.
  StartScreen(const NestedFit& fit, NestedModel current);

  /// The best starts of one form of an effect, at most four, the lowest expected squares first. Costs one rollout of
  /// every run for each start value, two for each wave.
  std::vector<ScreenedStart> best(const Effect& effect, std::size_t form, const BenchScale& scale) const;

  /// (effect) => (its starts to fit): the best of all forms, and the best of another form if that explains at least
  /// this share of what the first one explains; else the second best, and the other form's from a third of the share
  /// on.
  std::vector<ScreenedStart> best_of_forms(const Effect& effect, const BenchScale& scale, double worth) const;

  /// (effect, form, values of its parameters) => (the start with these values; none if it can't be simulated).
  std::vector<ScreenedStart> at(const Effect& effect, std::size_t form, const std::vector<double>& values) const;

  // At the current model.
  const fitting::Residuals& residuals() const { return residuals_; }
  const RolloutJacobian& jacobian() const { return jacobian_; }
  const Eigen::MatrixXd& information() const { return information_; }  ///< J^T J

  const NestedFit& fit() const { return fit_; }

 private:
  struct OfFewRuns;
  void add(const calib::JointModel& model, const fitting::Residuals& residuals, const Form& form,
           std::vector<ScreenedStart>& into) const;
  void screen(const Effect& effect, const Form& form, const std::vector<double>& values,
              std::vector<ScreenedStart>& into) const;
  void scale_strengths(const Effect& effect, const Form& form, const std::vector<double>& values,
                       const fitting::Residuals& there, std::vector<ScreenedStart>& into) const;
  void screen_slips(const Form& form, const std::vector<double>& values, std::vector<ScreenedStart>& into) const;
  void screen_waves(const Form& form, const std::vector<double>& values, std::vector<ScreenedStart>& into) const;
  std::vector<std::vector<double>> promising_waves(const Effect& effect, std::size_t form,
                                                   const BenchScale& scale) const;
  void refit_linearly(const fitting::Residuals& residuals, const Form& form, ScreenedStart& start) const;
  void screen_periods(const Effect& effect, const Form& form, const std::vector<std::vector<double>>& grid,
                      std::vector<ScreenedStart>& into) const;
  calib::JointModel with(const Form& form, const std::vector<double>& values) const;

  const NestedFit& fit_;
  NestedModel current_;
  fitting::Residuals residuals_;
  RolloutJacobian jacobian_;
  Eigen::MatrixXd information_;  // J^T J
  Eigen::VectorXd gradient_;     // J^T r
  mutable std::shared_ptr<const OfFewRuns> for_orders_;
};

}  // namespace pmg::effects
