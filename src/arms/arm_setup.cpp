#include "arms/arm_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/config_reader.hpp"

namespace pmg::arms {

namespace {

PalmSetup read_palm(files::ConfigReader reader, const model::RobotModel& robot) {
  PalmSetup palm;
  palm.link = reader.required<std::string>("palm_link");
  if (!robot.urdf->getLink(palm.link))
    reader.fail("palm_link", "'" + palm.link + "' isn't a link", "a link of the URDF");
  const std::vector<double> p = reader.numbers("position_m", 3), rpy = reader.numbers("rpy_rad", 3);
  palm.T_LP.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
  palm.T_LP.linear() =
      (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  robot.tree.getChain(robot.torso_link, palm.link, palm.chain);
  for (const KDL::Segment& segment : palm.chain.segments) {
    if (segment.getJoint().getType() == KDL::Joint::Fixed) continue;
    palm.joints.push_back(robot.joint_index.at(segment.getJoint().getName()));
    const auto joint = static_cast<std::size_t>(palm.joints.back());
    if (robot.joints[joint].policy) {
      reader.fail("palm_link", fmt::format("hangs on {}, which the policy drives", robot.joints[joint].name),
                  "a link beyond joints of its own");
    }
  }
  if (palm.joints.empty() || palm.joints.size() > static_cast<std::size_t>(kMaxArmJoints)) {
    reader.fail("palm_link", fmt::format("hangs on {} joints below {}", palm.joints.size(), robot.torso_link),
                fmt::format("1 to {}", kMaxArmJoints));
  }
  reader.finish();
  return palm;
}

}  // namespace

std::optional<ArmSetup> read_arm_setup(const model::RobotModel& robot) {
  files::ConfigReader reader = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  if (!reader.has("arms")) return std::nullopt;
  files::ConfigReader section = reader.map("arms");
  ArmSetup setup;
  setup.speed_rad_s = section.required<double>("speed_rad_s", files::positive());
  setup.palm = {read_palm(section.map("left"), robot), read_palm(section.map("right"), robot)};
  for (const int joint : setup.palm[kLeft].joints) {
    if (std::ranges::find(setup.palm[kRight].joints, joint) != setup.palm[kRight].joints.end()) {
      section.fail("right", fmt::format("shares {} with the left arm", robot.joint_index.name(joint)),
                   "joints of its own");
    }
  }
  section.finish();
  return setup;
}

double span_m(const ArmSetup& setup) {
  double span_m = 0.0;
  for (const PalmSetup& palm : setup.palm) {
    double shoulder_m = 0.0;
    bool past_shoulder = false;
    for (const KDL::Segment& segment : palm.chain.segments) {
      const KDL::Vector origin_m = segment.getFrameToTip().p;  // of the joint, in the link before it
      if (past_shoulder) {
        span_m += origin_m.Norm();
      } else {
        shoulder_m += origin_m.y();
      }
      past_shoulder = past_shoulder || segment.getJoint().getType() != KDL::Joint::Fixed;
    }
    span_m += std::abs(shoulder_m) + palm.T_LP.translation().norm();
  }
  return span_m;
}

}  // namespace pmg::arms
