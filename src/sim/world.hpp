// A MuJoCo 2.2 world built in memory from the robot model.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "model/ground_truth.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "sim/motor_file.hpp"
#include "sim/variation.hpp"

namespace pmg::sim {

struct WorldOptions {
  double timestep_s = 0.002;  ///< one physics step a bus cycle
  bool gantry = false;        ///< hang the torso in a soft suspension, feet clear of the ground
  /// With gantry: a bench. The base and every joint but this one are clamped in the standing posture. Empty: none is.
  std::string benched_joint;
  double floor_friction = 0.8;
  std::uint64_t seed = 0;                                                               ///< of the sensor noise
  double gyro_noise_rad_s = 0.0, encoder_noise_rad = 0.0, orientation_noise_rad = 0.0;  ///< standard deviations
  double velocity_noise_rad_s = 0.0;  ///< of measured joint velocities, likewise
  ActuatorsByJoint motors;            ///< what a motor.yaml says of some joints; robot.yaml says the rest
  Variation variation;                ///< what else is not as the model says
};

/// The gantry's rope, for pictures.
struct Rope {
  Eigen::Vector3d bottom_W = Eigen::Vector3d::Zero();  ///< on the torso [m]
  Eigen::Vector3d top_W = Eigen::Vector3d::Zero();     ///< out of the picture [m]
};

/// The MJCF text of this robot in this world. Deterministic: same input, same bytes. For MuJoCo alone: its actuators
/// are position servos (ctrl = q_des [rad]) with robot.yaml's gains, and its joints have MuJoCo's dry friction where
/// World's have the actuator model; the keyframe "stand" is the standing posture on the ground. Throws
/// model::ConfigError when a link collides by a mesh; a visual mesh is left out.
std::string mjcf(const model::RobotModel& robot, const WorldOptions& options);

class World {
 public:
  World(const model::RobotModel& robot, const WorldOptions& options);  ///< keeps a reference to robot
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void reset();  ///< standing posture, soles on the ground (or hanging on the gantry), at rest, time zero

  /// One physics step under the command (held), each joint through its actuator model. No heap.
  /// The command's vectors have one element a joint. A variation's delay holds it back for so many steps; until the
  /// first arrives the drives are limp. After divergence nothing moves any more until reset().
  void step(const model::JointCommand& command) noexcept;
  void read(model::RobotState& state) noexcept;  ///< sensors of the current step
  model::GroundTruth truth() const noexcept;
  bool diverged() const noexcept;  ///< MuJoCo warned of NaN, a bad state, or a reset of its own
  double time_s() const noexcept;

  /// The gantry's soft suspension of the torso. lift_m: how far the torso's anchor is above its place in the standing
  /// posture on the ground; the feet are clear from about 0.03 m on, because the suspension gives 0.02 m under the
  /// robot's weight. engaged: 0 free, 1 held, in between a share of the stiffness. The anchor's place and heading are
  /// taken from the torso when it is engaged from 0. Takes effect at the next step, so the caller ramps it.
  void set_hoist(double lift_m, double engaged) noexcept;

  /// Of the torso's centre of mass above its place in the standing posture on the ground [m]; the anchor's lift_m at
  /// which the gantry, engaged there, neither pulls nor hangs through.
  double torso_height_m() const noexcept;
  const std::array<double, 2>& foot_force_N() const noexcept;  ///< as truth()'s

  std::optional<Rope> gantry_rope() const;  ///< nothing while the gantry is not engaged

  /// A force on the torso link's centre of mass, in the world frame [N], until it is set again or reset.
  void set_push(const Eigen::Vector3d& force_W_N) noexcept;

  const mjModel* mj_model() const { return model_; }
  mjData* mj_data() { return data_; }

 private:
  void set_drives(const model::JointCommand& command) noexcept;
  void measure_feet() noexcept;
  void check_divergence() noexcept;

  const model::RobotModel& robot_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::sim
