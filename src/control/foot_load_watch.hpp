// Whether the feet carry the robot or it hangs, from what a robot can measure: the torques of its legs, and
// whether anything holds it against gravity.
#pragma once

#include "model/chain_kinematics.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "model/sole_load.hpp"
#include "pmg/types.hpp"

namespace pmg::control {

/// Shares are of the robot's weight, of both feet together: a swinging leg's inertia loads one foot and unloads the
/// other, and the sum knows less of it.
struct FootLoadOptions {
  /// The estimate below which the feet carry nothing: a tenth of the weight, and what the inertia of legs that are
  /// thrown about adds to it. With 0.10 Z1 that is lifted in mid-walk hangs after 0.42 s at the latest (20 robots),
  /// with 0.25 after 0.21 s; pushes that throw it into the air come no nearer to it.
  double lost_share = 0.25;
  double lost_s = 0.10;       ///< for so long: the robot hangs
  double found_share = 0.40;  ///< they carry more than this
  double found_s = 0.05;      ///< for so long: it stands again
  /// Specific force upwards of the IMU, of g, above which something holds the robot: below, it flies. Of pushes of
  /// 50 N s that Z1 survives some throw it into the air for 0.15 s.
  double held_share = 0.5;
  double filter_s = 0.02;  ///< time constant of the low-pass filter of the loads and of the specific force
  /// A posture in which dry friction may falsify a foot's load by more than this tells nothing: a straight knee bears
  /// weight without torque.
  double blind_share = 0.25;
};

/// What the loads of the feet say.
enum class Footing { kUnknown, kStands, kHangs };

class FootLoadWatch {
 public:
  /// Keeps no reference. Throws std::invalid_argument unless lost_share < found_share and times are above 0.
  FootLoadWatch(const model::RobotModel& robot, const FootLoadOptions& options, double dt_s);

  /// Nothing is known until the feet were seen to carry the robot, or to carry nothing.
  void start() noexcept;

  /// One tick: what the state shows of the loads while this command was in force. A state that isn't finite and whole,
  /// and a posture that tells nothing, change nothing. No heap.
  void update(const model::RobotState& state, const model::JointCommand& in_force) noexcept;

  Footing footing() const noexcept { return footing_; }
  /// Filtered; of what the measured torques mean and what the torques mean that the command asks for, the pair with the
  /// larger sum: torque readings that vanish must not take the ground from under a robot that stands.
  const PerFoot<double>& share() const noexcept;

 private:
  bool measure(const model::RobotState& state, const model::JointCommand& in_force) noexcept;
  bool can_be_judged(const model::RobotState& state, const model::JointCommand& in_force) const noexcept;

  model::SoleLoads loads_;
  model::ChainKinematics base_to_imu_link_;
  Eigen::Matrix3d R_LI_;
  FootLoadOptions options_;
  double weight_N_, filter_gain_;
  int lost_ticks_needed_, found_ticks_needed_;
  Footing footing_ = Footing::kUnknown;
  bool begun_ = false;  // the filter has a value
  int lost_ticks_ = 0, found_ticks_ = 0;
  PerFoot<double> measured_{}, asked_{};
  double held_ = 0.0;  // specific force upwards, of g
};

}  // namespace pmg::control
