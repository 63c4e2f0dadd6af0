// From equations to causes: which parameters deviate from the model by more than the tolerances of its series.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "robot_diagnosis/robot_options.hpp"
#include "robot_diagnosis/robot_parameters.hpp"
#include "robot_diagnosis/robot_row.hpp"

namespace pmg::robot_diagnosis {

struct RobotFinding {
  int candidate = -1;                      ///< index into the list
  Eigen::VectorXd value{}, low{}, high{};  ///< estimate and 95 % interval of each parameter of the candidate
  double log_evidence = 0.0;               ///< log Bayes factor of the data with and without this cause
  int folds_better = 0, folds = 0;
  std::vector<int> or_instead{};  ///< rival candidates that explain as much, the best first
  /// Squared difference of the predictions of this cause and the best rival, in units of the noise, by Support.
  std::array<double, kSupports> apart{};
};

struct RobotEvidence {
  std::vector<RobotFinding> findings;                  ///< the strongest first
  Eigen::VectorXd theta;                               ///< posterior mean of all parameters, with the findings
  std::vector<double> candidate_log_evidence;          ///< of each candidate alone, before the first finding
  std::vector<double> detectable;                      ///< per parameter: smallest error that is detectable alone
  double held_out_before = 0.0, held_out_after = 0.0;  ///< rms over blocks left out, in units of the noise
  std::vector<double> left;  ///< per kind of row: rms residual with the findings, in the row's unit
};

/// (blocks of rows, number of kinds, parameters) => (evidence). Throws std::runtime_error if there are no rows.
RobotEvidence find_causes(std::vector<RobotBlock> blocks, int kinds, const RobotParameterList& list,
                          const EvidenceOptions& options = {});

}  // namespace pmg::robot_diagnosis
