// The fit of all levels: Gauss-Newton over the model's numbers and each level's deviation, by rollouts.
#pragma once

#include "assembly/level_model.hpp"
#include "evidence/verdict.hpp"

namespace pmg::assembly {

/// One level's value with its interval.
struct LevelValue {
  std::string level;
  std::size_t runs = 0;
  evidence::Interval value;
};

struct FittedLevels {
  calib::JointModel model;                      ///< with the means of the parameters that vary
  std::vector<std::vector<LevelValue>> levels;  ///< by varying parameter
  std::vector<evidence::Interval> means;        ///< over all assemblies, with the spread's part
  fitting::HeldOut held_out;                    ///< squares of blocks left out [rad^2]
};

/// A varying parameter with what is needed for its interval.
struct VaryingParameter {
  LevelEffect effect;  ///< its column is of the equations
  double unit_squares = 0.0, freedom = 0.0;
};

/// (fit of all runs, model with the columns of all varying parameters free, what varies, folds, with levels or without)
/// => (fit). The levels' prior is normal with their spread: 0 squares for a deviation of 0. Intervals: value +-
/// t(freedom) sqrt(phi (A^-1)_ii), A the information with priors. Costs one rollout of every run for each column, two
/// to six for each iteration and one to three for each fold.
class LevelFit {
 public:
  LevelFit(const effects::NestedFit& fit, const effects::NestedModel& at, std::vector<VaryingParameter> varying);

  FittedLevels fitted(const std::vector<fitting::Fold>& folds, bool with_levels, int most_iterations) const;

 private:
  fitting::Jacobian jacobian(bool with_levels) const;
  fitting::Problem problem(std::vector<calib::SingleJoint>& runs, const fitting::Jacobian& known,
                           bool with_levels) const;
  std::vector<std::vector<bench::AssemblyDifference>> differences(const Eigen::VectorXd& x) const;
  void read_off(FittedLevels& found, const fitting::LinearisedFit& fit) const;

  const effects::NestedFit& fit_;
  const effects::NestedModel& at_;
  std::vector<VaryingParameter> varying_;
  std::vector<Eigen::Index> first_level_;
  Eigen::Index count_ = 0;
  fitting::Jacobian jacobian_;  ///< of all coordinates, at the start
};

}  // namespace pmg::assembly
