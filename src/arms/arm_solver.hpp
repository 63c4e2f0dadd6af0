// One arm, one tick: the posture within reach of this tick that brings the palm nearest to its goal.
#pragma once

#include "arms/arm_chain.hpp"
#include "arms/near_pairs.hpp"

namespace pmg::arms {

struct ArmSolverOptions {
  int iterations = 12;                  ///< Levenberg-Marquardt, at most; fewer than 8 leave targets unreached
  double turn_m_per_rad = 0.2;          ///< a radian of orientation error weighs as much as so many metres
  double posture_m_per_rad = 0.005;     ///< a radian from the preferred posture: decides the elbow alone
  double clearance_weight = 3.0;        ///< a metre too close weighs as much as so many metres
  double limit_margin_rad = 0.0349066;  ///< kept from the joints' limits: 2 degrees, as clips do
  /// A tick that lowers the cost by less than this share, or turns no joint by as much, changes nothing: the arm rests.
  double still_share = 1e-5, still_rad = 1e-4;
};

/// The wish of one tick.
struct ArmGoal {
  const PalmPose* palm = nullptr;  ///< null: the posture alone counts
  ArmVector posture_rad;           ///< preferred
};

struct ArmSolution {
  ArmVector q_rad;
  double position_error_m = 0.0, turn_error_rad = 0.0;  ///< of the palm; 0 without one
  bool moved = false;
  bool at_speed = false;  ///< some joint moves by as much as a tick allows
  bool pushed = false;    ///< some other link is so near that it changes the posture
};

/// minimise over q: 1/2 (|p - p*|^2 + s^2 |log(R* R^T)|^2 + w^2 |q - q_posture|^2 + c^2 sum max(0, slow - d)^2)
/// within |q - q_last| <= step and the joints' ranges, no pair closer than NearPairs allows. s, w, c: the options'
/// weights. Levenberg-Marquardt; each step solves its quadratic model within the bounds by an active set, and is taken
/// only if the true cost drops. So targets out of reach come to rest, and nothing chatters. The solution depends on the
/// arguments alone.
class ArmSolver {
 public:
  ArmSolver(const ArmSolverOptions& options, ArmVector lower_rad, ArmVector upper_rad, ArmVector step_rad);

  /// (chain, posture of the last tick, goal, pairs collected there) => (solution). Leaves the chain at the solution.
  /// No heap, no exception.
  const ArmSolution& solve(ArmChain& chain, const ArmVector& q_last_rad, const ArmGoal& goal,
                           NearPairs& pairs) noexcept;

  const ArmVector& lower_rad() const noexcept { return lower_; }  ///< with the margin
  const ArmVector& upper_rad() const noexcept { return upper_; }
  const ArmVector& step_rad() const noexcept { return step_; }

 private:
  using Residual = Eigen::Matrix<double, 6, 1>;
  double cost(const ArmChain& chain, const ArmVector& q, const ArmGoal& goal, const NearPairs& pairs) noexcept;
  void linearise(const ArmChain& chain, const ArmVector& q, const ArmGoal& goal) noexcept;
  void model_step(double damping, const ArmVector& least, const ArmVector& most, const NearPairs& pairs) noexcept;
  bool bounded_step(const ArmVector& least, const ArmVector& most) noexcept;
  double weight(const ArmGoal& goal) const noexcept { return goal.palm != nullptr ? options_.posture_m_per_rad : 1.0; }

  ArmSolverOptions options_;
  ArmVector lower_, upper_, step_;
  Residual residual_;
  ArmMatrix H_, H_model_;
  ArmVector g_, g_model_, dq_;
  ArmSolution solution_;
};

}  // namespace pmg::arms
