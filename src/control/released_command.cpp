#include "control/released_command.hpp"

namespace pmg::control {

void release_command(const model::RobotState& state, const JointVector* brake_kd_Nm_s_per_rad,
                     model::JointCommand& command) noexcept {
  // The drives multiply the position by zero; but zero times NaN is NaN, so a broken measurement must not pass through.
  const Eigen::Index joints = command.dq.size();
  if (state.q.size() == joints && state.q.allFinite()) {
    command.q = state.q;
  } else {
    command.q.setZero(joints);  // a policy may have left it with another size
  }
  command.dq.setZero();
  command.kp.setZero();
  if (brake_kd_Nm_s_per_rad != nullptr) {
    command.kd = *brake_kd_Nm_s_per_rad;
  } else {
    command.kd.setZero();
  }
  command.tau_ff.setZero();
}

}  // namespace pmg::control
