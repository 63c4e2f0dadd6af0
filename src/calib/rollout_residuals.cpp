#include "calib/rollout_residuals.hpp"

#include <stdexcept>

#include "work/parallel.hpp"

namespace pmg::calib {

fitting::Residuals residuals(const JointModel& model, const std::vector<SingleJoint>& runs, unsigned threads) {
  fitting::Residuals found(runs.size());
  try {
    work::for_each_in_parallel(runs.size(), threads, [&](std::size_t i) {
      const bench::Recording& r = runs[i].run().recording;
      const std::vector<double> reading_rad = runs[i].rollout(model);
      found[i].resize(static_cast<Eigen::Index>(reading_rad.size()));
      for (std::size_t k = 0; k < reading_rad.size(); ++k)
        found[i][static_cast<Eigen::Index>(k)] = r.valid[k] ? reading_rad[k] - r.q_rad[k] : 0.0;
    });
  } catch (const std::invalid_argument&) {
    return {};
  }
  return found;
}

fitting::Blocks blocks(const std::vector<SingleJoint>& runs) {
  fitting::Blocks found;
  for (const SingleJoint& joint : runs) found.add_run(joint.run().recording.t_s, joint.run().recording.valid);
  return found;
}

}  // namespace pmg::calib
