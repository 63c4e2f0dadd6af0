#include "live_page/robot_shape.hpp"

#include <urdf_model/joint.h>
#include <urdf_model/link.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

namespace pmg::live_page {

namespace {

using Shape = nlohmann::ordered_json;

double rounded(double value) { return std::round(value * 1e5) / 1e5; }

Shape matrix(const urdf::Pose& pose) {
  const Eigen::Matrix3d R =
      Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z).toRotationMatrix();
  const Eigen::Vector3d p(pose.position.x, pose.position.y, pose.position.z);
  Shape rows = Shape::array();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) rows.push_back(rounded(R(r, c)));
    rows.push_back(rounded(p[r]));
  }
  return rows;
}

Shape shapes_of(const urdf::Link& link) {
  Shape shapes = Shape::array();
  for (const auto& visual : link.visual_array) {
    Shape shape{{"at", matrix(visual->origin)}};
    if (const auto* box = dynamic_cast<const urdf::Box*>(visual->geometry.get())) {
      shape["box"] = {box->dim.x, box->dim.y, box->dim.z};
    } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(visual->geometry.get())) {
      shape["cylinder"] = {cylinder->radius, cylinder->length};
    } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(visual->geometry.get())) {
      shape["sphere"] = sphere->radius;
    } else {
      continue;
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

int index_of(const model::RobotModel& robot, const std::string& joint) {
  const std::vector<std::string>& names = robot.joint_index.names();
  const auto found = std::ranges::find(names, joint);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

}  // namespace

std::string robot_shape(const model::RobotModel& robot) {
  Shape links = Shape::array();
  std::vector<std::pair<std::shared_ptr<const urdf::Link>, int>> waiting{{robot.urdf->getLink(robot.base_link), -1}};
  while (!waiting.empty()) {
    const auto [link, parent] = waiting.back();
    waiting.pop_back();
    const urdf::Joint* joint = parent < 0 ? nullptr : link->parent_joint.get();
    const bool turns = joint != nullptr && joint->type != urdf::Joint::FIXED;
    links.push_back({{"parent", parent},
                     {"at", matrix(joint == nullptr ? urdf::Pose() : joint->parent_to_joint_origin_transform)},
                     {"axis", {turns ? joint->axis.x : 0.0, turns ? joint->axis.y : 0.0, turns ? joint->axis.z : 1.0}},
                     {"joint", turns ? index_of(robot, joint->name) : -1},
                     {"shapes", shapes_of(*link)}});
    for (const auto& child : link->child_links) waiting.emplace_back(child, static_cast<int>(links.size()) - 1);
  }
  return links.dump();
}

}  // namespace pmg::live_page
