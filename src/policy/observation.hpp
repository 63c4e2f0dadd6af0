// The observation vector of one tick, assembled by the names of the layout.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "pmg/reference.hpp"
#include "policy/observation_layout.hpp"

namespace pmg::policy {

/// Fills the vector and keeps the frames that its older terms need. Preallocated; assemble() has no heap and no
/// exception. Before enough ticks have passed the first frame stands for the older ones.
class Observation {
 public:
  explicit Observation(const model::RobotModel& robot);

  /// Forgets the history: the next frame is the first.
  void reset() noexcept { frames_ = 0; }

  /// state: what the robot reports; observed: u', or u for a baseline; last_action: the network's previous output, one
  /// a policy joint.
  const Eigen::VectorXf& assemble(const model::RobotState& state, const Reference& reference, const Command& observed,
                                  const Eigen::VectorXf& last_action) noexcept;

  const ObservationLayout& layout() const { return layout_; }

 private:
  struct Frame {
    Eigen::Vector3d gyro = Eigen::Vector3d::Zero(), gravity = Eigen::Vector3d::Zero();
    JointVector q, dq;
    Eigen::VectorXf action;
  };
  const Frame& frame(int age_ticks) const noexcept;
  void fill(const ObservationTerm& term, const Reference& reference, const Command& observed) noexcept;

  ObservationLayout layout_;
  JointVector q_stand_;
  std::array<Frame, ObservationLayout::kOldest_ticks + 1> ring_;
  std::size_t newest_ = 0;
  int frames_ = 0;
  Eigen::VectorXf vector_;
};

}  // namespace pmg::policy
