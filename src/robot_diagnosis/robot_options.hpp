// The thresholds of a robot's diagnosis.
#pragma once

#include <string_view>
#include <vector>

#include "robot_diagnosis/robot_parameters.hpp"
#include "work/threshold.hpp"

namespace pmg::robot_diagnosis {

/// How the robot's support is recognised; forces are shares of its weight.
struct SupportOptions {
  work::Threshold most_in_the_air{0.12, "weight", "a leg in the air shows what friction leaves of a force on its foot",
                                  kRobots};
  work::Threshold least_on_the_ground{0.15, "weight", "a foot that stands carries at least this", kRobots};
  work::Threshold least_weight{0.7, "weight", "two feet that stand carry together at least this", kRobots};
  work::Threshold most_weight{1.4, "weight", "and at most this", kRobots};
  work::Threshold stepping_m_s{0.03, "m/s", "feet whose distance changes faster step", kRobots};
  work::Threshold flat_rad{0.15, "rad", "soles that are tilted further are not flat on the ground", kRobots};
  work::Threshold least_upright{0.7, "",
                                "cosine of the base's tilt: a robot that has fallen has its feet in the air too",
                                "hidden robots 106 and 109"};

  PMG_THRESHOLDS(most_in_the_air, least_on_the_ground, least_weight, most_weight, stepping_m_s, flat_rad, least_upright)
};

/// When a sole slips, and the uncertainty of the ground's friction.
struct GroundOptions {
  work::Threshold slipping_m_s{
      0.24, "m/s", "between the soles: from some 0.1 m/s a foot on a contact has its whole friction", kPhysics};
  work::Threshold sticking_m_s{0.08, "m/s", "below it soles creep under a force that a real ground would hold",
                               kPhysics};
  work::Threshold quantile_of_slipping{
      0.75, "", "soles that begin or end to slip, or hop, show less than the ground's friction", kRobots};
  work::Threshold least_load{0.25, "weight", "on each foot", kRobots};
  work::Threshold quantile_of_sticking{0.99, "", "soles that stick show that the ground's friction is at least this",
                                       kAssumed};
  work::Threshold most_weight{1.4, "weight", "on both feet: more is a landing", kRobots};
  work::CountThreshold fewest_samples{8, "", "of slipping soles", kRobots};
  work::Threshold systematic{0.03, "", "standard deviation from the legs' friction and gains within their tolerances",
                             kRobots};

  PMG_THRESHOLDS(slipping_m_s, sticking_m_s, quantile_of_slipping, least_load, quantile_of_sticking, most_weight,
                 fewest_samples, systematic)
};

/// Which rows of the equations count, and when their noise is independent.
struct NoiseOptions {
  work::Threshold most_standstill{0.2, "",
                                  "an equation counts if dry friction of unknown direction is at most this share of "
                                  "its whole dry friction, squared",
                                  kAssumed};
  work::CountThreshold fewest_rows{20, "", "rows of a kind that its noise level needs", kAssumed};
  work::CountThreshold longest_lag{30, "rows", "longest lag of the noise's autocorrelation", kAssumed};
  work::Threshold least_autocorrelation{0.05, "", "rows whose autocorrelation is smaller are independent", kAssumed};

  PMG_THRESHOLDS(most_standstill, fewest_rows, longest_lag, least_autocorrelation)
};

/// When a cause is named, and when two are told apart.
struct EvidenceOptions {
  work::Threshold least_log_evidence{
      12.0, "",
      "natural logarithm: a cause must make the data so much more probable, among some two hundred candidates",
      kRobots};
  work::Threshold share_in_folds{0.5, "", "share of it that must remain whichever block is left out", kAssumed};
  work::Threshold told_apart{5.0, "", "log evidence between two causes below which neither is preferred", kRobots};
  work::CountThreshold most_findings{4, "", "causes that one robot may have", kAssumed};
  work::Threshold detectable_margin{
      2.0, "", "log evidence beyond the least one that an error needs to be called detectable", kAssumed};
  NoiseOptions noise;

  PMG_THRESHOLDS(least_log_evidence, share_in_folds, told_apart, most_findings, detectable_margin, noise)
};

struct RobotDiagnosisOptions {
  RobotTolerances tolerances;
  RobotCauseSizes causes;
  EvidenceOptions evidence;
  SupportOptions support;
  GroundOptions ground;
  work::Threshold block_s{4.0, "s", "stretch that a fold leaves out", kAssumed};
  work::Threshold low_pass_s{
      0.025, "s", "deviation of the Gaussian low-pass: -3 dB at 5.3 Hz; the hanging excitation ends at 2.1 Hz",
      kAssumed};
  work::Threshold standing_low_pass_s{
      0.075, "s",
      "deviation of the Gaussian low-pass while standing, where a squat takes seconds: noise that is in an equation "
      "and in its coefficients alike looks like too little mass",
      kRobots};
  work::CountThreshold settle_samples{4, "", "samples to each side of a change of support that are left out", kRobots};
  work::Threshold direction_low_pass_s{
      0.025, "s",
      "deviation of the low-pass of the speed that gives a joint's direction: an encoder's noise turns it at once",
      kAssumed};
  work::Threshold turning_rad_s{0.02, "rad/s", "slower joints turn: MuJoCo's dry friction is not at its full value",
                                kPhysics};
  work::Threshold remains_of_friction{
      0.5, "", "share of a joint's dry friction that its equation may leave near standstill", kRobots};
  work::Threshold remains_rad_s2{0.4, "rad/s^2",
                                 "times the moved inertia: the rest from the noise of accelerations, five times that "
                                 "of a gyro with 0.01 rad/s after the low-pass",
                                 kRobots};

  PMG_THRESHOLDS(tolerances, causes, evidence, support, ground, block_s, low_pass_s, standing_low_pass_s,
                 settle_samples, direction_low_pass_s, turning_rad_s, remains_of_friction, remains_rad_s2)
};

}  // namespace pmg::robot_diagnosis
