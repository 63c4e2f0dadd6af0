// What the model that fits all runs says of a correction of one run.
#pragma once

#include <string>
#include <vector>

#include "data_faults/examined.hpp"

namespace pmg::data_faults {

/// One explanation of a run, and by how much it lowers ln of the run's error.
struct Explained {
  DataFault fault;
  double gain = 0.0;
  bool sure = false;  ///< by the thresholds
};

/// The sure explanation with the largest gain; empty if there is none.
std::vector<DataFault> clearest(const std::vector<Explained>& explanations);

/// ln of the error of a model in which the joint rests at the mean of its readings.
double log_error_standing_still(const calib::SingleJoint& joint);

/// True if a correction that takes ln of this run's error from `before` to `after` makes the run a usual one, or
/// divides the error by more than `overwhelming_gain`. Never of a run that is missed by less than repeats differ, nor
/// with a model that does not explain how the joint moves: whatever makes it rest explains a joint that sticks.
bool mends(const Examined& examined, std::size_t run, double before, double after);

/// ln of the corrected run's error, by the model that fits all runs.
double log_error_with(const Examined& examined, std::size_t run, const bench::Correction& fix);

/// A sentence with the run's errors before and after a correction; given as their logarithms.
std::string gain_text(const Examined& examined, double before, double after);

/// The same gains and load.
bool same_condition(const bench::BenchRun& a, const bench::BenchRun& b);

/// The other runs of its trajectory, gains and load.
std::vector<std::size_t> repeats_of(const Examined& examined, std::size_t run);

/// Runs that physics treats like this one: its repeats; without repeats, the runs of its trajectory; else all others.
std::vector<std::size_t> siblings(const Examined& examined, std::size_t run);

}  // namespace pmg::data_faults
