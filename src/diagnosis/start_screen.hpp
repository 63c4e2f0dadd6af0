// A cheap look at what an effect could explain: rollouts with it, the rest of the model following linearly.
#pragma once

#include <vector>

#include "diagnosis/nested_fit.hpp"

namespace pmg::diagnosis {

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
  const Slopes& slopes() const { return slopes_; }

 private:
  void look(const Effect& effect, const std::vector<double>& values, std::vector<ScreenedStart>& into) const;
  void look_along(const Effect& effect, const std::vector<double>& values, const Misses& there,
                  std::vector<ScreenedStart>& into) const;
  void look_at_wave(const Effect& effect, const std::string& amplitude, const std::string& phase, double height,
                    const calib::JointModel& flat, std::vector<ScreenedStart>& into) const;
  void follow(const Misses& misses, const Effect& effect, ScreenedStart& start) const;

  const NestedFit& fit_;
  const NestedModel& current_;
  Misses misses_;
  Slopes slopes_;
  Eigen::MatrixXd information_;
};

}  // namespace pmg::diagnosis
