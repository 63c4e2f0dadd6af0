// Output of a finished fit: fit.json, report.html, and the remarks in motor.yaml.
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
#include "work/worth.hpp"

namespace pmg::calib {

/// Runs and their rollout errors.
struct Assessment {
  std::string filter;  ///< of runs.csv
  const std::vector<SingleJoint>* runs = nullptr;
  std::vector<RolloutError> before, after;  ///< per run, with the start of the fit and with its result
};

/// (runs) => the error of a joint that does nothing: it stands still at the mean of each run's readings.
RolloutError standing_still(const std::vector<SingleJoint>& runs);

/// A model explains a joint's motion if its error is below this share of a joint's that does nothing.
inline constexpr double kExplainedShare = 0.5;

struct FitResults {
  const bench::Bench* bench = nullptr;
  const FitProblem* problem = nullptr;
  Fit fit;
  std::vector<Confidence> confidence;  ///< in the order of the problem's parameters
  std::string method, joint;
  unsigned threads = 1;
  double wall_s = 0.0;
  std::optional<InverseDynamics> inverse;  ///< if the drive's output was recorded
  bool inverse_taken = false;              ///< true if the model uses it and rollouts fitted only the rest
  work::Worth data;                        ///< of the recordings, by what was looked for before the fit
  bench::NoiseFloor noise_floor;           ///< from repeats among the fitted and scored runs
  Assessment fitted;
  std::optional<Assessment> scored;  ///< runs that were used for neither fitting nor choosing
};

/// Moves the parameters that inverse dynamics determines from the unknowns into the start model: rollouts cannot
/// separate inertia from a lag of the drive's velocity, the recorded drive output can. If no unknown is left, that lag
/// becomes one. A negative estimate within its uncertainty counts as 0. A significantly negative one is impossible:
/// then nothing is taken, rollouts fit all parameters, and the result is false.
bool take_inverse_dynamics(const InverseDynamics& found, const bench::Bench& bench, JointModel& start,
                           Unknowns& unknowns);

Assessment assess(const std::string& filter, const std::vector<SingleJoint>& runs, const JointModel& before,
                  const JointModel& after, unsigned threads);

/// Interrupted; off its data, where these have faults or the model misses them by kExplainedShare of what a joint that
/// stands still misses; no better than the start; open, where a parameter isn't determined or is at its range's edge.
work::Worth worth_of(const FitResults& results);

nlohmann::ordered_json fit_json(const FitResults& results);
/// A typical run as an SVG picture: command, measured and simulated position before and after the fit, and the
/// residual.
std::string fit_picture(const FitResults& results, const JointModel& before);
pages::Page fit_report(const FitResults& results);
std::vector<std::string> motor_remarks(const FitResults& results);

/// "rad" or "mrad" for a rotary joint, "m" or "mm" for a linear axis.
std::string position_unit(const bench::Bench& bench, bool thousandths);
/// (unit of a parameter of a turning joint) => (its unit on this bench's rig): newtons and metres on a linear axis.
std::string unit_on_rig(std::string unit, const bench::Bench& bench);

/// "+- 0.003", or "?" where the runs don't tell the parameter.
std::string deviation_text(const Confidence& confidence);

/// A warning about a fitted parameter, or "".
std::string reservation(const Unknown& parameter, double value, const Confidence& confidence);

/// True if the value lies at an edge of its range: the optimum may be outside.
bool at_bound(const Unknown& parameter, double value);

}  // namespace pmg::calib
