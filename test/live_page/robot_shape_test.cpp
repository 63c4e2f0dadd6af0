#include "live_page/robot_shape.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "control/fixtures.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::live_page {
namespace {

Eigen::Isometry3d pose_of(const nlohmann::json& rows) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) T.matrix()(r, c) = rows[static_cast<std::size_t>(4 * r + c)].get<double>();
  return T;
}

TEST(RobotShapeTest, ItsLinksAreWhereTheLegsKinematicsHaveThem) {
  const model::RobotModel& robot = test::z1();
  const nlohmann::json links = nlohmann::json::parse(robot_shape(robot));
  JointVector q = robot.q_stand();
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += i % 2 == 0 ? 0.1 : -0.07;
  std::vector<Eigen::Isometry3d> at;
  for (const nlohmann::json& link : links) {  // as robot.js
    Eigen::Isometry3d own = pose_of(link["at"]);
    const int joint = link["joint"];
    const Eigen::Vector3d axis(link["axis"][0], link["axis"][1], link["axis"][2]);
    if (joint >= 0) own.rotate(Eigen::AngleAxisd(q[joint], axis));
    const int parent = link["parent"];
    ASSERT_LT(parent, static_cast<int>(at.size())) << "each is behind its parent";
    at.push_back(parent < 0 ? Eigen::Isometry3d::Identity() : at[static_cast<std::size_t>(parent)] * own);
  }
  model::LegKinematics legs(robot);
  for (const model::FootKinematics& foot : legs.compute(q, JointVector::Zero(q.size()))) {
    const auto is_foot = [&](const Eigen::Isometry3d& T) {
      return (T.translation() - foot.p_BF).norm() < 1e-3 && (T.linear() - foot.R_BF).norm() < 1e-3;
    };
    EXPECT_TRUE(std::ranges::any_of(at, is_foot));
  }
}

TEST(RobotShapeTest, EveryBoxCylinderAndSphereOfTheUrdfIsThere) {
  const model::RobotModel& robot = test::z1();
  std::size_t visuals = 0, shapes = 0;
  for (const auto& [name, link] : robot.urdf->links_) visuals += link->visual_array.size();
  for (const nlohmann::json& link : nlohmann::json::parse(robot_shape(robot))) {
    for (const nlohmann::json& shape : link["shapes"]) {
      ++shapes;
      EXPECT_EQ(shape.contains("box") + shape.contains("cylinder") + shape.contains("sphere"), 1);
    }
  }
  EXPECT_GT(shapes, 100U);
  EXPECT_EQ(shapes, visuals);
}

}  // namespace
}  // namespace pmg::live_page
