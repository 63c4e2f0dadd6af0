// Residuals of a joint's rollouts.
#pragma once

#include <vector>

#include "calib/single_joint.hpp"
#include "fitting/blocks.hpp"

namespace pmg::calib {

/// (model, runs) => (simulated minus measured reading of each run [rad]; 0 where the sensor dropped out). Empty where
/// the actuator model refuses the parameters. Does not depend on the number of threads.
fitting::Residuals residuals(const JointModel& model, const std::vector<SingleJoint>& runs, unsigned threads);

fitting::Blocks blocks(const std::vector<SingleJoint>& runs);

}  // namespace pmg::calib
