#include "zero/zero_calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "pmg/types.hpp"

namespace pmg::zero {

namespace {

constexpr double kHuber = 2.0;       // Huber's threshold: larger weighted residuals count linearly
constexpr double kLeastScale = 0.4;  // lower limit of the noise scale, for poses that agree better than expected
constexpr double kFirmLoad = 0.35;   // share of the weight above which a sole settles fully
constexpr double kNamedShare = 0.2;  // least component of a null-space direction for a joint to be named

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Nuisance parameters, the same in all poses.
constexpr Eigen::Index kShared = 5;
using Shared = Eigen::Matrix<double, kShared, 1>;  // the IMU's tilt, then the soles' compliance

/// Derivative of the constraint's residual by the soles' compliance, at these loads.
Eigen::Matrix<double, 5, 3> miss_by_give(const PerFoot<model::SoleLoad>& load) {
  Eigen::Matrix<double, 5, 3> miss = Eigen::Matrix<double, 5, 3>::Zero();
  miss(0, 0) = load[kLeft].moment_Nm.y();
  miss(1, 1) = -load[kLeft].moment_Nm.x();
  miss(2, 0) = load[kRight].moment_Nm.y();
  miss(3, 1) = -load[kRight].moment_Nm.x();
  miss(4, 2) = load[kRight].force_N - load[kLeft].force_N;
  return miss;
}

/// The equations of all poses, stacked and linearised.
struct Stack {
  Eigen::MatrixXd J;     // weighted; 5 rows per pose; columns: zero points, then nuisance parameters
  Eigen::VectorXd miss;  // weighted
};

/// Finds the zero points with which the simulated robot stands flat in all poses.
class Alignment {
 public:
  Alignment(const model::RobotModel& robot, const std::vector<StillPose>& poses, const ZeroOptions& options)
      : poses_(poses),
        options_(options),
        constraint_(robot),
        loads_(robot),
        weight_N_(robot.total_mass_kg * kGravity_m_s2),
        load_(poses.size()) {
    for (const model::FootModel& foot : robot.feet) half_sole_m_ = foot.box_half_size_m.head<2>();
  }

  const std::vector<int>& joints() const { return constraint_.joints(); }
  Eigen::Index count() const { return static_cast<Eigen::Index>(joints().size()); }

  /// r + z [+ more], all joints.
  JointVector estimate(std::size_t pose, const Eigen::VectorXd& z) const {
    JointVector q = poses_[pose].reading_rad;
    for (Eigen::Index i = 0; i < count(); ++i) q[joints()[static_cast<std::size_t>(i)]] += z[i];
    return q;
  }

  /// Weighted residual, without and with the nuisance parameters.
  StandingMiss miss(std::size_t pose, const Eigen::VectorXd& z, const Shared& shared) {
    const StandingMiss bare = constraint_.miss(estimate(pose, z), poses_[pose].gravity_I, shared.head<2>());
    return trust(pose).asDiagonal() * (bare - miss_by_give(load_[pose]) * shared.tail<3>());
  }
  Eigen::MatrixXd jacobian(std::size_t pose, const Eigen::VectorXd& z, const Shared& shared) {
    Eigen::MatrixXd J(5, count() + kShared);
    J << constraint_.jacobian(estimate(pose, z), poses_[pose].gravity_I, shared.head<2>()), -miss_by_give(load_[pose]);
    return trust(pose).asDiagonal() * J;
  }

  Stack stack(const std::vector<bool>& used, const Eigen::VectorXd& z, const Shared& shared) {
    Stack all;
    const auto rows = 5 * static_cast<Eigen::Index>(std::ranges::count(used, true));
    all.J.resize(rows, count() + kShared);
    all.miss.resize(rows);
    Eigen::Index row = 0;
    for (std::size_t k = 0; k < used.size(); ++k) {
      if (!used[k]) continue;
      all.J.middleRows(row, 5) = jacobian(k, z, shared);
      all.miss.segment(row, 5) = miss(k, z, shared);
      row += 5;
    }
    return all;
  }

  /// Shift of z common to all poses: Gauss-Newton from z on Huber's loss with the priors (iteratively reweighted).
  Eigen::VectorXd common_shift(const std::vector<bool>& used, const Eigen::VectorXd& z, Shared& shared) {
    Eigen::VectorXd x(count() + kShared);
    x << z, shared;
    for (int iteration = 0; iteration < 8; ++iteration) {
      const Stack all = stack(used, x.head(count()), x.tail<kShared>());
      const Eigen::VectorXd robust =
          all.miss.unaryExpr([](double miss) { return std::abs(miss) <= kHuber ? 1.0 : kHuber / std::abs(miss); });
      const Eigen::MatrixXd weighted = robust.asDiagonal() * all.J;
      const Eigen::MatrixXd normal = all.J.transpose() * weighted + Eigen::MatrixXd(prior().asDiagonal());
      const Eigen::VectorXd gradient = weighted.transpose() * all.miss + prior().cwiseProduct(x);
      const Eigen::VectorXd step = normal.ldlt().solve(gradient);
      x -= step;
      if (step.cwiseAbs().maxCoeff() < 1e-9) break;
    }
    shared = x.tail<kShared>();
    return x.head(count()) - z;
  }

  /// Joint deflections d of one pose beyond the common shift that make the simulated robot stand flat:
  /// d = -(J^T J + I / deflection_rad^2)^-1 J^T miss.
  Eigen::VectorXd deflection(std::size_t pose, const Eigen::VectorXd& z, const Shared& shared) {
    const Eigen::MatrixXd J = jacobian(pose, z, shared).leftCols(count());
    const double stiffness = 1.0 / (options_.deflection_rad * options_.deflection_rad);
    const Eigen::MatrixXd normal = J.transpose() * J + stiffness * Eigen::MatrixXd::Identity(count(), count());
    return -normal.ldlt().solve(J.transpose() * miss(pose, z, shared));
  }

  /// The paper's gate, and whether the robot stood at all.
  ZeroPose judge(std::size_t pose, const Eigen::VectorXd& z, const Shared& shared) {
    const StillPose& real = poses_[pose];
    const JointVector q = estimate(pose, z);
    ZeroPose judged;
    loads_.set_posture(q, constraint_.gravity_B(q, real.gravity_I));
    judged.load = load_[pose] = loads_.of(real.torque_Nm);
    for (const Eigen::Vector3d& s_sim : constraint_.gravity_of_simulated(q, shared.head<2>()))
      judged.misalignment_rad = std::max(judged.misalignment_rad, (real.gravity_I - s_sim).norm());
    judged.height_miss_m = constraint_.miss(q, real.gravity_I, shared.head<2>())[4];
    judged.why_not = reason_against(judged);
    judged.used = judged.why_not.empty();
    return judged;
  }

  bool stands(const ZeroPose& pose) const {
    return std::ranges::all_of(
        pose.load, [this](const model::SoleLoad& load) { return load.force_N >= options_.least_load * weight_N_; });
  }

  /// Precisions (1 / deviation^2) of the priors: zero points, then nuisance parameters.
  Eigen::VectorXd prior() const {
    const double give_m_per_N = options_.sole_give_m / weight_N_;
    Eigen::VectorXd expected(count() + kShared);
    expected << Eigen::VectorXd::Constant(count(), options_.expected_offset_rad),
        Eigen::Vector2d::Constant(options_.imu_mounting_rad),
        give_m_per_N * half_sole_m_.cwiseProduct(half_sole_m_).cwiseInverse(), give_m_per_N;
    return expected.cwiseAbs2().cwiseInverse();
  }

 private:
  /// Weights of a pose's equations, 1 / deviation: a lightly loaded sole lies flat less reliably.
  StandingMiss trust(std::size_t pose) const {
    const auto tilt = [&](Foot foot) {
      const double firm_N = kFirmLoad * weight_N_;
      return 1.0 / (options_.sole_tilt_rad * std::max(1.0, firm_N / std::max(load_[pose][foot].force_N, 1.0)));
    };
    StandingMiss weight;
    weight << tilt(kLeft), tilt(kLeft), tilt(kRight), tilt(kRight), 1.0 / options_.height_m;
    return weight;
  }

  std::string reason_against(const ZeroPose& pose) const {
    if (!stands(pose)) return "doesn't stand on both soles";
    for (const Foot foot : {kLeft, kRight}) {
      if (pose.load[foot].inside_m < options_.least_inside_m)
        return fmt::format("the {} sole stands on its edge", foot == kLeft ? "left" : "right");
    }
    if (pose.misalignment_rad > options_.tau_rad) return "the IMU isn't aligned";
    return {};
  }

  const std::vector<StillPose>& poses_;
  const ZeroOptions& options_;
  StandingConstraint constraint_;
  model::SoleLoads loads_;
  double weight_N_;
  Eigen::Vector2d half_sole_m_ = Eigen::Vector2d::Ones();
  std::vector<PerFoot<model::SoleLoad>> load_;  // of each pose, as last judged
};

std::string direction_text(const Eigen::VectorXd& direction, const std::vector<int>& joints,
                           const model::RobotModel& robot) {
  std::string text;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (std::abs(direction[i]) < kNamedShare) continue;
    text += fmt::format("{}{:.2f} {}", direction[i] < 0.0 ? (text.empty() ? "-" : " - ") : (text.empty() ? "" : " + "),
                        std::abs(direction[i]), robot.joint_index.name(joints[static_cast<std::size_t>(i)]));
  }
  return text;
}

/// Fills in the zero points' deviations and the unobservable directions (null space).
void find_observability(ZeroCalibration& found, Alignment& alignment, const Shared& shared,
                        const std::vector<bool>& used, const model::RobotModel& robot, const ZeroOptions& options) {
  const Eigen::Index count = alignment.count();
  const Stack all = alignment.stack(used, found.z_rad, shared);
  found.weighted_rms = std::sqrt(all.miss.squaredNorm() / static_cast<double>(all.miss.size()));
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(all.J.leftCols(count)).singularValues();
  found.singular_values.assign(singular.begin(), singular.end());
  // The residual sets the noise scale, with the degrees of freedom reduced by all fitted parameters.
  const auto freedom = static_cast<double>(std::max<Eigen::Index>(1, all.miss.size() - count - kShared));
  const double scale = std::max(kLeastScale, std::sqrt(all.miss.squaredNorm() / freedom));
  const Eigen::MatrixXd precision =
      all.J.transpose() * all.J / (scale * scale) + Eigen::MatrixXd(alignment.prior().asDiagonal());
  const Eigen::MatrixXd covariance =
      precision.ldlt().solve(Eigen::MatrixXd::Identity(count + kShared, count + kShared)).topLeftCorner(count, count);
  found.deviation_rad = covariance.diagonal().cwiseSqrt();
  found.known.clear();
  for (const double deviation_rad : found.deviation_rad) {
    found.known.push_back(deviation_rad <= options.well_rad      ? Known::kWell
                          : deviation_rad <= options.roughly_rad ? Known::kRoughly
                                                                 : Known::kNo);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
  for (Eigen::Index i = count; i-- > 0;) {
    const double deviation = std::sqrt(axes.eigenvalues()[i]);
    if (deviation <= options.well_rad) break;
    found.blind.push_back({deviation, direction_text(axes.eigenvectors().col(i), alignment.joints(), robot)});
  }
}

std::vector<bool> poses_that_stand(Alignment& alignment, std::size_t poses, const Eigen::VectorXd& z) {
  std::vector<bool> stand;
  for (std::size_t k = 0; k < poses; ++k) stand.push_back(alignment.stands(alignment.judge(k, z, Shared::Zero())));
  return stand;
}

}  // namespace

std::size_t ZeroCalibration::used() const {
  return static_cast<std::size_t>(std::ranges::count_if(poses, &ZeroPose::used));
}

ZeroCalibration calibrate_zero(const model::RobotModel& robot, const std::vector<StillPose>& poses,
                               const ZeroOptions& options, const work::Progress& progress) {
  Alignment alignment(robot, poses, options);
  const Eigen::Index count = alignment.count();
  ZeroCalibration found;
  found.joints = alignment.joints();
  found.z_rad = Eigen::VectorXd::Zero(count);
  std::vector<bool> aligned = poses_that_stand(alignment, poses.size(), found.z_rad);
  Shared shared = Shared::Zero();
  int calm = 0;
  for (int iteration = 0; iteration < options.most_iterations && calm < options.M; ++iteration) {
    if (!progress(work::kUnknownShare, fmt::format("iteration {}", iteration + 1))) break;
    if (std::ranges::count(aligned, true) == 0) {
      throw std::invalid_argument(fmt::format(
          "none of {} still poses is one of a robot that stands on both soles; expected logs of poses on level ground",
          poses.size()));
    }
    const Eigen::VectorXd shift = alignment.common_shift(aligned, found.z_rad, shared);
    // delta_ik of the paper: simulated joint less r + z.
    std::vector<std::vector<double>> delta(static_cast<std::size_t>(count));
    found.poses.clear();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      found.poses.push_back(alignment.judge(k, found.z_rad + shift, shared));
      aligned[k] = found.poses[k].used;
      if (!aligned[k]) continue;
      const Eigen::VectorXd own = alignment.deflection(k, found.z_rad + shift, shared);
      for (Eigen::Index i = 0; i < count; ++i) delta[static_cast<std::size_t>(i)].push_back(shift[i] + own[i]);
    }
    if (found.used() == 0) continue;
    double largest = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double step = options.alpha * median(delta[static_cast<std::size_t>(i)]);
      found.z_rad[i] += step;
      largest = std::max(largest, std::abs(step));
    }
    found.steps_rad.push_back(largest);
    calm = largest < options.epsilon_rad ? calm + 1 : 0;
  }
  found.converged = calm >= options.M;
  found.imu_tilt_rad = shared.head<2>();
  found.give = shared.tail<3>();
  find_observability(found, alignment, shared, aligned, robot, options);
  return found;
}

}  // namespace pmg::zero
