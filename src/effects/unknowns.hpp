// The free parameters of a diagnosis fit: their ranges, and what a bench's motion makes usual.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "calib/unknown.hpp"

namespace pmg::effects {

/// Typical torque, speed, inertia and range of a bench's runs. They scale ranges, start values and difference steps.
struct BenchScale {
  double torque_Nm = 1.0;       ///< rms of the nominal drive torque at the recorded positions
  double torque_peak_Nm = 1.0;  ///< its 99 % quantile
  double speed_rad_s = 1.0;     ///< 98 % quantile of the recorded speeds
  double inertia_kg_m2 = 0.01;  ///< median over runs of load and rotor inertia
  double position_low_rad = 0.0, position_high_rad = 0.0;  ///< 1 % and 99 % quantiles
  double quantum_rad = 0.0;                                ///< all readings are multiples of it; 0 for a fine sensor
  double output = 1.0;                                     ///< torque_Nm in the unit of the drive's output
  double duration_s = 1.0;                                 ///< of the longest run
  bool bus_recorded = false, temperature_recorded = false;
  bool switches_off = false;   ///< the drive is off in some samples
  std::size_t recordings = 1;  ///< that are fitted
  bool several_loads = false;  ///< of different inertias
  bench::DriveLaw law = bench::DriveLaw::kPositionPd;
};

BenchScale scale_of(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                    const calib::JointModel& model);

/// What a bench's motion makes usual for a quantity.
struct Usual {
  double typical = 0.0;  ///< a change that matters
  double start = 1.0;    ///< the unit of the catalogue's start values
  double highest = -std::numeric_limits<double>::infinity(),
         lowest = std::numeric_limits<double>::infinity();  ///< a search reaches them at least
};
Usual usual(model::Quantity quantity, const BenchScale& scale);

/// (parameter name, bench, scale) => (unknown with its whole plausible range on this bench).
calib::Unknown unknown(const std::string& name, const bench::Bench& bench, const BenchScale& scale);

/// Order of a wave with one period over the range of motion [1/turn].
double lowest_order(const BenchScale& scale);

/// True for the orders of waves over the joint's angle.
bool is_order(const std::string& parameter);

/// True for parameters that a fit keeps at their start value, because rollouts are not smooth in them: the period of a
/// sample-and-hold, a sensor's quantum, and between which recordings its zero slipped.
bool is_jagged(const std::string& parameter);

}  // namespace pmg::effects
