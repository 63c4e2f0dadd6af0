// The thresholds of a robot's diagnosis.
#pragma once

#include <vector>

#include "evidence/option.hpp"
#include "robot_diagnosis/robot_parameters.hpp"

namespace pmg::robot_diagnosis {

/// How the robot's support is recognised; forces are shares of its weight.
struct SupportOptions {
  double most_in_the_air = 0.12, least_on_the_ground = 0.15, least_weight = 0.7, most_weight = 1.4;
  double stepping_m_s = 0.03, flat_rad = 0.15, least_upright = 0.7;
};

/// When a sole slips, and the uncertainty of the ground's friction.
struct GroundOptions {
  double slipping_m_s = 0.24, sticking_m_s = 0.08, quantile_of_slipping = 0.75, least_load = 0.25;
  double quantile_of_sticking = 0.99, most_weight = 1.4, fewest_samples = 8.0, systematic = 0.03;
};

/// Which rows of the equations count, and when their noise is independent.
struct NoiseOptions {
  double most_standstill = 0.2, fewest_rows = 20.0, longest_lag = 30.0, least_autocorrelation = 0.05;
};

/// When a cause is named, and when two are told apart.
struct EvidenceOptions {
  double least_log_evidence = 12.0, share_in_folds = 0.5, told_apart = 5.0, most_findings = 4.0;
  double detectable_margin = 2.0;
  NoiseOptions noise;
};

/// listed() gives the unit, the reason and the data of each threshold.
struct RobotDiagnosisOptions {
  RobotTolerances tolerances;
  RobotCauseSizes causes;
  EvidenceOptions evidence;
  SupportOptions support;
  GroundOptions ground;
  double block_s = 4.0, low_pass_s = 0.025, standing_low_pass_s = 0.075, settle_samples = 4.0;
  double direction_low_pass_s = 0.025, turning_rad_s = 0.02;
  double remains_of_friction = 0.5, remains_rad_s2 = 0.4;
};

/// Every number of the struct and of those in it, as "ground.slipping_m_s".
std::vector<evidence::Option> listed(const RobotDiagnosisOptions& options);

}  // namespace pmg::robot_diagnosis
