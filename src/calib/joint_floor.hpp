// The noise floor of a diagnosis, the runs that are odd, and the integrator's share in the floor.
#pragma once

#include <string>
#include <vector>

#include "bench/odd_runs.hpp"
#include "calib/single_joint.hpp"

namespace pmg::calib {

/// Lower bounds of a model's error, mean absolute and root mean square.
struct JointFloor {
  double mean_absolute_rad = 0.0, rms_rad = 0.0;
  bool from_repeats = false;
  std::string how;  ///< one line for people: the number of repeated pairs, or the other method of estimation
  std::vector<bench::OddRun> odd_runs{};
};

/// From the bench's repeats; without repeats, from the sensor noise of the fitted runs.
JointFloor joint_floor(const bench::Bench& bench, const std::vector<SingleJoint>& fitted,
                       const bench::OddRunOptions& options);

/// Takes the odd runs that are left out from the fitted ones. If no run would be left, all stay, and the floor says so.
void leave_out_odd_runs(JointFloor& floor, std::vector<SingleJoint>& fitted);

/// (floor, rms error of the integrator) => (floor of a simulation that makes this error beside the noise): the squares
/// add.
JointFloor with_integration_error(JointFloor floor, double error_rms_rad);

/// One line for the first lines of a report: the odd runs, and which of them are left out; "" without any.
std::string odd_runs_text(const std::vector<bench::OddRun>& odd_runs);

}  // namespace pmg::calib
