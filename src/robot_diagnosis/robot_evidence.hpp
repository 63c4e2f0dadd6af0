// From equations to causes: which of a robot's numbers lie further from the model than robots of its kind do.
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
  int candidate = -1;                      ///< of the list
  Eigen::VectorXd value{}, low{}, high{};  ///< 95 %, one a parameter of the candidate
  double log_evidence = 0.0;               ///< natural logarithm of how much more probable the data are with this cause
  int folds_better = 0, folds = 0;
  std::vector<int> or_instead{};  ///< candidates that explain as much, the best first
  /// By how much the strongest of these predicts other equations than this cause does, in squared noise, by Support.
  std::array<double, kSupports> apart{};
};

struct RobotEvidence {
  std::vector<RobotFinding> findings;          ///< the strongest first
  Eigen::VectorXd theta;                       ///< all parameters, with the findings
  std::vector<double> candidate_log_evidence;  ///< each alone, before anything was found
  std::vector<double> detectable;  ///< per parameter: smallest value that would have shown (one of its kind alone)
  double held_out_before = 0.0, held_out_after = 0.0;  ///< rms over blocks left out, in units of the noise
  std::vector<double> left;  ///< per kind of row: rms of what remains with the findings, in the row's unit
};

/// Throws std::runtime_error when there are no rows.
RobotEvidence weigh(std::vector<RobotBlock> blocks, int kinds, const RobotParameterList& list,
                    const EvidenceOptions& options = {});

}  // namespace pmg::robot_diagnosis
