#include "model/mirror.hpp"

#include <fmt/format.h>

#include <cmath>

namespace pmg::model {
namespace {

constexpr double kParallel = 1e-3;       // 1 - |cos| of the axes: 2.6 degrees
constexpr double kSamePlace_m = 1e-3;    // exports from CAD differ by less
constexpr double kSameAngle_rad = 1e-6;  // limits and postures are typed in, the same for both sides

std::string partner_name(const std::string& name) {
  if (name.starts_with("left_")) return "right_" + name.substr(5);
  if (name.starts_with("right_")) return "left_" + name.substr(6);
  return name;
}

struct Axis {
  KDL::Vector origin, direction;  // in the base frame, all joints at zero
};

Axis axis_of(const RobotModel& robot, const UrdfTree& tree, int joint) {
  const Joint& j = robot.joints[static_cast<std::size_t>(joint)];
  const KDL::Frame& pose = tree.link_pose.at(tree.urdf->getJoint(j.name)->child_link_name);
  return {pose.p, pose.M * KDL::Vector(j.axis.x(), j.axis.y(), j.axis.z())};
}

}  // namespace

MirrorMap find_mirror(const RobotModel& robot, const UrdfTree& tree) {
  MirrorMap mirror;
  for (int i = 0; i < robot.joint_index.size(); ++i) {
    const Joint& joint = robot.joints[static_cast<std::size_t>(i)];
    const files::Place place = tree.place("joint", joint.name);
    const std::string key = "joint " + joint.name;
    const std::string other_name = partner_name(joint.name);
    const std::optional<int> found = robot.joint_index.find(other_name);
    if (!found) files::raise(place, key, "has no mirror image", "a joint " + other_name);
    const Joint& other = robot.joints[static_cast<std::size_t>(*found)];

    // Reflection in the plane with normal y turns a rotation vector (x, y, z) into (-x, y, -z).
    const Axis mine = axis_of(robot, tree, i), theirs = axis_of(robot, tree, *found);
    const KDL::Vector seen(-mine.direction.x(), mine.direction.y(), -mine.direction.z());
    const double cosine = KDL::dot(seen, theirs.direction);
    if (1.0 - std::abs(cosine) > kParallel)
      files::raise(place, key + " axis", "isn't mirrored by " + other_name, "a parallel one");
    const KDL::Vector image(mine.origin.x(), -mine.origin.y(), mine.origin.z());
    if ((image - theirs.origin).Norm() > kSamePlace_m) {
      files::raise(place, key + " origin", "isn't mirrored by " + other_name, "the same place within 1 mm");
    }
    const double sign = cosine > 0.0 ? 1.0 : -1.0;
    const double lower = sign > 0.0 ? joint.lower_rad : -joint.upper_rad;
    const double upper = sign > 0.0 ? joint.upper_rad : -joint.lower_rad;
    if (std::abs(other.lower_rad - lower) > kSameAngle_rad || std::abs(other.upper_rad - upper) > kSameAngle_rad) {
      files::raise(place, key + " limit",
                   fmt::format("isn't mirrored by {}: {} to {}", other_name, other.lower_rad, other.upper_rad),
                   fmt::format("{} to {} there", lower, upper));
    }
    if (std::abs(other.stand_rad - sign * joint.stand_rad) > kSameAngle_rad) {
      files::raise({(robot.directory / "robot.yaml").string()}, "joints." + joint.name + ".stand_rad",
                   fmt::format("{} isn't mirrored by {}: {}", joint.stand_rad, other_name, other.stand_rad),
                   fmt::format("{} there", sign * joint.stand_rad));
    }
    mirror.partner.push_back(*found);
    mirror.sign.push_back(sign);
  }
  return mirror;
}

}  // namespace pmg::model
