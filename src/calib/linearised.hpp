// A fit's rollouts as linear functions of its parameters, about a point of the unit cube.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/fit_problem.hpp"

namespace pmg::calib {

/// Normal equations of all runs at a point: J has a row a valid sample and a column a parameter [rad per edge of the
/// cube], e is simulated minus measured.
struct Linearised {
  Eigen::MatrixXd information;  ///< J^T J
  Eigen::VectorXd gradient;     ///< J^T e
  Eigen::MatrixXd scatter;      ///< sum over blocks of (J^T e)(J^T e)^T
  int blocks = 0;               ///< of half a second: a joint's motion forgets its disturbance within that
};

/// By central differences; the same whatever the number of threads. Throws std::invalid_argument where the actuator
/// model refuses a neighbour of the point.
Linearised linearise(const FitProblem& problem, const std::vector<double>& point, unsigned threads);

/// Both ends of a parameter's difference, within the cube.
struct Ends {
  std::vector<double> below, above;
  double apart;
};
Ends ends(const std::vector<double>& point, std::size_t dimension);

}  // namespace pmg::calib
