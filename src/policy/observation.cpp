#include "policy/observation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pmg::policy {

Observation::Observation(const model::RobotModel& robot) : layout_(robot), q_stand_(robot.q_stand()) {
  const auto actions = static_cast<Eigen::Index>(layout_.action_joints().size());
  for (Frame& frame : ring_) {
    frame.q = q_stand_;
    frame.dq.setZero(q_stand_.size());
    frame.action.setZero(actions);
  }
  vector_.setZero(layout_.size());
}

const Eigen::VectorXf& Observation::assemble(const model::RobotState& state, const Reference& reference,
                                             const Command& observed, const Eigen::VectorXf& last_action) noexcept {
  newest_ = (newest_ + 1) % ring_.size();
  Frame& now = ring_[newest_];
  now.gyro = state.gyro_rad_s;
  now.gravity = state.orientation_WI.conjugate() * Eigen::Vector3d(0.0, 0.0, -1.0);
  now.q = state.q;
  now.dq = state.dq;
  now.action = last_action;
  frames_ = std::min(frames_ + 1, static_cast<int>(ring_.size()));
  for (const ObservationTerm& term : layout_.terms()) fill(term, reference, observed);
  return vector_;
}

const Observation::Frame& Observation::frame(int age_ticks) const noexcept {
  const auto age = static_cast<std::size_t>(std::min(age_ticks, frames_ - 1));
  return ring_[(newest_ + ring_.size() - age) % ring_.size()];
}

void Observation::fill(const ObservationTerm& term, const Reference& reference, const Command& observed) noexcept {
  const Frame& seen = frame(term.age_ticks);
  const auto put = [&](int element, double value) {
    vector_[term.offset + element] = static_cast<float>(term.scale * value);
  };
  const auto put_joints = [&](const JointVector& values, bool from_stand) {
    for (int i = 0; i < term.size; ++i) {
      const int joint = term.joint[static_cast<std::size_t>(i)];
      put(i, values[joint] - (from_stand ? q_stand_[joint] : 0.0));
    }
  };
  const double angle = 2.0 * std::numbers::pi * reference.phase;
  switch (term.quantity) {
    case Quantity::kGyro:
      for (int i = 0; i < term.size; ++i) put(i, seen.gyro[i]);
      break;
    case Quantity::kGravityDirection:
      for (int i = 0; i < term.size; ++i) put(i, seen.gravity[i]);
      break;
    case Quantity::kCommand:
      for (int i = 0; i < term.size; ++i) put(i, observed.u[static_cast<std::size_t>(i)]);
      break;
    case Quantity::kUserCommand:
      for (int i = 0; i < term.size; ++i) put(i, reference.command.u[static_cast<std::size_t>(i)]);
      break;
    case Quantity::kPhase:
      put(0, reference.gain * std::sin(angle));
      put(1, reference.gain * std::cos(angle));
      put(2, reference.gain);
      break;
    case Quantity::kReferencePosition:
      put_joints(reference.q, true);
      break;
    case Quantity::kReferenceVelocity:
      put_joints(reference.dq, false);
      break;
    case Quantity::kJointPosition:
      put_joints(seen.q, true);
      break;
    case Quantity::kJointVelocity:
      put_joints(seen.dq, false);
      break;
    case Quantity::kLastAction:
      for (int i = 0; i < term.size; ++i) put(i, static_cast<double>(seen.action[i]));
      break;
  }
}

}  // namespace pmg::policy
