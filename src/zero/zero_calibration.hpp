// Motor zero points from still poses (paper III-C.2, Motor-IMU alignment).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "model/sole_load.hpp"
#include "work/progress.hpp"
#include "zero/standing_constraint.hpp"
#include "zero/zero_poses.hpp"

namespace pmg::zero {

struct ZeroOptions {
  // The paper's symbols; it gives no values.
  double tau_rad = 0.01;      ///< a pose counts when the simulated IMU's gravity is this near the real one's
  double alpha = 0.5;         ///< damping of the update
  double epsilon_rad = 1e-5;  ///< converged when no joint's update exceeds it ...
  int M = 5;                  ///< ... over so many consecutive iterations
  int most_iterations = 200;

  // Uncertainties of a pose, one standard deviation each. Assumed.
  double sole_tilt_rad = 0.001;      ///< of a flat sole: compliance of sole and ground
  double height_m = 0.0003;          ///< of one sole above the other, likewise
  double deflection_rad = 0.001;     ///< of a joint in one pose against the others: play, bending
  double sole_give_m = 0.003;        ///< compression of sole and ground under the whole weight, same in all poses
  double imu_mounting_rad = 0.001;   ///< of the IMU's attitude against robot.yaml, same in all poses
  double expected_offset_rad = 0.1;  ///< prior of a zero point
  double least_load = 0.1;           ///< share of the weight on a sole that stands
  double least_inside_m = 0.01;      ///< of the centre of pressure from the sole's edge when the sole lies flat
  // What a zero point's standard deviation may be at most.
  double well_rad = 0.002;     ///< known well
  double roughly_rad = 0.005;  ///< known roughly: far nearer the truth than an assembled joint's tens of mrad
};

/// How well the poses determine a joint's zero point. Zero points that are known well or roughly are applied.
enum class Known { kNo, kRoughly, kWell };

/// Result of one pose.
struct ZeroPose {
  bool used = false;
  std::string why_not;            ///< empty when used
  double misalignment_rad = 0.0;  ///< |s_real - s_sim|, of the worse foot
  double height_miss_m = 0.0;
  PerFoot<model::SoleLoad> load;
};

/// A combination of zero points that the poses do not determine (null space).
struct BlindDirection {
  double deviation_rad = 0.0;  ///< along it
  std::string text;            ///< "0.71 left_hip_pitch - 0.70 left_ankle_pitch"
};

struct ZeroCalibration {
  std::vector<int> joints;        ///< between soles and IMU; no other joint is observable
  Eigen::VectorXd z_rad;          ///< correction to add to the reading, one per entry of joints
  Eigen::VectorXd deviation_rad;  ///< one standard deviation, given the options' uncertainties
  std::vector<Known> known;
  Eigen::Vector2d imu_tilt_rad = Eigen::Vector2d::Zero();  ///< of its mounting, about its x and y
  /// Of soles and ground: pitch and roll [rad/Nm], height [m/N].
  Eigen::Vector3d give = Eigen::Vector3d::Zero();
  std::vector<double> singular_values;  ///< of the poses' stacked, weighted Jacobian by the zero points [1/rad]
  std::vector<BlindDirection> blind;
  std::vector<ZeroPose> poses;    ///< in the order of the input
  std::vector<double> steps_rad;  ///< largest |alpha delta_i| of each iteration
  double weighted_rms = 0.0;      ///< of the residual; 1 if it is as large as the options expect
  bool converged = false;
  std::size_t used() const;
};

/// (robot, poses) => (zero points). Throws std::invalid_argument if the robot stands on both soles in no pose.
ZeroCalibration calibrate_zero(const model::RobotModel& robot, const std::vector<StillPose>& poses,
                               const ZeroOptions& options = {}, const work::Progress& progress = {});

}  // namespace pmg::zero
