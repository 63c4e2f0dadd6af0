#include "calib/fit_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "calib/joint_runs.hpp"
#include "calib/rollout_residuals.hpp"
#include "work/parallel.hpp"

namespace pmg::calib {

namespace {

constexpr double kSenseless_rad2 = 1e6;  // loss of an invalid model, above all real ones
constexpr double kDifference = 1e-3;     // finite difference of a coordinate

}  // namespace

FitProblem::FitProblem(Unknowns parameters, JointModel start, std::vector<SingleJoint> runs)
    : parameters_(std::move(parameters)), start_(start), runs_(std::move(runs)) {
  if (parameters_.empty()) throw std::invalid_argument("nothing to fit; expected at least one parameter");
  if (runs_.empty()) throw std::invalid_argument("nothing to fit to; expected at least one run");
  for (Unknown& p : parameters_) {
    if (!(p.lower < p.upper)) {
      throw std::invalid_argument(
          fmt::format("{}: range from {} to {}; expected one that grows", p.name, p.lower, p.upper));
    }
    p.scale = scale_of_range(p.lower, p.upper);
  }
}

JointModel FitProblem::model_at(std::span<const double> point) const {
  JointModel model = start_;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    set(model, parameters_[i].name, parameters_[i].at_share(point[i]));
  return model;
}

std::vector<double> FitProblem::point_of(const JointModel& model) const {
  std::vector<double> point;
  for (const Unknown& p : parameters_) point.push_back(p.share(value(model, p.name)));
  return point;
}

std::vector<double> FitProblem::with_torques_scaled(std::span<const double> point, double factor) const {
  const bool gains_are_torques =
      place_of(parameters_, "drive.torque_per_unit_Nm") < 0;  // a voltage servo's gains are in firmware units
  std::vector<double> scaled(point.begin(), point.end());
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const Unknown& p = parameters_[i];
    const bool gain = p.name == "drive.kp_scale" || p.name == "drive.kd_scale";
    if (!(model::follows_torque(p.quantity) || (gain && gains_are_torques))) continue;
    scaled[i] = p.share(factor * p.at_share(point[i]));
  }
  return scaled;
}

double FitProblem::loss(std::span<const double> point, unsigned threads) const {
  try {
    return std::min(total(errors(model_at(point), runs_, threads)).mean_square_rad2(), kSenseless_rad2);
  } catch (const std::invalid_argument&) {  // the actuator model refuses the combination
    return kSenseless_rad2;
  }
}

void FitProblem::expect_simulated(std::span<const double> point) const { runs_.front().rollout(model_at(point)); }

fitting::Problem FitProblem::least_squares(unsigned threads) const {
  fitting::Problem problem;
  problem.residuals = [this, threads](const Eigen::VectorXd& point) {
    return residuals(model_at({point.data(), static_cast<std::size_t>(point.size())}), runs_, threads);
  };
  problem.coordinates.assign(dimensions(), {.lower = 0.0, .upper = 1.0, .step = kDifference});
  problem.differences = fitting::Differences::kCentral;
  return problem;
}

FitProblem FitProblem::thinned(std::size_t most_runs) const { return {parameters_, start_, spread(runs_, most_runs)}; }

std::vector<RolloutError> errors(const JointModel& model, const std::vector<SingleJoint>& runs, unsigned threads) {
  std::vector<RolloutError> found(runs.size());
  work::for_each_in_parallel(runs.size(), threads, [&](std::size_t i) { found[i] = runs[i].error(model); });
  return found;
}

RolloutError total(const std::vector<RolloutError>& errors) {
  RolloutError sum;
  for (const RolloutError& error : errors) {
    sum.sum_of_squares_rad2 += error.sum_of_squares_rad2;
    sum.sum_of_absolutes_rad += error.sum_of_absolutes_rad;
    sum.samples += error.samples;
  }
  return sum;
}

}  // namespace pmg::calib
