// The free parameters of a joint's fit: ranges, scales, difference steps and priors.
#pragma once

#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "fitting/least_squares.hpp"

namespace pmg::calib {

/// What a coordinate is: the value x; ln x; or, of a range 0..upper, ln(1 + (e^5 - 1) x / upper) / 5, which is 0..1 and
/// nearly linear below a hundredth of the range.
enum class Scale { kLinear, kLogarithmic, kFromZero };

/// In which a step matters equally for a small servo and for a knee's drive: logarithmic if the range spans a decade
/// above 0, from zero if it starts at 0, else linear.
Scale scale_of_range(double lower, double upper);

/// What the recordings have beside their actuator: their loads' scales, what turns with every load, and where the
/// sensor's zero slipped.
constexpr const char* kInertia = "load.inertia_scale";
constexpr const char* kGravity = "load.gravity_scale";
constexpr const char* kMoreInertia = "load.more_inertia_kg_m2";
constexpr const char* kMoreGravity = "load.more_gravity_Nm";
constexpr const char* kZeroSlip = "recordings.zero_slip_rad";
constexpr const char* kZeroSlipAt = "recordings.zero_slip_at";

/// A free parameter. A fit moves its coordinate, a search over the whole range its share of the range of coordinates.
struct Unknown {
  std::string name;  ///< an actuator's ("friction.coulomb_Nm"), or one of the recordings'
  model::Quantity quantity;
  double lower, upper;
  Scale scale = Scale::kLinear;
  double typical = 1.0;  ///< a change of the value that matters
  double expected = 0.0,
         deviation = 0.0;   ///< normal prior of the coordinate, from a calibration; none if deviation is 0
  double difference = 0.0;  ///< of the coordinate, for the Jacobian's column; 0: range() chooses by its kind

  std::string unit() const { return std::string(model::unit(quantity)); }
  double coordinate(double value) const;
  double value(double coordinate) const;
  double share(double value) const;       ///< 0..1
  double at_share(double share) const;    ///< the value there
  double slope(double coordinate) const;  ///< d value / d coordinate, on a linear or logarithmic scale
  /// Bounds, difference step and prior of the coordinate. wider: of the steps of a linear or logarithmic scale, where
  /// what is compared is coarse.
  fitting::Coordinate range(double wider = 1.0) const;
  bool operator==(const Unknown&) const = default;
};
using Unknowns = std::vector<Unknown>;

/// Index of the unknown of that name, or -1.
std::ptrdiff_t place_of(const Unknowns& unknowns, const std::string& name);
/// Replaces the unknown of the same name, or adds it at the end.
void put(Unknowns& unknowns, const Unknown& unknown);

/// (model, unknowns, their coordinates) => (the model with the unknowns at these coordinates). More coordinates than
/// unknowns: those at the end are somebody else's.
JointModel model_at(JointModel model, const Unknowns& unknowns, const Eigen::VectorXd& coordinates);
/// (unknowns, model) => (their coordinates in the model, clamped into the ranges).
Eigen::VectorXd coordinates(const Unknowns& unknowns, const JointModel& model);
fitting::Coordinates ranges(const Unknowns& unknowns, double wider = 1.0);

/// (name of an actuator's or the recordings' parameter, bench) => (the parameter with its range on this rig). Throws
/// std::invalid_argument that lists the names.
Unknown unknown(const std::string& name, const bench::Bench& bench);

/// Of an actuator's or the recordings' parameter. Throws as unknown() does.
model::Quantity quantity(const std::string& name);

/// The paper's parameters (III-C.1: Kp, Kd, I) for this bench's drive law, and those that bench.yaml calls unknown.
std::vector<std::string> basic_parameters(const bench::Bench& bench);

/// The scales of the loads that bench.yaml calls unknown, of the point mass that stands for them: load.inertia_scale,
/// load.gravity_scale. One factor is for all loads: throws std::invalid_argument where some are known and others not.
std::vector<std::string> unknown_loads(const bench::Bench& bench);

/// Adds those of the names that aren't there.
void add_missing(std::vector<std::string>& names, const std::vector<std::string>& more);

double value(const JointModel& model, const std::string& name);
void set(JointModel& model, const std::string& name, double value);

}  // namespace pmg::calib
