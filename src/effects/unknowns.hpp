// What a fit of the diagnosis may change, how far, and where it begins to look.
#pragma once

#include <string>
#include <vector>

#include "calib/fit_problem.hpp"
#include "effects/catalogue.hpp"

namespace pmg::effects {

/// How strongly and how fast a bench was moved: the yardsticks for friction, limits and steps of differences.
struct BenchScale {
  double torque_Nm = 1.0;       ///< root mean square of what the drive wished, from recorded positions
  double torque_peak_Nm = 1.0;  ///< 99 % are below
  double speed_rad_s = 1.0;     ///< 98 % of the recorded speeds are below
  double inertia_kg_m2 = 0.01;  ///< median of the loads with the rotor
  double position_low_rad = 0.0, position_high_rad = 0.0;
  double quantum_rad = 0.0;  ///< the readings are multiples of it; 0 where they aren't
  bool bus_recorded = false;
};

BenchScale scale_of(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                    const calib::JointModel& model);

/// A parameter of a fit. Fits move it along its coordinate: the value, or its logarithm.
struct Unknown : calib::FitParameter {
  bool logarithmic = false;
  double typical = 1.0;                    ///< a change of it that matters
  double expected = 0.0, deviation = 0.0;  ///< what a calibration says of its coordinate; nothing where deviation is 0

  double coordinate(double value) const;
  double value(double coordinate) const;
  fitting::Coordinate range() const;  ///< its coordinate's
  bool operator==(const Unknown&) const = default;
};

/// Over the whole range in which it makes sense on this bench.
Unknown unknown(const std::string& name, const bench::Bench& bench, const BenchScale& scale);

/// Values of the effect's parameters from which fits begin, in their order; current: the model that is extended.
std::vector<std::vector<double>> starts(const Effect& effect, const calib::JointModel& current,
                                        const BenchScale& scale);

/// Units that don't change by a fit of their neighbourhood: an order of cogging, the period of a loop.
bool is_jagged(const std::string& parameter);

}  // namespace pmg::effects
