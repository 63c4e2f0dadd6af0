// Both arms of a robot: from the palm poses that an operator sends to the arm joints' reference, tick by tick.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "arms/arm_setup.hpp"
#include "arms/arm_solver.hpp"
#include "arms/obstacles.hpp"
#include "arms/pose_filter.hpp"
#include "model/robot_model.hpp"

namespace pmg::arms {

/// What one arm does.
enum class ArmActivity : std::uint8_t {
  kReference = 0,   ///< the reference moves it, as ever
  kFollowing = 1,   ///< the palm is at its target, or on the way there
  kOutOfReach = 2,  ///< it rests as near to its target as its joints allow
  kBlocked = 3,     ///< another link of the robot is in its way: it comes no closer to that
  kHeld = 4,        ///< it stays where it is: no target is in force
  kReturning = 5,   ///< on the way back to the reference, which then moves it
};

struct ArmsOptions {
  ArmSolverOptions solver;
  ClearanceOptions clearance;
  PoseFilterOptions filter;
  double near_m = 0.005, near_rad = 0.03;  ///< a palm with smaller errors is at its target
};

/// What is known of one arm after a tick.
struct ArmReport {
  ArmActivity activity = ArmActivity::kReference;
  bool reached = false;                                 ///< its palm is at its target
  double position_error_m = 0.0, turn_error_rad = 0.0;  ///< palm to target; 0 without one in force
  PalmPose palm;                                        ///< where the arm's joints of the last step have it
};

/// Each arm is solved with the other one held where it is, left before right: together they would have to agree on
/// every step, and one blocked arm would stop both. No heap after construction, no exception in a tick.
class Arms {
 public:
  /// Throws std::invalid_argument if the URDF has collision meshes.
  Arms(const model::RobotModel& robot, const ArmSetup& setup, double dt_s, const ArmsOptions& options = {});

  /// The reference moves both arms again, at once: for a robot that isn't upright.
  void reset() noexcept;
  /// A target for this arm from now on; it moves there from where it is.
  void aim(Foot arm, const PalmPose& target) noexcept;
  void hold(Foot arm) noexcept;       ///< nothing, where the reference moves it
  void hand_back(Foot arm) noexcept;  ///< likewise

  /// (the reference's q, dq of all joints, one tick later) => (arm joints replaced where they aren't the reference's):
  /// each moves by no more than its step, stays within its range and clear of the robot's other links, whose posture is
  /// taken from the same q. [rad], [rad/s]
  void step(JointVector& q_ref, JointVector& dq_ref) noexcept;

  const ArmReport& report(Foot arm) const noexcept { return arms_[arm].report; }
  const ArmSolver& solver(Foot arm) const noexcept { return arms_[arm].solver; }
  const std::vector<int>& joints(Foot arm) const noexcept { return arms_[arm].chain.joints(); }
  bool active() const noexcept;  ///< some arm isn't the reference's

 private:
  struct Arm {
    ArmChain chain;
    ArmSolver solver;
    PoseFilter filter;
    NearPairs pairs;
    ArmVector q, stand;  ///< posture of the last tick; of a standing robot
    PalmPose target;
    bool aimed = false;
    ArmReport report;
  };
  Arm make_arm(const model::RobotModel& robot, const ArmSetup& setup, Foot side, double dt_s,
               const std::vector<LinkShape>& shapes, std::size_t others) const;
  void leave_out_neighbours(const model::RobotModel& robot);
  void place_others(Foot side) noexcept;
  void step(Foot side, JointVector& q_ref, JointVector& dq_ref) noexcept;
  ArmActivity activity_after(const ArmSolution& solution) const noexcept;

  ArmsOptions options_;
  double dt_s_;
  Obstacles obstacles_;
  PerArm<Arm> arms_;
  std::vector<Shape> others_;  ///< the obstacles, then the other arm
  std::vector<Ball> balls_;
};

}  // namespace pmg::arms
