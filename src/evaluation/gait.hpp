// Human likeness of steady walking: joint angles and foot contacts over the cycle, beside published means.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "evaluation/gait_norms.hpp"
#include "generator/joint_roles.hpp"
#include "pages/page.hpp"

namespace pmg::evaluation {

inline constexpr double kAskedCorrelation = 0.9, kAskedDutyDifference = 0.05;
/// RMS difference from the published mean, in standard deviations between persons: of 20 people 19 are as near.
inline constexpr double kAskedDeviations = 2.0;
/// Foot off at 62 % of the cycle (standard deviation 2 %) at a dimensionless speed of 0.29, which is 0.8 m/s for legs
/// of 0.8 m: M. Schwartz, A. Rozumalski, J. Trost, J. Biomech. 41:1639-1650, 2008.
inline constexpr double kPublishedDutyFactor = 0.62;

/// The recording of one foot, one value per control tick.
struct FootRecording {
  std::vector<bool> loaded;
  std::vector<double> since_planned_contact;  ///< cycles since the reference's initial contact, in [-0.5, 0.5)
  std::array<std::vector<double>, kGaitJoints> measured_deg, reference_deg;
};

/// Flexions [deg] of thigh, knee and ankle; positive as in gait analysis. The thigh's is against the vertical, as the
/// norms': the hip joint's less the pelvis' forward pitch.
std::array<double, kGaitJoints> flexions_deg(const JointVector& q, const std::array<int, generator::kLegJoints>& leg,
                                             double pelvis_pitch_rad);

/// Ticks at which the foot comes down after at least 0.1 s in the air.
std::vector<std::size_t> initial_contacts(const std::vector<bool>& loaded, double dt_s);

/// Mean over whole cycles at kCyclePoints; each cycle is stretched from one contact to the next. Needs two contacts.
std::vector<double> mean_cycle(const std::vector<double>& values, const std::vector<std::size_t>& contacts);

/// (phase, middle and share of a foot's planned stance) => cycles since its planned initial contact, in [-0.5, 0.5).
double cycles_since_contact(double phase, double contact_center, double duty_factor);

/// Mean of `values` at the ticks `contacts`.
double mean_at(const std::vector<double>& values, const std::vector<std::size_t>& contacts);

struct CurveAgreement {
  double correlation = 0.0;
  double rms_deg = 0.0;
  double shape_rms_deg = 0.0;  ///< RMS after both means are subtracted
  /// Correlation and RMS differences of two curves of equal length.
};
CurveAgreement agreement(const std::vector<double>& ours, const std::vector<double>& published);

struct FootGait {
  int cycles = 0;
  double period_s = 0.0, duty_factor = 0.0;
  /// Mean contact after (+) or before (-) the reference's, as a share of the cycle. Both curves begin at the measured
  /// contact, so that a foot which lands early also takes the reference off the published curves.
  double contact_late = 0.0;
  std::array<std::vector<double>, kGaitJoints> measured_deg, reference_deg;  ///< means over cycles
  std::array<CurveAgreement, kGaitJoints> measured, reference;               ///< against the published curves
};

struct GaitTest {
  std::string robot;
  Case evaluated;
  double speed_m_s = 0.8, steady_s = 20.0;
  GaitNorms norms;
  TrialResult trial;
  double walked_m_s = 0.0;  ///< measured mean speed
  double reference_duty_factor = 0.0;
  PerFoot<FootGait> feet;

  bool duty_reached(Foot foot) const;
  /// The largest RMS difference of a joint from its published mean that counts as a person's [deg].
  double rms_limit_deg(std::size_t joint) const { return kAskedDeviations * norms.deviation_deg[joint]; }
};

/// Uses robot seed 1. Throws std::runtime_error if the robot does not make two steps with each foot, work::Interrupted
/// if it could not make them in time.
void run_gait(GaitTest& test, const Supervision& supervision);

/// Interrupted; missed by a fall, a shape (correlation), an angle (RMS with its offset) or a duty factor.
work::Worth worth_of(const GaitTest& test);
nlohmann::ordered_json to_json(const GaitTest& test);
pages::Page page_of(const GaitTest& test);
std::vector<pages::Table> tables_of(const GaitTest& test);

}  // namespace pmg::evaluation
