#include "arms/arm_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <utility>

namespace pmg::arms {

namespace {

constexpr double kFirstDamping = 1e-5, kLeastDamping = 1e-9, kMostDamping = 1e3;
constexpr double kEasier = 0.2, kHarder = 10.0;
constexpr double kDone_rad = 1e-8;
constexpr double kNothing = 1e-16;  // of the cost [m^2]: 10 nm
constexpr int kPairRounds = 3;

}  // namespace

ArmSolver::ArmSolver(const ArmSolverOptions& options, ArmVector lower_rad, ArmVector upper_rad, ArmVector step_rad)
    : options_(options), lower_(std::move(lower_rad)), upper_(std::move(upper_rad)), step_(std::move(step_rad)) {
  lower_.array() += options_.limit_margin_rad;
  upper_.array() -= options_.limit_margin_rad;
}

double ArmSolver::cost(const ArmChain& chain, const ArmVector& q, const ArmGoal& goal,
                       const NearPairs& pairs) noexcept {
  residual_.setZero();
  if (goal.palm != nullptr) {
    residual_.head<3>() = chain.palm().p_m - goal.palm->p_m;
    residual_.tail<3>() = options_.turn_m_per_rad * turn_between(goal.palm->R, chain.palm().R);
  }
  const double w = weight(goal);
  double sum = residual_.squaredNorm() + w * w * (q - goal.posture_rad).squaredNorm();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double close_m = std::max(0.0, pairs.slow_m() - pairs[i].distance_m);
    sum += options_.clearance_weight * options_.clearance_weight * close_m * close_m;
  }
  return 0.5 * sum;
}

void ArmSolver::linearise(const ArmChain& chain, const ArmVector& q, const ArmGoal& goal) noexcept {
  const Eigen::Index n = chain.size();
  const double w = weight(goal);
  H_.setZero(n, n);
  g_ = w * w * (q - goal.posture_rad);
  if (goal.palm != nullptr) {
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxArmJoints> J(6, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      J.col(i).head<3>() = chain.lever(i, chain.palm().p_m);
      J.col(i).tail<3>() = options_.turn_m_per_rad * chain.axis(i);
    }
    H_.noalias() = J.transpose().lazyProduct(J);
    g_.noalias() += J.transpose().lazyProduct(residual_);
  }
  H_.diagonal().array() += w * w;
}

bool ArmSolver::bounded_step(const ArmVector& least, const ArmVector& most) noexcept {
  const Eigen::Index n = g_model_.size();
  std::array<bool, kMaxArmJoints> fixed{};
  dq_.setZero(n);
  ArmMatrix A(n, n);
  ArmVector b(n);
  for (Eigen::Index round = 0; round <= n; ++round) {
    // Joints at a bound stay there; the others minimise the rest.
    A = H_model_;
    b = -g_model_;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!fixed[static_cast<std::size_t>(i)]) continue;
      b -= dq_[i] * H_model_.col(i);
      A.row(i).setZero();
      A.col(i).setZero();
      A(i, i) = 1.0;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      if (fixed[static_cast<std::size_t>(i)]) b[i] = dq_[i];
    }
    const Eigen::LLT<ArmMatrix> factor(A);
    if (factor.info() != Eigen::Success) return false;
    const ArmVector x = factor.solve(b);
    Eigen::Index worst = -1;
    double beyond = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (fixed[static_cast<std::size_t>(i)]) continue;
      const double out = std::max(least[i] - x[i], x[i] - most[i]);
      if (out > beyond) {
        beyond = out;
        worst = i;
      }
      dq_[i] = x[i];
    }
    if (worst < 0) return dq_.allFinite();
    dq_[worst] = std::clamp(x[worst], least[worst], most[worst]);
    fixed[static_cast<std::size_t>(worst)] = true;
  }
  return dq_.allFinite();
}

void ArmSolver::model_step(double damping, const ArmVector& least, const ArmVector& most,
                           const NearPairs& pairs) noexcept {
  // A pair counts if it is too close, or if the step without it would make it so.
  std::array<bool, 64> counts{};
  const double c2 = options_.clearance_weight * options_.clearance_weight;
  dq_.setZero(g_.size());
  for (int round = 0; round < kPairRounds; ++round) {
    bool more = round == 0;
    for (std::size_t i = 0; i < std::min(pairs.size(), counts.size()); ++i) {
      if (counts[i] || pairs[i].distance_m + pairs[i].slope_m_per_rad.dot(dq_) >= pairs.slow_m()) continue;
      counts[i] = more = true;
    }
    if (!more) return;
    H_model_ = H_;
    g_model_ = g_;
    H_model_.diagonal().array() += damping;
    for (std::size_t i = 0; i < std::min(pairs.size(), counts.size()); ++i) {
      if (!counts[i]) continue;
      const ArmVector& slope = pairs[i].slope_m_per_rad;
      H_model_.noalias() += c2 * slope.lazyProduct(slope.transpose());
      g_model_ -= c2 * (pairs.slow_m() - pairs[i].distance_m) * slope;
    }
    if (!bounded_step(least, most)) {
      dq_.setZero();
      return;
    }
  }
}

const ArmSolution& ArmSolver::solve(ArmChain& chain, const ArmVector& q_last_rad, const ArmGoal& goal,
                                    NearPairs& pairs) noexcept {
  // A joint that starts beyond its range may stay or come back.
  const ArmVector low = (q_last_rad - step_).cwiseMax(lower_).cwiseMin(q_last_rad);
  const ArmVector high = (q_last_rad + step_).cwiseMin(upper_).cwiseMax(q_last_rad);
  ArmVector q = q_last_rad;
  chain.compute(q);
  pairs.look(chain);
  const double first = cost(chain, q, goal, pairs);
  double lowest = first, damping = kFirstDamping;
  linearise(chain, q, goal);
  for (int i = 0; i < options_.iterations && damping < kMostDamping; ++i) {
    model_step(damping, low - q, high - q, pairs);
    const ArmVector trial = (q + dq_).cwiseMax(low).cwiseMin(high);
    const double farthest = (trial - q).cwiseAbs().maxCoeff();
    if (farthest < kDone_rad) break;
    chain.compute(trial);
    const bool allowed = pairs.look(chain);
    const double now = cost(chain, trial, goal, pairs);
    if (allowed && now < lowest) {
      const bool done = lowest - now < 0.1 * options_.still_share * lowest + kNothing;
      lowest = now;
      q = trial;
      damping = std::max(kLeastDamping, damping * kEasier);
      if (done) break;
      linearise(chain, q, goal);
    } else {
      damping *= kHarder;
      chain.compute(q);
      pairs.look(chain);
    }
  }
  const bool hardly = goal.palm != nullptr && (q - q_last_rad).cwiseAbs().maxCoeff() < options_.still_rad;
  if (hardly || first - lowest <= options_.still_share * first + kNothing) q = q_last_rad;
  chain.compute(q);
  pairs.look(chain);
  cost(chain, q, goal, pairs);
  solution_.q_rad = q;
  solution_.position_error_m = residual_.head<3>().norm();
  solution_.turn_error_rad = residual_.tail<3>().norm() / options_.turn_m_per_rad;
  solution_.moved = q != q_last_rad;
  solution_.at_speed = ((q - q_last_rad).cwiseAbs().array() >= 0.999 * step_.array()).any();
  solution_.pushed = false;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    solution_.pushed = solution_.pushed || pairs[i].distance_m < pairs.slow_m();
  return solution_;
}

}  // namespace pmg::arms
