// A finished fit for people and machines: fit.json, report.html, and the remarks of motor.yaml.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/noise_floor.hpp"
#include "calib/fit_confidence.hpp"
#include "calib/inverse_dynamics.hpp"
#include "calib/motor_fit.hpp"
#include "pages/page.hpp"

namespace pmg::calib {

/// Runs and what a model makes of them.
struct Assessment {
  std::string filter;  ///< of runs.csv
  const std::vector<SingleJoint>* runs = nullptr;
  std::vector<RolloutError> before, after;  ///< a run each: the start of the fit, its result
};

struct FitResults {
  const bench::Bench* bench = nullptr;
  const FitProblem* problem = nullptr;
  Fit fit;
  std::vector<Confidence> confidence;  ///< in the order of the problem's parameters
  std::string method, joint;
  unsigned threads = 1;
  double wall_s = 0.0;
  std::optional<InverseDynamics> inverse;  ///< where the drive was recorded
  bool inverse_taken = false;              ///< and then the model has it, and rollouts found the rest
  bench::NoiseFloor noise_floor;           ///< of fitted and scored runs that repeat each other
  Assessment fitted;
  std::optional<Assessment> scored;  ///< runs that were used for neither fitting nor choosing
};

/// What inverse dynamics determines becomes the model's own and is looked for no longer: a rollout can't tell inertia
/// from a lag of the drive's velocity, the recorded drive can. Where nothing is left to look for, that lag is. A number
/// below zero by less than its uncertainty is taken as zero; where one is impossible nothing is taken, rollouts look
/// for all of it, and the result is false.
bool take_inverse_dynamics(const InverseDynamics& found, const bench::Bench& bench, JointModel& start,
                           std::vector<FitParameter>& unknowns);

Assessment assess(const std::string& filter, const std::vector<SingleJoint>& runs, const JointModel& before,
                  const JointModel& after, unsigned threads);

nlohmann::ordered_json fit_json(const FitResults& results);
/// The usual run as an SVG file: command, measured and simulated position, before the fit and after, and the miss.
std::string fit_picture(const FitResults& results, const JointModel& before);
pages::Page fit_report(const FitResults& results);
std::vector<std::string> motor_remarks(const FitResults& results);

/// "rad" and "mrad" of a turning joint, "m" and "mm" of a linear axis.
std::string position_unit(const bench::Bench& bench, bool thousandths);

/// What speaks against taking a parameter at its word, or "".
std::string reservation(const FitParameter& parameter, double value, const Confidence& confidence);

/// At the edge of its range: what the fit would like to be is beyond.
bool at_bound(const FitParameter& parameter, double value);

}  // namespace pmg::calib
