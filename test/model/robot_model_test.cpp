#include "model/robot_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <kdl/treefksolverpos_recursive.hpp>
#include <random>

#include "model/robots.hpp"

namespace pmg::model {
namespace {

using test::kBipedFolder;
using test::kZ1Folder;

double top_of(const urdf::Collision& body) {
  if (body.geometry->type != urdf::Geometry::SPHERE) return 0.0;
  return body.origin.position.z + static_cast<const urdf::Sphere&>(*body.geometry).radius;
}

KDL::Frame link_pose(const RobotModel& robot, const std::string& link, const JointVector& q_robot) {
  KDL::Tree tree = robot.tree;
  KDL::JntArray q(tree.getNrOfJoints());
  for (const auto& [name, element] : tree.getSegments()) {
    const KDL::Joint& joint = GetTreeElementSegment(element).getJoint();
    if (joint.getType() == KDL::Joint::Fixed || name == robot.base_link) continue;
    q(GetTreeElementQNr(element)) = q_robot[robot.joint_index.at(joint.getName())];
  }
  KDL::TreeFkSolverPos_recursive solver(tree);
  KDL::Frame pose;
  EXPECT_EQ(solver.JntToCart(q, pose, link), 0);
  return pose;
}

JointVector random_posture(const RobotModel& robot, std::mt19937& random) {
  JointVector q(robot.joint_index.size());
  for (const Joint& joint : robot.joints) {
    q[robot.joint_index.at(joint.name)] =
        std::uniform_real_distribution<double>(joint.lower_rad, joint.upper_rad)(random);
  }
  return q;
}

TEST(Z1, HasTheMassStatureAndJointsOfItsTable) {
  const RobotModel robot = load_robot(kZ1Folder);
  EXPECT_EQ(robot.joints.size(), 31u);
  EXPECT_NEAR(robot.total_mass_kg, 35.0, 0.01 * 35.0);
  const JointVector zero = JointVector::Zero(31);
  const double crown = link_pose(robot, "head", zero).p.z() + top_of(*robot.urdf->getLink("head")->collision);
  const double sole = link_pose(robot, robot.feet[kLeft].link, zero).p.z() + robot.feet[kLeft].sole_corners_F()[0].z();
  EXPECT_NEAR(crown - sole, 1.50, 0.015);
  EXPECT_NEAR(robot.standing_height_m, 0.7945, 0.001);  // knees of 8 degrees take 2 mm of 0.796
}

TEST(Z1, LegsCarryTheTablesShareOfTheMass) {
  const RobotModel robot = load_robot(kZ1Folder);
  double leg = 0.0;
  for (const auto& [name, link] : robot.urdf->links_) {
    for (const std::string part : {"hip", "knee", "ankle"}) {
      if (name.starts_with("left_" + part)) leg += link->inertial->mass;
    }
  }
  EXPECT_NEAR(leg / 35.0, 0.1416 + 0.0433 + 0.0137, 1e-6);  // de Leva 1996, table 4; the model prints nine digits
}

TEST(Z1, StandsWithFeetUnderItsCentreOfMass) {
  const RobotModel robot = load_robot(kZ1Folder);
  KDL::Vector moment = robot.base_inertia.getMass() * robot.base_inertia.getCOG();
  for (const auto& [name, element] : robot.tree.getSegments()) {
    const KDL::RigidBodyInertia& inertia = GetTreeElementSegment(element).getInertia();
    if (inertia.getMass() > 0.0)
      moment = moment + inertia.getMass() * (link_pose(robot, name, robot.q_stand()) * inertia.getCOG());
  }
  const KDL::Vector com = moment / robot.total_mass_kg;
  const KDL::Frame foot = link_pose(robot, robot.feet[kLeft].link, robot.q_stand());
  const FootModel& box = robot.feet[kLeft];
  const double margin_m = 0.03;  // more than the shift of the pressure by one step of the drives' Coulomb friction
  EXPECT_GT(com.x(), foot.p.x() + box.box_center_F.x() - box.box_half_size_m.x() + margin_m);
  EXPECT_LT(com.x(), foot.p.x() + box.box_center_F.x() + box.box_half_size_m.x() - margin_m);
  EXPECT_NEAR(com.y(), 0.0, 1e-9);
  EXPECT_NEAR(foot.M.UnitZ().z(), 1.0, 1e-9) << "soles are level";
}

TEST(Z1, UrdfIsWhatItsGeneratorWrites) {
  EXPECT_EQ(std::system(("python3 " + kZ1Folder + "/generate.py --check").c_str()), 0);
}

TEST(Z1, KeepsTheCommandRangesWithinTheVelocityScales) {
  const RobotModel robot = load_robot(kZ1Folder);
  for (std::size_t i = 0; i < kVelocityChannels; ++i) {
    EXPECT_LE(robot.command_limits.upper[i], robot.velocity_scale_positive[i]);
    EXPECT_LE(-robot.command_limits.lower[i], robot.velocity_scale_negative[i]);
  }
}

TEST(Z1, PolicyDrivesTheTwelveLegJoints) {
  const RobotModel robot = load_robot(kZ1Folder);
  for (const Foot foot : {kLeft, kRight}) {
    EXPECT_EQ(robot.leg_joints[foot].size(), 6u);
    for (const int joint : robot.leg_joints[foot]) EXPECT_TRUE(robot.joints[static_cast<std::size_t>(joint)].policy);
  }
  EXPECT_EQ(std::count_if(robot.joints.begin(), robot.joints.end(), [](const Joint& j) { return j.policy; }), 12);
}

class EveryRobot : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Robots, EveryRobot, ::testing::Values(kZ1Folder, kBipedFolder),
                         [](const auto& robot) { return std::filesystem::path(robot.param).filename().string(); });

TEST_P(EveryRobot, HasPhysicalInertias) {
  const RobotModel robot = load_robot(GetParam());
  double mass = 0.0;
  for (const auto& [name, link] : robot.urdf->links_) {
    const urdf::Inertial& body = *link->inertial;
    Eigen::Matrix3d inertia;
    inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz, body.izz;
    const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
    EXPECT_GT(body.mass, 0.0) << name;
    EXPECT_GT(moments[0], 0.0) << name;
    EXPECT_GE(moments[0] + moments[1], moments[2] * (1.0 - 1e-6)) << name;
    mass += body.mass;
  }
  EXPECT_NEAR(mass, robot.total_mass_kg, 1e-12);
}

TEST_P(EveryRobot, IsSymmetricInMassAndKinematics) {
  const RobotModel robot = load_robot(GetParam());
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const JointVector q = random_posture(robot, random);
    JointVector mirrored(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      mirrored[i] = robot.mirror.sign[k] * q[robot.mirror.partner[k]];
    }
    for (const auto& [name, link] : robot.urdf->links_) {
      const std::string other = name.starts_with("left_")    ? "right_" + name.substr(5)
                                : name.starts_with("right_") ? "left_" + name.substr(6)
                                                             : name;
      const KDL::Vector mine = link_pose(robot, name, q).p;
      const KDL::Vector theirs = link_pose(robot, other, mirrored).p;
      EXPECT_NEAR((KDL::Vector(mine.x(), -mine.y(), mine.z()) - theirs).Norm(), 0.0, 1e-9)
          << name << ", seed 7, trial " << trial;
      EXPECT_EQ(link->inertial->mass, robot.urdf->getLink(other)->inertial->mass) << name;
    }
  }
}

TEST_P(EveryRobot, MirroringTwiceChangesNothing) {
  const RobotModel robot = load_robot(GetParam());
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const auto partner = static_cast<std::size_t>(robot.mirror.partner[i]);
    EXPECT_EQ(robot.mirror.partner[partner], static_cast<int>(i));
    EXPECT_EQ(robot.mirror.sign[partner], robot.mirror.sign[i]);
  }
}

TEST_P(EveryRobot, KeepsJointsInTheOrderOfItsFile) {
  const RobotModel robot = load_robot(GetParam());
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    EXPECT_EQ(robot.joint_index.at(robot.joints[i].name), static_cast<int>(i));
    EXPECT_EQ(robot.q_stand()[static_cast<Eigen::Index>(i)], robot.joints[i].stand_rad);
    EXPECT_EQ(robot.q_lower()[static_cast<Eigen::Index>(i)], robot.joints[i].lower_rad);
    EXPECT_EQ(robot.q_upper()[static_cast<Eigen::Index>(i)], robot.joints[i].upper_rad);
  }
}

TEST(Biped, IsReadWithItsOwnOrderAndConventions) {
  const RobotModel robot = load_robot(kBipedFolder);
  EXPECT_EQ(robot.joint_index.name(0), "waist_pitch");
  EXPECT_EQ(robot.joint_index.name(1), "right_hip_yaw");
  const auto sign = [&](const char* name) {
    return robot.mirror.sign[static_cast<std::size_t>(robot.joint_index.at(name))];
  };
  EXPECT_EQ(sign("left_hip_yaw"), -1.0);
  EXPECT_EQ(sign("left_hip_roll"), 1.0) << "the right one turns about -x";
  EXPECT_EQ(sign("left_hip_pitch"), 1.0);
  // base + 2 (yaw, roll, thigh, shank, foot) + torso + plate
  EXPECT_NEAR(robot.total_mass_kg, 3.5 + 2 * (0.3 + 0.3 + 1.2 + 0.8 + 0.4) + 3.0 + 0.05, 1e-12);
  EXPECT_NEAR(robot.standing_height_m, 0.4 * std::cos(0.2) + 0.05, 1e-12);
  // The plate is turned by 0.3, and the IMU on it is turned back.
  const KDL::Frame plate = link_pose(robot, robot.imu.link, robot.q_stand());
  const Eigen::Vector3d x = robot.imu.T_LI.linear().col(0);
  EXPECT_NEAR((plate.M * KDL::Vector(x.x(), x.y(), x.z())).x(), 1.0, 1e-12);
}

TEST(JointIndex, FindsJointsByNameAndNamesTheUnknownOne) {
  const JointIndex index({"a", "b"});
  EXPECT_EQ(index.find("b"), 1);
  EXPECT_EQ(index.find("c"), std::nullopt);
  try {
    index.at("c");
    FAIL() << "nothing was thrown";
  } catch (const std::out_of_range& error) {
    EXPECT_NE(std::string(error.what()).find("joint c"), std::string::npos);
  }
  EXPECT_THROW(JointIndex({"a", "a"}), std::invalid_argument);
}

TEST(FindRobot, TakesANameOrADirectoryAndNamesTheKnownOnes) {
  EXPECT_EQ(find_robot("z1").filename(), "z1");
  EXPECT_EQ(find_robot(kBipedFolder), kBipedFolder);
  try {
    find_robot("no_such_robot");
    FAIL() << "nothing was thrown";
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("z1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pmg::model
