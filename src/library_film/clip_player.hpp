// A clip played kinematically in MuJoCo: no drives, no gravity, the base where the feet put it.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "model/leg_kinematics.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "sim/world.hpp"

namespace pmg::library_film {

/// Two links in each other.
struct Touch {
  double depth_m = 0.0;  ///< largest over the cycle; 0: all links stay apart
  std::string links;     ///< "left_thigh and left_hand"
};

class ClipPlayer {
 public:
  explicit ClipPlayer(const model::RobotModel& robot);  ///< keeps a reference to robot

  /// From here on, at the clip's phase 0, heading along x.
  void begin(const DynamicClip& clip);
  /// The next sample: the lowest sole corner of the stance foot stays where it is, the lowest sole touches the ground,
  /// and the torso is upright.
  void step();

  std::size_t sample() const { return sample_; }
  double yaw_rad() const { return yaw_rad_; }
  const Eigen::Vector3d& base_W() const { return base_W_; }
  sim::World& world() { return world_; }

  /// Of the whole clip, by the shapes with which links collide in the simulation.
  Touch self_collision(const DynamicClip& clip);

 private:
  struct Pose {
    Eigen::Matrix3d R_HB;
    PerFoot<std::array<Eigen::Vector3d, 4>> sole_H;  // corners seen from the base, along the heading
    double lowest_m;
  };
  Pose pose_of(std::size_t sample);
  void place(const Pose& pose);

  const model::RobotModel& robot_;
  sim::World world_;
  model::BaseAttitude attitude_;
  model::LegKinematics legs_;
  const DynamicClip* clip_ = nullptr;
  std::size_t sample_ = 0;
  double yaw_rad_ = 0.0;
  Eigen::Vector3d base_W_ = Eigen::Vector3d::Zero();
};

}  // namespace pmg::library_film
