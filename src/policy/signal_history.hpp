// The observation of another project's policy: signals of this and older frames, as its descriptor orders them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "model/robot_io.hpp"
#include "pmg/command.hpp"
#include "policy/policy_descriptor.hpp"

namespace pmg::policy {

/// Preallocated; assemble() uses no heap and throws nothing. Until enough frames have passed, the first replaces older
/// ones.
class SignalHistory {
 public:
  SignalHistory(const PolicyDescriptor& descriptor, const model::RobotModel& robot);

  /// Forgets the history; the next frame counts as the first, and the clock begins again.
  void reset() noexcept { frames_ = moving_frames_ = 0; }

  /// (state, command, last action in the network's unit) => (observation), once an inference.
  const Eigen::VectorXf& assemble(const model::RobotState& state, const Command& command,
                                  const Eigen::VectorXf& last_action) noexcept;

 private:
  /// The frames of one term.
  struct Track {
    SignalTerm term;
    Eigen::MatrixXf ring;  ///< a column a frame
    int offset = 0;        ///< in the vector, of the frame that comes first
    int stride = 0;        ///< from a frame to the next in the vector
  };
  double phase_cycle(const StepClock& clock, double offset_cycle) const noexcept;
  const Eigen::VectorXd& measured(const SignalTerm& term, const model::RobotState& state, const Command& command,
                                  const Eigen::VectorXf& last_action) noexcept;

  std::vector<int> joints_;
  std::vector<double> default_rad_;
  Eigen::Matrix3d R_BI_;
  bool oldest_first_;
  double period_s_;
  std::vector<Track> tracks_;
  std::int64_t frames_ = 0, moving_frames_ = 0;  ///< since the reset; since a velocity was asked for
  Eigen::VectorXd measured_;                     ///< of the term at hand; room for the largest
  Eigen::VectorXf vector_;
};

}  // namespace pmg::policy
