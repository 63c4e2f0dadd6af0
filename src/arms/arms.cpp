#include "arms/arms.hpp"

#include <algorithm>

namespace pmg::arms {

namespace {

constexpr double kReturned_rad = 1e-6;

Foot other(Foot side) noexcept { return side == kLeft ? kRight : kLeft; }

std::vector<std::string> arm_links(const ArmSetup& setup) {
  std::vector<std::string> links;
  for (const PalmSetup& palm : setup.palm) {
    for (const KDL::Segment& segment : palm.chain.segments) links.push_back(segment.getName());
  }
  return links;
}

/// (values of all joints) => (those of an arm).
ArmVector of_arm(const JointVector& all, const std::vector<int>& joints) noexcept {
  ArmVector mine(static_cast<Eigen::Index>(joints.size()));
  for (std::size_t i = 0; i < joints.size(); ++i) mine[static_cast<Eigen::Index>(i)] = all[joints[i]];
  return mine;
}

ArmVector steps_rad(const model::RobotModel& robot, const ArmSetup& setup, Foot side, double dt_s) {
  ArmVector steps(static_cast<Eigen::Index>(setup.palm[side].joints.size()));
  for (std::size_t i = 0; i < setup.palm[side].joints.size(); ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(setup.palm[side].joints[i])];
    steps[static_cast<Eigen::Index>(i)] = dt_s * std::min(setup.speed_rad_s, joint.velocity_limit_rad_s);
  }
  return steps;
}

}  // namespace

Arms::Arms(const model::RobotModel& robot, const ArmSetup& setup, double dt_s, const ArmsOptions& options)
    : options_(options),
      dt_s_(dt_s),
      obstacles_(robot, link_shapes(robot), arm_links(setup)),
      arms_{make_arm(robot, setup, kLeft, dt_s, link_shapes(robot),
                     obstacles_.shapes().size() + ArmChain(setup.palm[kRight], link_shapes(robot)).bodies().size()),
            make_arm(robot, setup, kRight, dt_s, link_shapes(robot),
                     obstacles_.shapes().size() + ArmChain(setup.palm[kLeft], link_shapes(robot)).bodies().size())} {
  const std::size_t most =
      obstacles_.shapes().size() + std::max(arms_[kLeft].chain.bodies().size(), arms_[kRight].chain.bodies().size());
  others_.reserve(most);
  balls_.reserve(most);
  leave_out_neighbours(robot);
}

Arms::Arm Arms::make_arm(const model::RobotModel& robot, const ArmSetup& setup, Foot side, double dt_s,
                         const std::vector<LinkShape>& shapes, std::size_t others) const {
  ArmChain chain(setup.palm[side], shapes);
  const ArmVector step = steps_rad(robot, setup, side, dt_s);
  NearPairs pairs(chain, step, others, options_.clearance);
  ArmSolver solver(options_.solver, of_arm(robot.q_lower(), chain.joints()), of_arm(robot.q_upper(), chain.joints()),
                   step);
  const ArmVector stand = of_arm(robot.q_stand(), chain.joints());
  return {.chain = std::move(chain),
          .solver = std::move(solver),
          .filter = PoseFilter(options_.filter, dt_s),
          .pairs = std::move(pairs),
          .q = stand,
          .stand = stand,
          .target = {},
          .report = {}};
}

void Arms::leave_out_neighbours(const model::RobotModel& robot) {
  obstacles_.compute(robot.q_stand());
  for (Arm& arm : arms_) arm.chain.compute(arm.stand);
  for (const Foot side : {kLeft, kRight}) {
    place_others(side);
    Arm& arm = arms_[side];
    for (std::size_t body = 0; body < arm.chain.bodies().size(); ++body) {
      for (std::size_t i = 0; i < others_.size(); ++i) {
        if (clearance(arm.chain.capsules()[body], others_[i]).distance_m < options_.clearance.slow_m)
          arm.pairs.leave_out(body, i);
      }
    }
  }
}

void Arms::place_others(Foot side) noexcept {
  others_ = obstacles_.shapes();
  balls_ = obstacles_.balls();
  for (const Capsule& capsule : arms_[other(side)].chain.capsules()) {
    others_.push_back(capsule);
    balls_.push_back(ball_around(capsule));
  }
}

void Arms::reset() noexcept {
  for (Arm& arm : arms_) {
    arm.aimed = false;
    arm.report.activity = ArmActivity::kReference;
  }
}

void Arms::aim(Foot side, const PalmPose& target) noexcept {
  Arm& arm = arms_[side];
  if (!arm.aimed) {
    arm.chain.compute(arm.q);
    arm.filter.start(arm.chain.palm());
  }
  arm.aimed = true;
  arm.target = target;
  arm.report.activity = ArmActivity::kFollowing;
}

void Arms::hold(Foot side) noexcept {
  Arm& arm = arms_[side];
  if (arm.report.activity == ArmActivity::kReference) return;
  arm.aimed = false;
  arm.report.activity = ArmActivity::kHeld;
}

void Arms::hand_back(Foot side) noexcept {
  Arm& arm = arms_[side];
  if (arm.report.activity == ArmActivity::kReference) return;
  arm.aimed = false;
  arm.report.activity = ArmActivity::kReturning;
}

bool Arms::active() const noexcept {
  return std::ranges::any_of(arms_, [](const Arm& arm) { return arm.report.activity != ArmActivity::kReference; });
}

void Arms::step(JointVector& q_ref, JointVector& dq_ref) noexcept {
  const bool moves = active();
  if (moves) {
    obstacles_.compute(q_ref);
    for (const Foot side : {kLeft, kRight}) {
      Arm& arm = arms_[side];
      if (arm.report.activity == ArmActivity::kReference) arm.q = of_arm(q_ref, arm.chain.joints());
      arm.chain.compute(arm.q);
    }
  }
  for (const Foot side : {kLeft, kRight}) step(side, q_ref, dq_ref);
}

void Arms::step(Foot side, JointVector& q_ref, JointVector& dq_ref) noexcept {
  Arm& arm = arms_[side];
  const std::vector<int>& joints = arm.chain.joints();
  arm.report.position_error_m = arm.report.turn_error_rad = 0.0;
  arm.report.reached = false;
  if (arm.report.activity == ArmActivity::kReference) {
    arm.q = of_arm(q_ref, joints);
    arm.chain.compute(arm.q);
    arm.report.palm = arm.chain.palm();
    return;
  }
  if (arm.report.activity != ArmActivity::kHeld) {
    place_others(side);
    arm.pairs.collect(arm.chain, others_, balls_);
    ArmGoal goal{.palm = nullptr, .posture_rad = arm.stand};
    if (arm.aimed) {
      goal.palm = &arm.filter.step(arm.target);
    } else {
      goal.posture_rad = of_arm(q_ref, joints);
    }
    const ArmVector before = arm.q;
    const ArmSolution& solution = arm.solver.solve(arm.chain, before, goal, arm.pairs);
    arm.q = solution.q_rad;
    if (arm.aimed) {
      arm.report.activity = activity_after(solution);
    } else if ((arm.q - goal.posture_rad).cwiseAbs().maxCoeff() < kReturned_rad) {
      arm.report.activity = ArmActivity::kReference;
    }
    arm.report.position_error_m = solution.position_error_m;
    arm.report.turn_error_rad = solution.turn_error_rad;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto mine = static_cast<Eigen::Index>(i);
      dq_ref[joints[i]] = (arm.q[mine] - before[mine]) / dt_s_;
    }
  } else {
    for (const int joint : joints) dq_ref[joint] = 0.0;
  }
  for (std::size_t i = 0; i < joints.size(); ++i) q_ref[joints[i]] = arm.q[static_cast<Eigen::Index>(i)];
  arm.report.palm = arm.chain.palm();
  if (arm.aimed) {
    arm.report.reached = (arm.target.p_m - arm.report.palm.p_m).norm() < options_.near_m &&
                         turn_between(arm.report.palm.R, arm.target.R).norm() < options_.near_rad;
  }
}

ArmActivity Arms::activity_after(const ArmSolution& solution) const noexcept {
  const bool near = solution.position_error_m < options_.near_m && solution.turn_error_rad < options_.near_rad;
  if (near || solution.at_speed) return ArmActivity::kFollowing;
  return solution.pushed ? ArmActivity::kBlocked : ArmActivity::kOutOfReach;
}

}  // namespace pmg::arms
