#include "calib/rollout_residuals.hpp"

#include <stdexcept>

#include "work/parallel.hpp"

namespace pmg::calib {

Eigen::VectorXd run_residual(const SingleJoint& run, const JointModel& model, Counted counted) {
  const bench::Recording& r = run.run().recording;
  const bool all = counted == Counted::kRead || r.enabled.empty();
  const std::vector<double> reading_rad = run.rollout(model);
  Eigen::VectorXd found(std::ssize(reading_rad));
  for (std::size_t k = 0; k < reading_rad.size(); ++k) {
    const bool counts = r.valid[k] && (all || r.enabled[k]);
    found[static_cast<Eigen::Index>(k)] = counts ? reading_rad[k] - r.q_rad[k] : 0.0;
  }
  return found;
}

fitting::Residuals residuals(const std::function<JointModel(std::size_t run)>& model,
                             const std::vector<SingleJoint>& runs, unsigned threads, Counted counted) {
  fitting::Residuals found(runs.size());
  try {
    work::for_each_in_parallel(runs.size(), threads,
                               [&](std::size_t i) { found[i] = run_residual(runs[i], model(i), counted); });
  } catch (const std::invalid_argument&) {
    return {};
  }
  return found;
}

fitting::Residuals residuals(const JointModel& model, const std::vector<SingleJoint>& runs, unsigned threads) {
  return residuals([&](std::size_t) { return model; }, runs, threads, Counted::kRead);
}

fitting::Blocks blocks(const std::vector<SingleJoint>& runs) {
  fitting::Blocks found;
  for (const SingleJoint& joint : runs) found.add_run(joint.run().recording.t_s, joint.run().recording.valid);
  return found;
}

}  // namespace pmg::calib
