// The observation vector of one tick, assembled in the layout's order.
#pragma once

#include <Eigen/Core>
#include <array>

#include "policy/observation_layout.hpp"

namespace pmg::policy {

/// Fills the vector and keeps the frames of its older terms. Preallocated; assemble() uses no heap and throws nothing.
/// Until enough ticks have passed, the first frame replaces older ones.
class Observation {
 public:
  explicit Observation(const model::RobotModel& robot);

  /// Forgets the history; the next frame counts as the first.
  void reset() noexcept { frames_ = 0; }

  /// (state, reference, observed command, last action) => (observation). observed: u', or u for a baseline.
  /// last_action: the network's previous output, one per policy joint.
  const Eigen::VectorXf& assemble(const model::RobotState& state, const Reference& reference, const Command& observed,
                                  const Eigen::VectorXf& last_action) noexcept;

  const ObservationLayout& layout() const { return layout_; }

 private:
  const Frame& frame(int age_ticks) const noexcept;

  ObservationLayout layout_;
  JointVector q_stand_;
  std::array<Frame, ObservationLayout::kOldest_ticks + 1> ring_;
  std::size_t newest_ = 0;
  int frames_ = 0;
  Eigen::VectorXf vector_;
};

}  // namespace pmg::policy
