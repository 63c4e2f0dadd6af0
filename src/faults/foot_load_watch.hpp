// Judges whether the feet carry the robot or the robot hangs. Inputs are the torques of its legs and the specific force
// at its IMU.
#pragma once

#include "model/chain_kinematics.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "model/sole_load.hpp"
#include "pmg/types.hpp"

namespace pmg::faults {

/// A share is the sum of both feet's loads over the robot's weight. The inertia of a swinging leg loads one foot and
/// unloads the other; their sum shows less of this disturbance.
struct FootLoadOptions {
  /// Below this share the feet carry nothing: a tenth of the weight, plus a margin for the inertia of moving legs.
  /// Measured on 20 simulated robots that are lifted in mid-walk: with 0.10 the watch detects hanging after 0.42 s at
  /// the latest, with 0.25 after 0.21 s. Pushes that throw Z1 into the air come no nearer to the limit.
  double lost_share = 0.25;
  double lost_s = 0.11;       ///< below lost_share for so long: the robot hangs
  double found_share = 0.40;  ///< above this share the feet carry the robot
  double found_s = 0.05;      ///< above found_share for so long: the robot stands again
  /// Legs of a walking robot that is lifted are thrown about, and look as if they carried now and then. So while it
  /// walks its share of the weight is averaged, too: by a low-pass of walking_s, in which a share below
  /// least_walking_share counts as that, and which stands still in free fall. Below lost_walking_share it hangs.
  /// Simulated robots that walk fall to 0.72 at the least, with knees of 4 to 10 degrees.
  double lost_walking_share = 0.69, least_walking_share = 0.30, walking_s = 0.25;
  /// Upward specific force at the IMU, in g. Above it something holds the robot; below it the robot flies. Some pushes
  /// of 50 N s that Z1 survives throw it into the air for 0.15 s.
  double held_share = 0.5;
  double filter_s = 0.02;  ///< time constant of the specific force's low-pass filter, and the loads' shortest
  /// Sudden changes of a foot's load that the filter follows: standard deviation of the change within 1 s [share]. A
  /// load whose error is large beside it is filtered the longer.
  double change_per_sqrt_s = 1.0;
  double wrong_inertia_share = 0.35;  ///< of the inertia torques of joints that accelerate: how much may be wrong
  double acceleration_s = 0.05;       ///< over such a time the acceleration of joints is taken (root mean square)
  /// Nothing is judged while the standard error of both loads together is larger. Example: a straight knee bears weight
  /// without torque.
  double blind_share = 0.5;
};

/// The verdict on the feet's loads.
enum class Footing { kUnknown, kStands, kHangs };

class FootLoadWatch {
 public:
  /// Keeps no reference. Throws std::invalid_argument unless lost_share < found_share and times are above 0.
  FootLoadWatch(const model::RobotModel& robot, const FootLoadOptions& options, double dt_s);

  /// Begins anew: the footing is unknown until the loads pass one of the two limits.
  void start() noexcept;

  /// (state, command in force, whether it walks) => (footing, shares), once a tick. A state that isn't finite and whole
  /// changes nothing, nor do loads that can't be judged. No heap.
  void update(const model::RobotState& state, const model::JointCommand& in_force, bool walks) noexcept;

  Footing footing() const noexcept { return footing_; }
  /// Filtered load of each foot over the robot's weight. There are two estimates, from measured torques and from the
  /// torques that the command asks for; this is the pair with the larger sum. So a robot that stands still counts as
  /// standing when its torque readings vanish.
  const PerFoot<double>& share() const noexcept;

 private:
  void measure(const model::RobotState& state, const model::JointCommand& in_force) noexcept;
  bool can_be_judged(const model::RobotState& state, const model::JointCommand& in_force) const noexcept;

  model::SoleLoads loads_;
  model::ChainKinematics base_to_imu_link_;
  Eigen::Matrix3d R_LI_;
  FootLoadOptions options_;
  double weight_N_, dt_s_, filter_gain_, acceleration_gain_, walking_gain_, change_variance_;
  int lost_ticks_needed_, found_ticks_needed_;
  Footing footing_ = Footing::kUnknown;
  bool begun_ = false;  // the filter has a value
  int lost_ticks_ = 0, found_ticks_ = 0;
  PerFoot<double> measured_{}, asked_{}, variance_{};
  double walking_share_ = 1.0;
  Eigen::Vector3d omega_before_B_ = Eigen::Vector3d::Zero();
  JointVector dq_before_, acceleration_sq_;
  double held_ = 0.0;  // specific force upwards, of g
};

}  // namespace pmg::faults
