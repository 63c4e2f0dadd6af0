// A MuJoCo 2.2 world built in memory from the robot model.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/ground_truth.hpp"
#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "sim/motor_file.hpp"
#include "sim/variation.hpp"

namespace pmg::sim {

/// A box in the world beside the robot: a table's top, or something to handle.
struct Prop {
  std::string name;
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_WP_m = Eigen::Vector3d::Zero();  ///< of its centre
  double yaw_rad = 0.0;
  double mass_kg = 0.0;   ///< spread evenly; 0: fixed to the world
  double friction = 0.8;  ///< between two things the larger of both counts
  std::array<double, 4> colour = {0.7, 0.6, 0.5, 1.0};
};

/// A box on a link of the robot. It touches props and the floor in place of the link's own shapes, and other links
/// beside them.
struct HandBox {
  std::string link;
  Eigen::Isometry3d T_LH = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
  double friction = 0.8;  ///< on whatever it touches
};

struct WorldOptions {
  double timestep_s = 0.002;  ///< one physics step per bus cycle
  bool gantry = false;        ///< the torso hangs in a soft suspension, feet clear of the ground
  /// With gantry: a bench. The base and every joint but this one are clamped in the standing posture. Empty: none is.
  std::string benched_joint;
  double floor_friction = 0.8;
  std::uint64_t seed = 0;                                                               ///< of the sensor noise
  double gyro_noise_rad_s = 0.0, encoder_noise_rad = 0.0, orientation_noise_rad = 0.0;  ///< standard deviations
  double velocity_noise_rad_s = 0.0;  ///< of measured joint velocities; standard deviation
  ActuatorsByJoint motors;            ///< from motor.yaml; other numbers come from robot.yaml
  std::vector<Prop> props{};
  std::vector<HandBox> hand_boxes{};
  Variation variation;  ///< other differences from the model
};

/// The gantry's rope, for pictures.
struct Rope {
  Eigen::Vector3d bottom_W = Eigen::Vector3d::Zero();  ///< on the torso [m]
  Eigen::Vector3d top_W = Eigen::Vector3d::Zero();     ///< above the picture's top [m]
};

/// The MJCF text of this robot in this world. Deterministic: same input, same bytes. It also runs in MuJoCo without
/// World: then its actuators are position servos (ctrl = q_des [rad]) with robot.yaml's gains, and its joints have
/// MuJoCo's dry friction; World replaces both by the actuator model. The keyframe "stand" is the standing posture on
/// the ground. Throws files::ConfigError if a link collides by a mesh; visual meshes are left out.
std::string mjcf(const model::RobotModel& robot, const WorldOptions& options);

class World {
 public:
  World(const model::RobotModel& robot, const WorldOptions& options);  ///< keeps a reference to robot
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// What it was told beside the robot's files, as sim::set_values.
  const std::vector<std::string>& set_values() const noexcept { return set_values_; }
  void reset();  ///< standing posture, soles on the ground (or hanging on the gantry), at rest, time zero

  /// One physics step under the command (held), each joint through its actuator model. No heap. The command's vectors
  /// have one element per joint. A variation's delay holds a command back; until the first one arrives the drives are
  /// limp. After divergence nothing moves until reset().
  void step(const model::JointCommand& command) noexcept;
  void read(model::RobotState& state) noexcept;  ///< sensors of the current step
  model::GroundTruth truth() const noexcept;
  /// Of a link or a prop. Throws std::runtime_error if there is none of this name.
  Eigen::Isometry3d pose(const std::string& name) const;
  /// Two bodies of these names touch. Throws as pose does.
  bool touches(const std::string& one, const std::string& other) const;
  bool diverged() const noexcept;  ///< MuJoCo warned of NaN or a bad state, or reset itself
  double time_s() const noexcept;

  /// The gantry's soft suspension of the torso. lift_m: height of the torso's anchor above its place in the standing
  /// posture on the ground. The feet are clear from about 0.03 m on, because the suspension sags by 0.02 m under the
  /// robot. engaged: 0 free, 1 held, between them a share of the stiffness. When it is engaged from 0, the anchor takes
  /// the torso's place and heading. Takes effect at the next step, so the caller ramps it.
  void set_hoist(double lift_m, double engaged) noexcept;

  /// Height of the torso's centre of mass above its place in the standing posture on the ground [m]. An anchor engaged
  /// with this lift_m exerts no vertical force at first.
  double torso_height_m() const noexcept;
  const std::array<double, 2>& foot_force_N() const noexcept;  ///< see truth()

  std::optional<Rope> gantry_rope() const;  ///< nullopt while the gantry is not engaged

  /// A force on the torso link's centre of mass, in the world frame [N]. It acts until it is set again or reset.
  void set_push(const Eigen::Vector3d& force_W_N) noexcept;

  const mjModel* mj_model() const { return model_; }
  mjData* mj_data() { return data_; }

 private:
  void set_drives(const model::JointCommand& command) noexcept;
  void measure_feet() noexcept;
  void check_divergence() noexcept;

  const model::RobotModel& robot_;
  std::vector<std::string> set_values_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmg::sim
