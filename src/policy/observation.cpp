#include "policy/observation.hpp"

#include <algorithm>

namespace pmg::policy {

Observation::Observation(const model::RobotModel& robot) : layout_(robot), q_stand_(robot.q_stand()) {
  for (Frame& frame : ring_) frame.action.setZero(static_cast<Eigen::Index>(layout_.action_joints().size()));
  vector_.setZero(layout_.size());
}

const Eigen::VectorXf& Observation::assemble(const model::RobotState& state, const Reference& reference,
                                             const Command& observed, const Eigen::VectorXf& last_action) noexcept {
  newest_ = (newest_ + 1) % ring_.size();
  ring_[newest_].state = state;
  ring_[newest_].action = last_action;
  frames_ = std::min(frames_ + 1, static_cast<int>(ring_.size()));
  for (const ObservationTerm& term : layout_.terms()) {
    const Quantity& quantity = *term.quantity;
    const Seen seen{frame(term.age_ticks), reference, observed};
    for (int i = 0; i < term.size(); ++i) {
      const int index = term.index[static_cast<std::size_t>(i)];
      const double origin = quantity.from_stand ? q_stand_[index] : 0.0;
      vector_[term.offset + i] = static_cast<float>(quantity.scale * (quantity.value(seen, index) - origin));
    }
  }
  return vector_;
}

const Frame& Observation::frame(int age_ticks) const noexcept {
  const auto age = static_cast<std::size_t>(std::min(age_ticks, frames_ - 1));
  return ring_[(newest_ + ring_.size() - age) % ring_.size()];
}

}  // namespace pmg::policy
