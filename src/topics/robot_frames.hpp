// (joint angles, pose of the base) => the frames of every link, for programs that draw a robot.
#pragma once

#include <string>
#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"

namespace pmg::topics {

inline constexpr const char* kWorldFrame = "world";

class RobotFrames {
 public:
  explicit RobotFrames(const model::RobotModel& robot);

  /// A link in the frame of its parent; the base's parent is the world.
  struct Frame {
    std::string parent, child;
    Eigen::Vector3d p = Eigen::Vector3d::Zero();            ///< p_PC [m]
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< q_PC
  };

  /// All links, the base first. q_rad: one for each joint, in the robot's order.
  const std::vector<Frame>& at(const std::vector<double>& q_rad, const Eigen::Isometry3d& T_WB);

  /// Where the base is if nothing but the robot's own sensors is known: the IMU's orientation q_WI, the lowest corner
  /// of the soles on the ground (z = 0), and no way along it.
  Eigen::Isometry3d standing_base(const std::vector<double>& q_rad, const Eigen::Quaterniond& q_WI) const;

 private:
  KDL::Frame pose(const KDL::Segment& segment, const std::vector<double>& q_rad) const;
  Eigen::Isometry3d link_in_base(const std::string& link, const std::vector<double>& q_rad) const;

  const model::RobotModel& robot_;
  std::vector<const KDL::Segment*> segments_;  ///< of frames_ but the first
  std::vector<Frame> frames_;
};

}  // namespace pmg::topics
