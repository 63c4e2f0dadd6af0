// A cheap look at what an effect could explain: rollouts with it, the rest of the model following linearly.
#pragma once

#include <vector>

#include "effects/nested_fit.hpp"

namespace pmg::effects {

/// A model with the effect in it, from which a fit is worth beginning.
struct ScreenedStart {
  calib::JointModel model;
  double squares = 0.0;  ///< expected once the rest has followed [rad^2]
};

class StartScreen {
 public:
  StartScreen(const NestedFit& fit, const NestedModel& current);

  /// The most promising starts of the effect, the best first.
  std::vector<ScreenedStart> best(const Effect& effect, const BenchScale& scale) const;

  /// At the current model.
  const RolloutJacobian& jacobian() const { return jacobian_; }

 private:
  void look(const Effect& effect, const std::vector<double>& values, std::vector<ScreenedStart>& into) const;
  void look_along(const Effect& effect, const std::vector<double>& values, const fitting::Residuals& there,
                  std::vector<ScreenedStart>& into) const;
  void look_at_wave(const Effect& effect, const std::string& amplitude, const std::string& phase, double height,
                    const calib::JointModel& flat, std::vector<ScreenedStart>& into) const;
  void follow(const fitting::Residuals& residuals, const Effect& effect, ScreenedStart& start) const;

  const NestedFit& fit_;
  const NestedModel& current_;
  fitting::Residuals residuals_;
  RolloutJacobian jacobian_;
  Eigen::MatrixXd information_;
};

}  // namespace pmg::effects
