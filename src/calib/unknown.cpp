#include "calib/unknown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace pmg::calib {

namespace {

constexpr double kBend = 5.0;  // exponent of a range from 0: the first tenth of the edge covers 1/230 of it

/// A parameter of the recordings, which no actuator has.
struct OfRecordings {
  const char* name;
  double JointModel::*number;
  model::Quantity quantity;
  double lower, upper;
};

constexpr std::array kOfRecordings = {
    OfRecordings{kInertia, &JointModel::inertia_scale, model::Quantity::kFactor, 0.3, 3.0},
    OfRecordings{kGravity, &JointModel::gravity_scale, model::Quantity::kFactor, 0.3, 3.0},
    OfRecordings{kMoreInertia, &JointModel::more_inertia_kg_m2, model::Quantity::kInertia, 0.0, 0.5},
    OfRecordings{kMoreGravity, &JointModel::more_gravity_Nm, model::Quantity::kTorque, -5.0, 5.0},
    OfRecordings{kZeroSlip, &JointModel::zero_slip_rad, model::Quantity::kAngle, -0.3, 0.3},
    OfRecordings{kZeroSlipAt, &JointModel::zero_slip_at, model::Quantity::kPlace, 0.0, 1.0},
};

/// Null if it is an actuator's.
const OfRecordings* of_recordings(const std::string& name) {
  const auto found = std::ranges::find(kOfRecordings, name, &OfRecordings::name);
  return found == kOfRecordings.end() ? nullptr : &*found;
}

}  // namespace

Scale scale_of_range(double lower, double upper) {
  if (lower > 0.0 && upper / lower >= 10.0) return Scale::kLogarithmic;
  return lower == 0.0 ? Scale::kFromZero : Scale::kLinear;
}

double Unknown::coordinate(double value) const {
  const double inside = std::clamp(value, lower, upper);
  if (scale == Scale::kLogarithmic) return std::log(inside);
  return scale == Scale::kFromZero ? std::log1p(inside / upper * std::expm1(kBend)) / kBend : inside;
}

double Unknown::value(double coordinate) const {
  const double value = scale == Scale::kLogarithmic ? std::exp(coordinate)
                       : scale == Scale::kFromZero  ? upper * std::expm1(kBend * coordinate) / std::expm1(kBend)
                                                    : coordinate;
  return std::clamp(value, lower, upper);
}

double Unknown::slope(double coordinate) const { return scale == Scale::kLogarithmic ? value(coordinate) : 1.0; }

// Of a logarithmic scale by ratios, which are exact at both ends.
double Unknown::share(double value) const {
  if (scale == Scale::kLogarithmic) return std::log(std::clamp(value, lower, upper) / lower) / std::log(upper / lower);
  const double from = coordinate(lower);
  return (coordinate(value) - from) / (coordinate(upper) - from);
}

double Unknown::at_share(double share) const {
  const double inside = std::clamp(share, 0.0, 1.0), from = coordinate(lower);
  if (scale == Scale::kLogarithmic) return lower * std::pow(upper / lower, inside);
  return value(from + inside * (coordinate(upper) - from));
}

// The differences are wide: a joint that sticks one sample earlier or later must not dominate the slope. A held command
// is delayed by whole simulation steps, so a smaller difference of the delay would change nothing.
fitting::Coordinate Unknown::range(double wider) const {
  constexpr double kDelayStep_s = 2.5e-3, kLogarithmStep = 1e-2, kShareOfTypical = 5e-3;
  const double step = difference > 0.0                      ? difference
                      : quantity == model::Quantity::kDelay ? kDelayStep_s
                      : scale == Scale::kLogarithmic        ? wider * kLogarithmStep
                                                            : wider * kShareOfTypical * typical;
  return {coordinate(lower), coordinate(upper), step, expected, deviation};
}

std::ptrdiff_t place_of(const Unknowns& unknowns, const std::string& name) {
  const auto found = std::ranges::find(unknowns, name, &Unknown::name);
  return found == unknowns.end() ? -1 : found - unknowns.begin();
}

void put(Unknowns& unknowns, const Unknown& unknown) {
  const std::ptrdiff_t there = place_of(unknowns, unknown.name);
  if (there < 0)
    unknowns.push_back(unknown);
  else
    unknowns[static_cast<std::size_t>(there)] = unknown;
}

JointModel model_at(JointModel model, const Unknowns& unknowns, const Eigen::VectorXd& coordinates) {
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    set(model, unknowns[i].name, unknowns[i].value(coordinates[static_cast<Eigen::Index>(i)]));
  return model;
}

Eigen::VectorXd coordinates(const Unknowns& unknowns, const JointModel& model) {
  Eigen::VectorXd found(std::ssize(unknowns));
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    found[static_cast<Eigen::Index>(i)] = unknowns[i].coordinate(value(model, unknowns[i].name));
  return found;
}

fitting::Coordinates ranges(const Unknowns& unknowns, double wider) {
  fitting::Coordinates found;
  for (const Unknown& u : unknowns) found.push_back(u.range(wider));
  return found;
}

model::Quantity quantity(const std::string& name) {
  const OfRecordings* one = of_recordings(name);
  return one != nullptr ? one->quantity : model::actuator_parameter(name).quantity;
}

Unknown unknown(const std::string& name, const bench::Bench& bench) {
  const bool linear = bench.rig == bench::Rig::kLinear;
  if (const OfRecordings* one = of_recordings(name)) {
    const double scale = linear ? model::factor_on_linear_axis(one->quantity) : 1.0;
    return {name, one->quantity, one->lower * scale, one->upper * scale};
  }
  const model::ActuatorParameter& p = model::actuator_parameter(name);
  // A servo firmware's gain: its unit per radian of error, at a duty of 1.
  if (bench.law == bench::DriveLaw::kServoVoltage && name == "drive.kp_scale") return {name, p.quantity, 1e-4, 5.0};
  if (!linear) return {name, p.quantity, p.lower, p.upper};
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
  add_missing(names, bench.unknown);
  return names;
}

void add_missing(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& name : more) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
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
  const OfRecordings* one = of_recordings(name);
  if (one != nullptr) return model.*one->number;
  return model::actuator_parameter(name).value(model.actuator);
}

void set(JointModel& model, const std::string& name, double value) {
  if (const OfRecordings* one = of_recordings(name))
    model.*one->number = value;
  else
    model::actuator_parameter(name).in(model.actuator) = value;
}

}  // namespace pmg::calib
