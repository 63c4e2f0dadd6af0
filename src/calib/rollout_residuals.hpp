// Residuals of a joint's rollouts.
#pragma once

#include <functional>
#include <vector>

#include "calib/single_joint.hpp"
#include "fitting/blocks.hpp"

namespace pmg::calib {

/// The samples that count: where the sensor gave a reading; or of these where the drive is on, as a free swing
/// magnifies every error.
enum class Counted { kRead, kDriven };

/// (run, model) => (simulated minus measured reading [rad]; 0 where a sample doesn't count). Throws
/// std::invalid_argument where the actuator model refuses the parameters.
Eigen::VectorXd run_residual(const SingleJoint& run, const JointModel& model, Counted counted = Counted::kRead);

/// (model of each run, by its index) => (residual of each run). Empty where the actuator model refuses the parameters.
/// Does not depend on the number of threads.
fitting::Residuals residuals(const std::function<JointModel(std::size_t run)>& model,
                             const std::vector<SingleJoint>& runs, unsigned threads, Counted counted);
/// One model of all runs.
fitting::Residuals residuals(const JointModel& model, const std::vector<SingleJoint>& runs, unsigned threads);

fitting::Blocks blocks(const std::vector<SingleJoint>& runs);

}  // namespace pmg::calib
