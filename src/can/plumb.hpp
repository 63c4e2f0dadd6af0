// Where down is for a robot that hangs, and how its base leans, from the IMU on one of its buses.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "can/link.hpp"
#include "can/xsens_imu.hpp"
#include "model/robot_model.hpp"

namespace pmg::can {

/// (joints [rad]) => the link's axes in the base's.
Eigen::Quaterniond link_in_base(const model::RobotModel& robot, const std::string& link, const JointVector& q);

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

/// The mean of some samples at rest.
class PlumbMean {
 public:
  void add(const std::optional<Plumb::Sample>& sample);
  /// Nullopt: there was none, or one of them was missing.
  std::optional<Plumb::Sample> mean() const;

 private:
  Eigen::Vector3d down_B_ = Eigen::Vector3d::Zero();
  Eigen::Vector4d base_WB_ = Eigen::Vector4d::Zero();  // coefficients, summed
  bool whole_ = true;
};

/// Of the base, from one sample to another, in its own axes [rad].
Eigen::Vector3d turned_rad(const Plumb::Sample& from, const Plumb::Sample& to);

}  // namespace pmg::can
