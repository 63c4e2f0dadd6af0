#include "live_page/measured_motion.hpp"

#include <gtest/gtest.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/jntarray.hpp>
#include <limits>

#include "control/fixtures.hpp"

namespace pmg::live_page {
namespace {

/// A robot whose right sole lies still on the ground: where its base is follows from the leg's joints alone.
class PlantedFoot {
 public:
  explicit PlantedFoot(const model::RobotModel& robot) : robot_(robot) {}

  Eigen::Isometry3d T_WB(const JointVector& q) const {
    const KDL::Chain& chain = robot_.leg_chain[kRight];
    KDL::JntArray joints(chain.getNrOfJoints());
    for (std::size_t i = 0; i < robot_.leg_joints[kRight].size(); ++i)
      joints(static_cast<unsigned>(i)) = q[robot_.leg_joints[kRight][i]];
    KDL::Frame foot;
    KDL::ChainFkSolverPos_recursive(chain).JntToCart(joints, foot);
    Eigen::Isometry3d T_BF = Eigen::Isometry3d::Identity();
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) T_BF.linear()(r, c) = foot.M(r, c);
    T_BF.translation() = Eigen::Vector3d(foot.p.x(), foot.p.y(), foot.p.z());
    Eigen::Isometry3d T_WF = Eigen::Isometry3d::Identity();  // turned by any yaw; its sole is at z = 0
    T_WF.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T_WF.translation().z() = -robot_.feet[kRight].sole_corners_F()[0].z();
    return T_WF * T_BF.inverse();
  }

 private:
  const model::RobotModel& robot_;
};

pmg_msgs::robot_state_t state_of(const JointVector& q, const JointVector& dq, const Eigen::Isometry3d& T_WB,
                                 const Eigen::Vector3d& omega_B, std::int64_t stamp_ns) {
  pmg_msgs::robot_state_t state{};
  state.stamp_ns = stamp_ns;
  state.joint_count = static_cast<std::int32_t>(q.size());
  state.q_rad.assign(q.data(), q.data() + q.size());
  state.dq_rad_s.assign(dq.data(), dq.data() + dq.size());
  const Eigen::Quaterniond R(T_WB.linear());
  const std::array orientation{R.w(), R.x(), R.y(), R.z()};
  std::copy(orientation.begin(), orientation.end(), state.orientation_WI);
  std::copy_n(omega_B.data(), 3, state.gyro_rad_s);
  return state;
}

class MeasuredMotionTest : public testing::Test {
 protected:
  MeasuredMotionTest() {
    news_.status.foot_load[kLeft] = 0.1;
    news_.status.foot_load[kRight] = 0.9;
    q_ = robot_.q_stand();
    dq_ = JointVector::Zero(q_.size());
    for (std::size_t i = 0; i < robot_.leg_joints[kRight].size(); ++i) {
      dq_[robot_.leg_joints[kRight][i]] = i % 2 == 0 ? 0.4 : -0.3;
      q_[robot_.leg_joints[kRight][i]] += i % 2 == 0 ? -0.05 : 0.06;
    }
  }
  const model::RobotModel& robot_ = test::biped();  // its IMU is aligned with its base
  MeasuredMotion motion_{robot_};
  ops::RobotNews news_;
  JointVector q_, dq_;
};

TEST_F(MeasuredMotionTest, ThePelvisMovesAsThePlantedFootSays) {
  const PlantedFoot foot(robot_);
  constexpr double kStep_s = 1e-5;
  const Eigen::Isometry3d now = foot.T_WB(q_), later = foot.T_WB(q_ + kStep_s * dq_);
  const Eigen::AngleAxisd turned(now.linear().transpose() * later.linear());
  const Eigen::Vector3d omega_B = turned.axis() * turned.angle() / kStep_s;
  news_.state = state_of(q_, dq_, now, omega_B, 1'000'000'000);
  motion_.take(news_);
  ASSERT_TRUE(motion_.channels());
  const Eigen::Vector3d forward = now.linear().col(0);
  const double yaw = std::atan2(forward.y(), forward.x());
  const Eigen::Matrix3d R_HW = Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d v_H = R_HW * (later.translation() - now.translation()) / kStep_s;
  const auto& u = *motion_.channels();
  EXPECT_GT(v_H.head<2>().norm(), 0.05) << "the case moves";
  EXPECT_NEAR(u[kVx], v_H.x(), 1e-4);
  EXPECT_NEAR(u[kVy], v_H.y(), 1e-4);
  EXPECT_NEAR(u[kOmega], (now.linear() * omega_B).z(), 1e-6);
  EXPECT_NEAR(u[kHeight], now.translation().z() - robot_.standing_height_m, 2e-3) << "of a sole that may be tilted";
}

TEST_F(MeasuredMotionTest, IsSmoothedOverHalfASecondAndBeginsAnewAfterAPause) {
  const PlantedFoot foot(robot_);
  const Eigen::Isometry3d T_WB = foot.T_WB(q_);
  const JointVector still = JointVector::Zero(q_.size());
  news_.state = state_of(q_, still, T_WB, Eigen::Vector3d::Zero(), 10'000'000);
  motion_.take(news_);
  for (int k = 2; k <= 51; ++k) {
    news_.state = state_of(q_, still, T_WB, T_WB.linear().transpose() * Eigen::Vector3d::UnitZ(), k * 10'000'000);
    motion_.take(news_);
  }
  EXPECT_NEAR((*motion_.channels())[kOmega], 1.0 - std::exp(-1.0), 1e-6);
  news_.state->stamp_ns += 2'000'000'000;
  motion_.take(news_);
  EXPECT_NEAR((*motion_.channels())[kOmega], 1.0, 1e-9);
}

TEST_F(MeasuredMotionTest, NothingIsMeasuredOfARobotThatHangsOrOfForeignNumbers) {
  const Eigen::Isometry3d T_WB = PlantedFoot(robot_).T_WB(q_);
  std::int64_t stamp_ns = 0;
  const auto measured = [&](auto spoil) {
    news_.state = state_of(q_, dq_, T_WB, Eigen::Vector3d::Zero(), ++stamp_ns);
    spoil(news_);
    motion_.take(news_);
    return motion_.channels().has_value();
  };
  EXPECT_TRUE(measured([](ops::RobotNews&) {}));
  EXPECT_FALSE(measured([](ops::RobotNews& news) { news.state->q_rad.pop_back(); }));
  EXPECT_FALSE(
      measured([](ops::RobotNews& news) { news.state->dq_rad_s[3] = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_FALSE(measured([](ops::RobotNews& news) { news.state->orientation_WI[0] = 3.0; }));
  EXPECT_FALSE(measured([](ops::RobotNews& news) { news.status.hanging = 1; }));
  news_.status.hanging = 0;
  EXPECT_FALSE(
      measured([](ops::RobotNews& news) { news.status.foot_load[kLeft] = news.status.foot_load[kRight] = -1; }));
}

}  // namespace
}  // namespace pmg::live_page
