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
constexpr double kBend = 5.0;            // exponent of a range from 0: the first tenth of the edge covers 1/230 of it
constexpr double kDifference = 1e-3;     // finite difference of a coordinate
constexpr const char* kInertia = "load.inertia_scale";
constexpr const char* kGravity = "load.gravity_scale";

double to_range(const FitParameter& p, double unit) {
  const double u = std::clamp(unit, 0.0, 1.0);
  if (p.lower > 0.0 && p.upper / p.lower >= 10.0) return p.lower * std::pow(p.upper / p.lower, u);
  if (p.lower == 0.0) return p.upper * std::expm1(kBend * u) / std::expm1(kBend);
  return p.lower + u * (p.upper - p.lower);
}

double to_unit(const FitParameter& p, double value) {
  const double x = std::clamp(value, p.lower, p.upper);
  if (p.lower > 0.0 && p.upper / p.lower >= 10.0) return std::log(x / p.lower) / std::log(p.upper / p.lower);
  if (p.lower == 0.0) return std::log1p(x / p.upper * std::expm1(kBend)) / kBend;
  return (x - p.lower) / (p.upper - p.lower);
}

}  // namespace

model::Quantity quantity(const std::string& name) {
  return name == kInertia || name == kGravity ? model::Quantity::kFactor : model::actuator_parameter(name).quantity;
}

FitParameter fit_parameter(const std::string& name, const bench::Bench& bench) {
  if (name == kInertia || name == kGravity) return {name, model::Quantity::kFactor, 0.3, 3.0};
  const model::ActuatorParameter& p = model::actuator_parameter(name);
  // A servo firmware's gain: its unit per radian of error, at a duty of 1.
  if (bench.law == bench::DriveLaw::kServoVoltage && name == "drive.kp_scale") return {name, p.quantity, 1e-4, 5.0};
  if (bench.rig != bench::Rig::kLinear) return {name, p.quantity, p.lower, p.upper};
  if (name == "friction.presliding_rad") return {name, p.quantity, 1e-6, 1e-3};
  const double scale = model::factor_on_linear_axis(p.quantity);
  return {name, p.quantity, p.lower * scale, p.upper * scale};
}

std::vector<std::string> basic_parameters(const bench::Bench& bench) {
  std::vector<std::string> names;
  switch (bench.law) {
    case bench::DriveLaw::kPositionPd:
      names = {"drive.kp_scale", "drive.kd_scale"};
      break;
    case bench::DriveLaw::kServoVoltage:  // its damping is the motor's back-EMF
      names = {"drive.torque_per_unit_Nm", "drive.back_emf_s_per_rad"};
      break;
    case bench::DriveLaw::kCascadePd:
    case bench::DriveLaw::kTorque:
      break;
  }
  names.emplace_back("transmission.armature_kg_m2");
  for (const std::string& name : bench.unknown) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<std::string> unknown_loads(const bench::Bench& bench) {
  std::vector<std::string> names;
  const auto add = [&](bool bench::BenchLoad::*unknown, const char* name, const char* key) {
    const auto count = static_cast<std::size_t>(std::ranges::count_if(bench.loads, unknown));
    if (count == 0) return;
    if (count < bench.loads.size()) {
      throw std::invalid_argument(
          fmt::format("{}: {} is unknown of {} of {} loads; expected all or none, as one factor is fitted for all",
                      (bench.folder / "bench.yaml").string(), key, count, bench.loads.size()));
    }
    names.emplace_back(name);
  };
  add(&bench::BenchLoad::inertia_unknown, kInertia, "inertia_kg_m2");
  add(&bench::BenchLoad::gravity_unknown, kGravity, "gravity_Nm");
  return names;
}

double value(const JointModel& model, const std::string& name) {
  if (name == kInertia) return model.inertia_scale;
  if (name == kGravity) return model.gravity_scale;
  return model::actuator_parameter(name).value(model.actuator);
}

void set(JointModel& model, const std::string& name, double value) {
  if (name == kInertia)
    model.inertia_scale = value;
  else if (name == kGravity)
    model.gravity_scale = value;
  else
    model::actuator_parameter(name).in(model.actuator) = value;
}

FitProblem::FitProblem(std::vector<FitParameter> parameters, JointModel start, std::vector<SingleJoint> runs)
    : parameters_(std::move(parameters)), start_(start), runs_(std::move(runs)) {
  if (parameters_.empty()) throw std::invalid_argument("nothing to fit; expected at least one parameter");
  if (runs_.empty()) throw std::invalid_argument("nothing to fit to; expected at least one run");
  for (const FitParameter& p : parameters_) {
    if (!(p.lower < p.upper)) {
      throw std::invalid_argument(
          fmt::format("{}: range from {} to {}; expected one that grows", p.name, p.lower, p.upper));
    }
  }
}

JointModel FitProblem::model_at(std::span<const double> point) const {
  JointModel model = start_;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    set(model, parameters_[i].name, to_range(parameters_[i], point[i]));
  return model;
}

std::vector<double> FitProblem::point_of(const JointModel& model) const {
  std::vector<double> point;
  for (const FitParameter& p : parameters_) point.push_back(to_unit(p, value(model, p.name)));
  return point;
}

std::vector<double> FitProblem::with_torques_scaled(std::span<const double> point, double factor) const {
  const auto fitted = [&](const char* name) {
    return std::any_of(parameters_.begin(), parameters_.end(), [&](const FitParameter& p) { return p.name == name; });
  };
  const bool gains_are_torques = !fitted("drive.torque_per_unit_Nm");  // a voltage servo's gains are in firmware units
  std::vector<double> scaled(point.begin(), point.end());
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const FitParameter& p = parameters_[i];
    const bool gain = p.name == "drive.kp_scale" || p.name == "drive.kd_scale";
    if (!(model::follows_torque(p.quantity) || (gain && gains_are_torques))) continue;
    scaled[i] = to_unit(p, factor * to_range(p, point[i]));
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
