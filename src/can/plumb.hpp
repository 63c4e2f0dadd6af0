// Where down is for a robot that hangs, and how its base leans, from the IMU on one of its buses.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "can/link.hpp"
#include "can/xsens_imu.hpp"
#include "model/robot_model.hpp"

namespace pmg::can {

class Plumb {
 public:
  struct Sample {
    Eigen::Vector3d down_B;      ///< gravity's direction in the base's axes
    Eigen::Quaterniond base_WB;  ///< the base, in a world that stands still
  };

  /// link: of the IMU's bus; null: somebody else listens there, and lets it hear(). Keeps references.
  explicit Plumb(const model::RobotModel& robot, Link* link = nullptr) : robot_(robot), link_(link) {}

  void hear(const drives::Message& message) noexcept { imu_.hear(message); }
  /// Once a cycle. q: the robot's joints [rad], of which those between base and IMU count. The robot is at rest: its
  /// specific force points up. Nullopt: the IMU is silent, or shakes by more than a quarter of gravity.
  std::optional<Sample> sample(const JointVector& q);

 private:
  const model::RobotModel& robot_;
  Link* link_;
  XsensImu imu_;
};

}  // namespace pmg::can
