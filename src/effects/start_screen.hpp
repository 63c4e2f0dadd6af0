// A cheap screen of an effect's start values: rollouts with the effect, the other unknowns refitted linearly.
#pragma once

#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// A model with the effect in it: a promising start of a fit.
struct ScreenedStart {
  calib::JointModel model;
  double squares = 0.0;  ///< expected after the linear refit of the other unknowns [rad^2]
};

class StartScreen {
 public:
  StartScreen(const NestedFit& fit, const NestedModel& current);

  /// The effect's best starts, at most four, the lowest expected squares first. Costs one rollout of every run for each
  /// start value, two for each wave.
  std::vector<ScreenedStart> best(const Effect& effect, const BenchScale& scale) const;

  /// (effect, values of its parameters) => (the start with these values; none if it can't be simulated).
  std::vector<ScreenedStart> at(const Effect& effect, const std::vector<double>& values) const;

  /// At the current model.
  const RolloutJacobian& jacobian() const { return jacobian_; }

 private:
  void screen(const Effect& effect, const std::vector<double>& values, std::vector<ScreenedStart>& into) const;
  void line_search(const Effect& effect, const std::vector<double>& values, const fitting::Residuals& there,
                   std::vector<ScreenedStart>& into) const;
  void screen_wave(const Effect& effect, const std::string& amplitude, const std::string& phase, double height,
                   const calib::JointModel& flat, std::vector<ScreenedStart>& into) const;
  std::vector<std::vector<double>> promising_waves(const Effect& effect, const BenchScale& scale) const;
  void refit_linearly(const fitting::Residuals& residuals, const Effect& effect, ScreenedStart& start) const;

  const NestedFit& fit_;
  const NestedModel& current_;
  fitting::Residuals residuals_;
  RolloutJacobian jacobian_;
  Eigen::MatrixXd information_;
};

}  // namespace pmg::effects
