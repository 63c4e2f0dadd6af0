#include "retargeting/arm_imitation.hpp"

#include <ceres/dynamic_numeric_diff_cost_function.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "model/leg_kinematics.hpp"
#include "pmg/periodic_slopes.hpp"
#include "retargeting/arm_points.hpp"
#include "retargeting/fit_angles.hpp"
#include "retargeting/link_capsules.hpp"

namespace pmg::retargeting {
namespace {

std::vector<std::string> legs_and_pelvis(const model::RobotModel& robot, const generator::JointRoles& roles) {
  std::vector<std::string> links = {robot.base_link};
  for (const Foot foot : {kLeft, kRight}) {
    const std::vector<std::string> leg = links_below(robot, roles.leg[foot][0]);
    links.insert(links.end(), leg.begin(), leg.end());
  }
  return links;
}

/// Arm of one side and what it must keep away from.
struct Arm {
  Arm(const model::RobotModel& robot, const generator::JointRoles& roles, Foot side, ArmChain arm)
      : chain(std::move(arm)), lower(robot, links_below(robot, *roles.elbow[side])) {}
  ArmChain chain;
  LinkCapsules lower;  ///< forearm and hand
};

/// One sample; parameters: the arm's joints.
class ArmResiduals {
 public:
  ArmResiduals(Arm& arm, const std::vector<int>& joints, const SidePose& human, const Eigen::Matrix3d& R_HB,
               const std::vector<Capsule>& away, const JointVector& q, std::vector<double> before)
      : arm_(arm), joints_(joints), human_(human), R_HB_(R_HB), away_(away), q_(q), before_(std::move(before)) {}

  int count() const { return 7 + static_cast<int>(joints_.size()); }

  bool operator()(double const* const* parameters, double* residual) const {
    JointVector q = q_;
    for (std::size_t i = 0; i < joints_.size(); ++i) q[joints_[i]] = parameters[0][i];
    const ArmPoints points = arm_.chain.compute(q);
    const Eigen::Vector3d upper = R_HB_ * (points.elbow - points.shoulder).normalized();
    const Eigen::Vector3d lower = R_HB_ * (points.wrist - points.elbow).normalized();
    for (Eigen::Index i = 0; i < 3; ++i) {
      residual[i] = upper[i] - human_.upper_arm[i];
      residual[3 + i] = lower[i] - human_.forearm[i];
    }
    double short_m = 0.0;
    for (const Capsule& part : arm_.lower.compute(q)) {
      for (const Capsule& other : away_) short_m += std::max(0.0, kArmClearance_m - distance_m(part, other));
    }
    constexpr double kApart_per_m = 30.0;  // 1 cm outweighs 0.3 rad
    residual[6] = kApart_per_m * short_m;
    constexpr double kNear = 0.1;  // a straight arm leaves the shoulder's yaw open
    for (std::size_t i = 0; i < joints_.size(); ++i) residual[7 + i] = kNear * (parameters[0][i] - before_[i]);
    return true;
  }

 private:
  Arm& arm_;
  const std::vector<int>& joints_;
  const SidePose& human_;
  const Eigen::Matrix3d& R_HB_;
  const std::vector<Capsule>& away_;
  const JointVector& q_;
  std::vector<double> before_;
};

void solve(const model::RobotModel& robot, const std::vector<int>& joints, double margin_rad,
           const ArmResiduals& residuals, std::vector<double>& angles) {
  using Cost = ceres::DynamicNumericDiffCostFunction<const ArmResiduals, ceres::CENTRAL>;
  auto* cost = new Cost(&residuals, ceres::DO_NOT_TAKE_OWNERSHIP);
  cost->AddParameterBlock(static_cast<int>(joints.size()));
  cost->SetNumResiduals(residuals.count());
  Eigen::VectorXd lower(joints.size()), upper(joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(joints[i])];
    lower[static_cast<Eigen::Index>(i)] = joint.lower_rad + margin_rad;
    upper[static_cast<Eigen::Index>(i)] = joint.upper_rad - margin_rad;
  }
  fit_angles(cost, lower, upper, angles.data());
}

}  // namespace

void imitate_arms(const model::RobotModel& robot, const generator::JointRoles& roles, const HumanCycle& human,
                  double margin_rad, DynamicClip& clip) {
  if (!human.pose.front().arms_known) return;
  LinkCapsules away(robot, legs_and_pelvis(robot, roles));
  model::BaseAttitude attitude(robot);
  const JointVector zero = JointVector::Zero(robot.q_stand().size());
  for (const Foot side : {kLeft, kRight}) {
    std::optional<ArmChain> chain = ArmChain::of(robot, roles, side);
    if (!chain) continue;
    const std::vector<int> joints = chain->joints();
    Arm arm(robot, roles, side, *std::move(chain));
    std::vector<double> angles;
    for (const int joint : joints) angles.push_back(clip.q.front()[joint]);
    constexpr int kRounds = 2;  // the second one begins where the first one ended: the ends meet
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t k = 0; k < clip.q.size(); ++k) {
        JointVector& q = clip.q[k];
        const Eigen::Matrix3d R_HB = attitude.compute(q, zero, 0.0, 0.0, 0.0, 0.0).R_HB;
        solve(robot, joints, margin_rad,
              ArmResiduals(arm, joints, human.pose[k].side[side], R_HB, away.compute(q), q, angles), angles);
        for (std::size_t i = 0; i < joints.size(); ++i) q[joints[i]] = angles[i];
      }
    }
  }
  clip.dq_dphi = periodic_spline_slopes(clip.q);
}

double arm_clearance_m(const model::RobotModel& robot, const generator::JointRoles& roles, const DynamicClip& clip) {
  LinkCapsules away(robot, legs_and_pelvis(robot, roles));
  double smallest_m = std::numeric_limits<double>::infinity();
  for (const Foot side : {kLeft, kRight}) {
    if (!roles.elbow[side]) continue;
    LinkCapsules lower(robot, links_below(robot, *roles.elbow[side]));
    for (const JointVector& q : clip.q) {
      for (const Capsule& part : lower.compute(q)) {
        for (const Capsule& other : away.compute(q)) smallest_m = std::min(smallest_m, distance_m(part, other));
      }
    }
  }
  return smallest_m;
}

}  // namespace pmg::retargeting
