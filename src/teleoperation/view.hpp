// What an operator sees of the task through the robot's head camera: delayed, thirty times a second, inexactly, and
// only what is in the picture.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <string>

#include "arms/arm_setup.hpp"
#include "model/robot_model.hpp"
#include "sim/head_camera.hpp"
#include "sim/world.hpp"

namespace pmg::teleoperation {

/// ASSUMPTIONS: a video link of 0.12 s, and a person who judges places in the picture to within 5 mm and turns to
/// within 2 degrees (standard deviations).
struct ViewOptions {
  sim::HeadCamera camera{};
  double delay_s = 0.12, period_s = 1.0 / 30.0, noise_m = 0.005, noise_rad = 0.01,
         noise_turn_rad = 0.035;  ///< of edges, which are long; of objects and palms
};

/// Everything in the torso's frame T, as the picture shows it from the robot's own eyes.
struct Picture {
  double time_s = 0.0;
  std::optional<Eigen::Vector3d> object_m;  ///< of its middle
  Eigen::Quaterniond object_R{1.0, 0.0, 0.0, 0.0};
  PerFoot<std::optional<Eigen::Vector3d>> palm_m;
  PerFoot<Eigen::Quaterniond> palm_R;
  std::optional<double> edge_m;       ///< the table's front edge, straight ahead at its own height
  double edge_yaw_rad = 0.0;          ///< of the edge's normal to the left of straight ahead
  double top_m = 0.0;                 ///< of the table's top there: z in T
  Eigen::Vector3d up{0.0, 0.0, 1.0};  ///< its normal
  std::optional<double> mark_m;       ///< on the table's edge beside the object, from its middle to the left
};

class View {
 public:
  /// table: a prop, and its half sizes [m].
  View(const model::RobotModel& robot, const sim::World& world, std::string object, std::string table,
       const Eigen::Vector3d& table_half_m, std::uint64_t seed, const ViewOptions& options = {});

  /// Call in each tick: the newest picture that has arrived; null: none yet.
  const Picture* look(double now_s);

  /// The torso's pose in the world: of the judge's.
  Eigen::Isometry3d torso() const;

 private:
  Picture take(double now_s);
  bool in_picture(const Eigen::Vector3d& p_T_m) const;
  Eigen::Vector3d seen(const Eigen::Vector3d& p_T_m);
  Eigen::Quaterniond seen(const Eigen::Matrix3d& R);
  Eigen::Isometry3d body(const std::string& name) const;

  const model::RobotModel& robot_;
  const sim::World& world_;
  std::string object_, table_;
  Eigen::Vector3d table_half_m_;
  ViewOptions options_;
  std::optional<arms::ArmSetup> arms_;
  std::mt19937_64 random_;
  std::deque<Picture> underway_;
  std::optional<Picture> newest_;
  double next_s_ = 0.0;
};

}  // namespace pmg::teleoperation
