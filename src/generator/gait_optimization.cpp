// One optimisation problem: its unknowns, costs and rounds share the table of
// knots.
#include "generator/gait_optimization.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "files/config_error.hpp"
#include "generator/gait_measure.hpp"
#include "generator/gait_residuals.hpp"
#include "generator/ground_cost.hpp"

namespace pmg::generator {
namespace {

constexpr std::size_t kKnots = 24;        // even: half a cycle is a whole number of knots
constexpr double kEdgeBeyond = 0.005;     // [cycles]; duty factors of the clips in a mixture differ by as much
constexpr double kClearanceGrowth = 1.6;  // exponent of the gain: half the gain needs 0.5^1.6, a third of the clearance

/// The knots of both legs. The right leg of a symmetric gait uses the left leg's.
struct KnotTable {
  std::vector<std::array<double, kLegJoints>> left, right;
  PerFoot<std::array<double, kLegJoints>> bias{};  // mean posture minus the reference's
  bool symmetric;

  explicit KnotTable(bool is_symmetric) : left(kKnots), right(is_symmetric ? 0 : kKnots), symmetric(is_symmetric) {}
  double* knot(Foot foot, std::size_t i) { return (foot == kRight && !symmetric) ? right[i].data() : left[i].data(); }
};

/// The other residuals pull the mean velocity away from its target. The correction moves the target until the mean is
/// right, by the secant through the last two solves.
struct VelocityTarget {
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();

  void correct(const Eigen::Vector3d& missed) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double won = missed_before_[i] - missed[i];
      const double ratio = step_[i] != 0.0 && won / step_[i] > 0.2 ? std::min(step_[i] / won, 5.0) : 1.5;
      step_[i] = ratio * missed[i];
    }
    missed_before_ = missed;
    correction += step_;
  }

 private:
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero(), missed_before_ = Eigen::Vector3d::Zero();
};

double own_phase(double phase, Foot foot, bool symmetric) {
  return (foot == kRight && symmetric) ? phase + 0.5 : phase;
}

void start_from_reference(const RobotLegs& legs, const GaitTask& task, KnotTable& table) {
  for (const Foot foot : {kLeft, kRight}) {
    if (foot == kRight && task.symmetric) {
      continue;
    }
    for (std::size_t i = 0; i < kKnots; ++i) {
      const std::size_t sample = i * kClipSamples / kKnots;
      for (std::size_t j = 0; j < kLegJoints; ++j) {
        const auto joint = static_cast<Eigen::Index>(j);
        table.knot(foot, i)[j] = task.reference[sample][foot][joint] - legs.stand[foot][joint];
      }
    }
  }
}

/// Softplus: width log(1 + exp(excess / width)) and its slope. 0 within the allowance, slope 1 far beyond it.
std::pair<double, double> beyond(double excess, double width) {
  const double z = excess / width;
  return {width * (z > 30.0 ? z : std::log1p(std::exp(z))), 1.0 / (1.0 + std::exp(-z))};
}

/// Three residuals of one joint's curve over all knots of the left leg: correlation with the reference, RMS distance
/// from it, and amplitude as a share of the reference's.
class ShapeCost : public ceres::CostFunction {
 public:
  ShapeCost(const RobotLegs& legs, const GaitTask& task, const ShapeGoal& goal)
      : goal_(goal), weights_(task.weights), stand_(legs.stand[kLeft][static_cast<Eigen::Index>(goal.role)]) {
    set_num_residuals(kResiduals);
    mutable_parameter_block_sizes()->assign(kKnots, kLegJoints);
    for (std::size_t k = 0; k < kClipSamples; ++k) {
      reference_[static_cast<Eigen::Index>(k)] = task.reference[k][kLeft][static_cast<Eigen::Index>(goal.role)];
      const SplineBasis basis = spline_basis(static_cast<double>(k) / static_cast<double>(kClipSamples), kKnots);
      for (std::size_t i = 0; i < 4; ++i) {
        basis_(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(basis.knot[i])) += basis.value[i];
      }
    }
  }

  bool Evaluate(const double* const* knots, double* residual, double** jacobian) const override {
    Eigen::Matrix<double, kKnots, 1> knot;
    for (std::size_t i = 0; i < kKnots; ++i) {
      knot[static_cast<Eigen::Index>(i)] = knots[i][goal_.role];
    }
    const Curve q = (basis_ * knot).array() + stand_;
    const Curve e = q - reference_;
    const double rms = std::sqrt(e.squaredNorm() / static_cast<double>(kClipSamples));
    const Curve a = q.array() - q.mean();
    const Curve b = reference_.array() - reference_.mean();
    const double norms = a.norm() * b.norm();
    const double correlation = a.dot(b) / norms;
    const double amplitude = a.dot(b) / b.squaredNorm();
    constexpr double kCorrelationWidth = 0.0015;
    constexpr double kRmsWidth_rad = 0.003;
    constexpr double kAmplitudeWidth = 0.01;
    const auto [short_of, short_slope] = beyond(goal_.correlation - correlation, kCorrelationWidth);
    const auto [over, over_slope] = beyond(rms - goal_.rms_rad, kRmsWidth_rad);
    const auto [small, small_slope] = beyond(goal_.amplitude - amplitude, kAmplitudeWidth);
    residual[0] = weights_.correlation * short_of;
    residual[1] = weights_.rms * over;
    residual[2] = weights_.amplitude * small;
    if (jacobian != nullptr) {
      const Curve slope = b / norms - correlation / a.squaredNorm() * a;  // has mean zero
      const Eigen::Matrix<double, kKnots, 1> d0 = -weights_.correlation * short_slope * (basis_.transpose() * slope);
      const Eigen::Matrix<double, kKnots, 1> d1 =
          weights_.rms * over_slope / (rms * static_cast<double>(kClipSamples)) * (basis_.transpose() * e);
      const Eigen::Matrix<double, kKnots, 1> d2 =
          -weights_.amplitude * small_slope / b.squaredNorm() * (basis_.transpose() * b);
      for (std::size_t i = 0; i < kKnots; ++i) {
        if (jacobian[i] != nullptr) {
          Eigen::Map<Eigen::Matrix<double, kResiduals, kLegJoints, Eigen::RowMajor>> J(jacobian[i]);
          J.setZero();
          J(0, static_cast<Eigen::Index>(goal_.role)) = d0[static_cast<Eigen::Index>(i)];
          J(1, static_cast<Eigen::Index>(goal_.role)) = d1[static_cast<Eigen::Index>(i)];
          J(2, static_cast<Eigen::Index>(goal_.role)) = d2[static_cast<Eigen::Index>(i)];
        }
      }
    }
    return true;
  }

 private:
  static constexpr int kResiduals = 3;
  using Curve = Eigen::Matrix<double, kClipSamples, 1>;
  ShapeGoal goal_;
  GaitWeights weights_;
  double stand_;
  Curve reference_ = Curve::Zero();
  Eigen::Matrix<double, kClipSamples, kKnots> basis_ = Eigen::Matrix<double, kClipSamples, kKnots>::Zero();
};

void add_residuals(const RobotLegs& legs, const GaitTask& task, const std::vector<VelocityTarget>& targets,
                   KnotTable& table, ceres::Problem& problem) {
  for (std::size_t s = 0; s < task.scenarios.size(); ++s) {
    for (std::size_t sample = 0; sample < kClipSamples; ++sample) {
      const double phase = static_cast<double>(sample) / static_cast<double>(kClipSamples);
      std::vector<double*> blocks;
      for (const Foot foot : {kLeft, kRight}) {
        for (const std::size_t k : spline_basis(own_phase(phase, foot, task.symmetric), kKnots).knot) {
          blocks.push_back(table.knot(foot, k));
        }
      }
      problem.AddResidualBlock(
          new GroundCost(GroundResiduals(legs, task, task.scenarios[s], phase, sample, kKnots, targets[s].correction)),
          nullptr, blocks);
    }
  }
  for (const ShapeGoal& goal : task.shape) {
    std::vector<double*> blocks;
    for (std::size_t i = 0; i < kKnots; ++i) {
      blocks.push_back(table.knot(kLeft, i));
    }
    problem.AddResidualBlock(new ShapeCost(legs, task, goal), nullptr, blocks);
  }
  for (const Foot foot : {kLeft, kRight}) {
    if (foot == kRight && task.symmetric) {
      continue;
    }
    for (std::size_t sample = 0; sample < kClipSamples; ++sample) {
      const double phase = static_cast<double>(sample) / static_cast<double>(kClipSamples);
      const SplineBasis basis = spline_basis(phase, kKnots);
      using Cost = ceres::AutoDiffCostFunction<PostureResiduals, 2 * kLegJoints, kLegJoints, kLegJoints, kLegJoints,
                                               kLegJoints, kLegJoints>;
      problem.AddResidualBlock(new Cost(new PostureResiduals(legs, task, foot, sample, kKnots)), nullptr,
                               table.knot(foot, basis.knot[0]), table.knot(foot, basis.knot[1]),
                               table.knot(foot, basis.knot[2]), table.knot(foot, basis.knot[3]),
                               table.bias[foot].data());
    }
    using BiasCost = ceres::AutoDiffCostFunction<BiasResiduals, kLegJoints, kLegJoints>;
    problem.AddResidualBlock(new BiasCost(new BiasResiduals{task.weights.bias}), nullptr, table.bias[foot].data());
    for (std::size_t i = 0; i < kKnots; ++i) {
      using Cost = ceres::AutoDiffCostFunction<SmoothResiduals, kLegJoints, kLegJoints, kLegJoints, kLegJoints>;
      const double per_knot = task.weights.smooth * static_cast<double>(kKnots * kKnots);
      problem.AddResidualBlock(new Cost(new SmoothResiduals{per_knot}), nullptr,
                               table.knot(foot, (i + kKnots - 1) % kKnots), table.knot(foot, i),
                               table.knot(foot, (i + 1) % kKnots));
    }
  }
}

/// 0 at both ends of the swing, 1 from 0.3 to 0.7 of it: min((sin(pi s) / sin(0.3 pi))^2, 1); in the second half the
/// exponent is `landing`.
double raised(double swing, double landing) {
  const double rise = std::sin(std::numbers::pi * swing) / std::sin(0.3 * std::numbers::pi);
  return std::min(std::pow(std::max(rise, 0.0), swing < 0.5 ? 2.0 : landing), 1.0);
}

LegTrajectory sample_legs(const RobotLegs& legs, bool symmetric, KnotTable& table) {
  LegTrajectory out;
  for (std::size_t sample = 0; sample < kClipSamples; ++sample) {
    const double phase = static_cast<double>(sample) / static_cast<double>(kClipSamples);
    LegPose q = legs.stand;
    LegPose dq = {LegVector<double>::Zero(), LegVector<double>::Zero()};
    for (const Foot foot : {kLeft, kRight}) {
      const SplineBasis basis = spline_basis(own_phase(phase, foot, symmetric), kKnots);
      for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Map<const LegVector<double>> knot(table.knot(foot, basis.knot[k]));
        const LegVector<double> signed_knot = foot == kRight && symmetric
                                                  ? LegVector<double>(knot.cwiseProduct(legs.mirror_sign))
                                                  : LegVector<double>(knot);
        q[foot] += basis.value[k] * signed_knot;
        dq[foot] += basis.slope[k] * signed_knot;
      }
    }
    out.q.push_back(q);
    out.dq_dphi.push_back(dq);
  }
  return out;
}

/// Tells after every iteration, and ends the solver where progress is over.
class ProgressCallback : public ceres::IterationCallback {
 public:
  explicit ProgressCallback(const work::Progress& progress) : progress_(progress) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return progress_(work::kUnknownShare) ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }

 private:
  const work::Progress& progress_;
};

}  // namespace

RobotLegs robot_legs(const model::RobotModel& robot, const JointRoles& roles) {
  RobotLegs legs;
  legs.standing_height_m = robot.standing_height_m;
  for (const Foot foot : {kLeft, kRight}) {
    legs.geometry[foot] = leg_geometry(robot, roles, foot);
    for (std::size_t role = 0; role < kLegJoints; ++role) {
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(roles.leg[foot][role])];
      const auto i = static_cast<Eigen::Index>(role);
      legs.stand[foot][i] = joint.stand_rad;
      legs.lower[foot][i] = joint.lower_rad;
      legs.upper[foot][i] = joint.upper_rad;
    }
  }
  for (std::size_t role = 0; role < kLegJoints; ++role) {
    const auto left = static_cast<std::size_t>(roles.leg[kLeft][role]);
    if (robot.mirror.partner[left] != roles.leg[kRight][role]) {
      throw files::ConfigError((robot.directory / "robot.yaml").string() + ": " + robot.joints[left].name +
                               ": its mirror image isn't the right leg's joint; expected symmetric legs");
    }
    legs.mirror_sign[static_cast<Eigen::Index>(role)] = robot.mirror.sign[left];
  }
  return legs;
}

GroundResiduals::GroundResiduals(const RobotLegs& legs, const GaitTask& task, const Scenario& scenario, double phase,
                                 std::size_t sample, std::size_t knots, const Eigen::Vector3d& velocity_correction)
    : legs_(legs), task_(task), scenario_(scenario) {
  const double r = task.duty_factor;
  PerFoot<double> wide{};
  for (const Foot foot : {kLeft, kRight}) {
    basis_[foot] = spline_basis(own_phase(phase, foot, task.symmetric), knots);
    sign_[foot] = foot == kRight && task.symmetric ? legs.mirror_sign : LegVector<double>::Ones();
    base_q_[foot] = legs.stand[foot];
    base_dq_dphi_[foot].setZero();
    const Addition& addition = scenario.addition;
    if (!addition.q.empty()) {
      base_q_[foot] += addition.q[sample % addition.q.size()][foot];
    }
    if (!addition.dq_dphi.empty()) {
      base_dq_dphi_[foot] += addition.dq_dphi[sample % addition.dq_dphi.size()][foot];
    }
    const double s = stance_phase(phase, foot, r);
    contact_[foot] = contact_weight(s, r);
    wide[foot] = contact_weight(s, r + 2.0 * kEdgeBeyond);
    const double in_stance = s / r + 0.5;
    flat_[foot] = in_stance >= task.flat_from && in_stance <= task.flat_to ? 1.0 : 0.0;
    const double since_contact = s + 0.5 * r;
    sole_[foot] = since_contact >= task.sole_from && since_contact <= task.sole_to ? 1.0 : 0.0;
    const double swing = std::abs(s) > 0.5 * r ? (s > 0 ? s - 0.5 * r : s + 1.0 - 0.5 * r) / (1.0 - r) : 0.0;
    lifted_[foot] = std::abs(s) > 0.5 * r ? 1.0 - 2.0 * contact_[foot] : 0.0;
    clearance_m_[foot] = std::pow(scenario.lift > 0.0 ? scenario.lift : scenario.gain, kClearanceGrowth) *
                         task.clearance_m * raised(swing, task.landing);
  }
  const Roll own = hike(task, phase);
  const Roll added = scenario.addition.roll.empty() ? Roll{} : scenario.addition.roll[sample];
  R_HB_ =
      Eigen::AngleAxisd(scenario.gain * own.angle_rad + added.angle_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  omega_HB_ = (scenario.gain * own.slope_rad + added.slope_rad) / task.period_s * Eigen::Vector3d::UnitX();
  near_both_ = std::sqrt(wide[kLeft] * wide[kRight]);
  scale_ = std::sqrt(scenario.weight / static_cast<double>(kClipSamples));
  height_m_ = legs.standing_height_m + scenario.gain * task.height_m + scenario.addition.height_m;
  velocity_ = scenario.gain * task.velocity + scenario.addition.velocity + velocity_correction;
  // The base sways towards the left foot in the middle of its stance, and towards the right half a cycle later.
  const double angle = 2.0 * std::numbers::pi * (phase - 0.5 * r);
  velocity_.y() -= (scenario.gain * task.sway_m + scenario.addition.sway_m) * 2.0 * std::numbers::pi / task.period_s *
                   std::sin(angle);
}

PostureResiduals::PostureResiduals(const RobotLegs& legs, const GaitTask& task, Foot foot, std::size_t sample,
                                   std::size_t knots)
    : basis_(spline_basis(static_cast<double>(sample) / static_cast<double>(kClipSamples), knots)),
      stand_(legs.stand[foot]),
      reference_(task.reference[sample][foot]),
      reference_weight_(task.weights.reference / std::sqrt(static_cast<double>(kClipSamples))),
      lower_(legs.lower[foot].array() + kLimitMargin_rad),
      upper_(legs.upper[foot].array() - kLimitMargin_rad),
      limit_weight_(task.weights.limit / std::sqrt(static_cast<double>(kClipSamples))) {}

GaitSolution optimize_gait(const RobotLegs& legs, const GaitTask& task, const work::Progress& progress) {
  KnotTable table(task.symmetric);
  start_from_reference(legs, task, table);
  std::vector<VelocityTarget> targets(task.scenarios.size());
  GaitSolution solution;
  ProgressCallback stop(progress);
  for (int round = 0; round < task.rounds; ++round) {
    ceres::Problem problem;
    add_residuals(legs, task, targets, table, problem);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = round == 0 ? task.first_iterations : task.later_iterations;
    options.function_tolerance = 1e-5;
    options.num_threads = 1;  // for identical bytes every time
    options.logging_type = ceres::SILENT;
    options.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (progress.interrupted_now()) throw work::Interrupted();
    solution.cost = summary.final_cost;
    solution.iterations += static_cast<int>(summary.iterations.size());
    solution.legs = sample_legs(legs, task.symmetric, table);
    for (std::size_t s = 0; s < task.scenarios.size(); ++s) {
      const Scenario& scenario = task.scenarios[s];
      // With an added posture the mean velocity is a wish, not a promise.
      if (scenario.addition.q.empty() || scenario.promised) {
        const Eigen::Vector3d mean = measure(legs, blend(legs, solution.legs, scenario),
                                             timing(task.period_s, task.duty_factor), hiking_base(task, scenario))
                                         .mean_velocity;
        targets[s].correct(scenario.gain * task.velocity + scenario.addition.velocity - mean);
      }
    }
  }
  return solution;
}

}  // namespace pmg::generator
