#include "residual_torque/missing_torque.hpp"

#include <algorithm>
#include <cmath>

#include "evidence/motion.hpp"
#include "sim/actuator_model.hpp"
#include "work/parallel.hpp"

namespace pmg::residual_torque {

namespace {

constexpr double kRow_s = 0.01;           // rows at most each: knots are further apart
constexpr double kSlowest_rad_s = 60.0;   // pull of a drive without gains
constexpr double kFasterThanDrive = 3.0;  // the pull beside the drive's own loop
constexpr double kLargestStep = 0.3;      // pull times step: far inside what the integrator bears
constexpr double kWindow_s = 0.05;        // of the parabolas
constexpr double kMoves = 0.03;           // share of the bench's speed; slower counts as resting
constexpr std::array kWidthShares = {0.5, 0.2, 1.0 / 12.0};

/// Changes of the model within its tolerances, as shares of a typical torque or of the term itself.
constexpr double kFriction = 0.1, kConstant = 0.03, kGravity = 0.03, kInertia = 0.05, kGain = 0.03;

/// The command behind every lag.
struct Lagged {
  std::array<double, kLags> command_rad{};

  void follow(const actuator::ResidualSeen& seen, double step_s, bool first) {
    for (std::size_t l = 0; l < kLags; ++l) {
      const double share = first ? 1.0 : step_s / (kLags_s[l] + step_s);
      command_rad[l] += share * (seen.command_rad - command_rad[l]);
    }
  }
};

/// A simulated joint on the leash of its recording.
class PulledJoint {
 public:
  PulledJoint(const bench::Bench& bench, const calib::SingleJoint& joint, const calib::JointModel& model,
              const effects::BenchScale& scale)
      : joint_(joint),
        model_(joint.of_run(model)),
        scale_(scale),
        moved_(evidence::motion(bench, joint.run(), kWindow_s)) {
    model_.actuator.residual_torque = {.count = 1,
                                       .terms = {}};  // a term without influence: its quantities are followed
    const model::ActuatorParameters::Drive& drive = model_.actuator.drive;
    const double unit_Nm = drive.torque_per_unit_Nm * joint.input(0).supply;
    kp_Nm_per_rad_ = unit_Nm * drive.kp_scale * joint.run().kp;
    kd_Nm_s_per_rad_ = unit_Nm * drive.kd_scale * joint.run().kd;
    inertia_kg_m2_ = joint.load(model_).inertia_kg_m2 + model_.actuator.transmission.armature_kg_m2;
    pull_rad_s_ = std::clamp(kFasterThanDrive * std::sqrt(kp_Nm_per_rad_ / inertia_kg_m2_), kSlowest_rad_s,
                             kLargestStep / joint.step_s());
  }

  MissingRun run(std::size_t every, const std::array<double, kWidths>& widths_rad) {
    const bench::Recording& r = joint_.run().recording;
    const std::size_t rows = (r.t_s.size() + every - 1) / every;
    prepare(rows);
    std::vector<double> apart_rad(r.t_s.size(), 0.0), pull_Nm(r.t_s.size(), 0.0), steps(r.t_s.size(), 0.0);
    std::vector<double> speed_rad_s(rows, 0.0);
    sim::ActuatorModel actuator(model_.actuator, joint_.step_s());
    const double inertia = joint_.load(model_).inertia_kg_m2 + actuator.joint_armature_kg_m2();
    const calib::SingleJoint::Start start = joint_.start(model_);
    double q_rad = start.q_rad, dq_rad_s = 0.0;
    actuator.reset_at_rest(told(0), q_rad, start.load_Nm, start.slack_rad);
    std::array<double, kWidths> bends_rad{};
    Lagged lagged;
    std::size_t sample = 0, seen = 0;
    const auto look = [&](std::size_t at, double target_rad) {
      apart_rad[at] = target_rad - q_rad;
      if (at % every != 0) return;
      see(at / every, actuator.residual(), bends_rad, lagged);
      speed_rad_s[at / every] = dq_rad_s;
    };
    for (std::size_t k = 0; k < joint_.steps(); ++k) {
      const double t_s = r.t_s.front() + static_cast<double>(k) * joint_.step_s();
      while (sample + 1 < r.t_s.size() && r.t_s[sample + 1] <= t_s + 1e-9) ++sample;
      const Target target = target_at(sample, t_s);
      sim::ActuatorInput input = told(k);
      input.external_Nm = -gravity_Nm(q_rad);
      const sim::ActuatorTorque drive = actuator.step(input, q_rad, dq_rad_s);
      for (std::size_t w = 0; w < kWidths; ++w) {
        const double bend_rad = bends_rad[w] + joint_.step_s() * actuator.residual().seen().motor_rad_s;
        bends_rad[w] = std::clamp(bend_rad, -widths_rad[w], widths_rad[w]);
      }
      lagged.follow(actuator.residual().seen(), joint_.step_s(), k == 0);
      for (; seen <= sample; ++seen) look(seen, target.q_rad);
      const double now_Nm =
          inertia_kg_m2_ * pull_rad_s_ * (pull_rad_s_ * (target.q_rad - q_rad) + 2.0 * (target.dq_rad_s - dq_rad_s));
      pull_Nm[sample] += now_Nm;
      steps[sample] += 1.0;
      dq_rad_s += joint_.step_s() * (drive.torque_Nm - gravity_Nm(q_rad) + now_Nm) /
                  (inertia - joint_.step_s() * drive.slope_Nm_s_per_rad);
      q_rad += joint_.step_s() * dq_rad_s;
    }
    for (; seen < r.t_s.size(); ++seen) look(seen, target_at(seen, r.t_s[seen]).q_rad);
    for (std::size_t k = 0; k < pull_Nm.size(); ++k) pull_Nm[k] /= std::max(1.0, steps[k]);
    derive(every, std::move(apart_rad), pull_Nm, speed_rad_s);
    return std::move(found_);
  }

 private:
  struct Target {
    double q_rad, dq_rad_s;
  };

  void prepare(std::size_t rows) {
    const auto count = static_cast<Eigen::Index>(rows);
    found_.missing_Nm = found_.direction = Eigen::VectorXd::Zero(count);
    for (Eigen::VectorXd& one : found_.quantities) one = Eigen::VectorXd::Zero(count);
    for (Eigen::VectorXd& one : found_.bends_rad) one = Eigen::VectorXd::Zero(count);
    found_.changes_Nm.fill(Eigen::VectorXd::Zero(count));
    found_.tolerances_Nm = Eigen::MatrixXd::Zero(count, kTolerances);
  }

  sim::ActuatorInput told(std::size_t step) const {
    sim::ActuatorInput now = joint_.input(step);
    now.feed_forward_Nm *= model_.feed_forward_scale;
    return now;
  }

  double gravity_Nm(double q_rad) const {
    const bench::JointLoad load = joint_.load(model_);
    return load.gravity_Nm * std::sin(q_rad - load.hangs_at_rad);
  }

  Target target_at(std::size_t sample, double t_s) const {
    const bench::Recording& r = joint_.run().recording;
    const std::size_t next = std::min(sample + 1, r.t_s.size() - 1);
    const double share =
        next == sample ? 0.0 : std::clamp((t_s - r.t_s[sample]) / (r.t_s[next] - r.t_s[sample]), 0.0, 1.0);
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    const auto known = [](double speed_rad_s) { return std::isfinite(speed_rad_s) ? speed_rad_s : 0.0; };
    const double reading_rad = between(r.q_rad[sample], r.q_rad[next]);
    return {sim::ActuatorModel::joint_rad(model_.actuator, reading_rad, gravity_Nm(reading_rad)),
            between(known(moved_.dq_rad_s[sample]), known(moved_.dq_rad_s[next]))};
  }

  void see(std::size_t row, const actuator::ResidualAction& residual, const std::array<double, kWidths>& bends_rad,
           const Lagged& lagged) {
    const auto index = static_cast<Eigen::Index>(row);
    for (std::size_t q = 0; q < kQuantities; ++q)
      found_.quantities[q][index] = residual.value(static_cast<model::ResidualQuantity>(q));
    for (std::size_t w = 0; w < kWidths; ++w) found_.bends_rad[w][index] = bends_rad[w];
    for (std::size_t l = 0; l < kLags; ++l) {
      const actuator::ResidualSeen& now = residual.seen();
      found_.changes_Nm[l][index] = now.stiffness_Nm_per_rad * (now.command_rad - lagged.command_rad[l]);
    }
    if (!residual.seen().sticks) found_.direction[index] = std::copysign(1.0, residual.seen().motor_rad_s);
  }

  /// Mean of the pull about a sample, weighted as a parabola's curvature weights accelerations: by (1 - x^2)^2 over its
  /// window. The pull of a sample is that of the steps after it.
  double smoothed(const std::vector<double>& pull_Nm, std::size_t at) const {
    const std::vector<double>& t_s = joint_.run().recording.t_s;
    const double period_s = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1);
    const double half_s = std::max(0.5 * kWindow_s, 2.0 * period_s) + 0.5 * period_s;
    const auto reach = static_cast<std::size_t>(half_s / period_s) + 1;
    double sum_Nm = 0.0, weights = 0.0;
    for (std::size_t k = at - std::min(at, reach); k < std::min(t_s.size(), at + reach + 1); ++k) {
      const double x = (t_s[k] + 0.5 * period_s - t_s[at]) / half_s;
      if (std::abs(x) >= 1.0) continue;
      const double weight = (1.0 - x * x) * (1.0 - x * x);
      sum_Nm += weight * pull_Nm[k];
      weights += weight;
    }
    return sum_Nm / weights;
  }

  void derive(std::size_t every, std::vector<double> apart_rad, const std::vector<double>& pull_Nm,
              const std::vector<double>& speed_rad_s) {
    bench::BenchRun apart = joint_.run();
    const bench::Recording& r = joint_.run().recording;
    apart.recording.q_rad = std::move(apart_rad);
    const evidence::Motion e = evidence::motion(bench::Bench{}, apart, kWindow_s);
    const double slowest = kMoves * scale_.speed_rad_s;
    for (std::size_t k = 0; k < r.t_s.size(); k += every) {
      const auto row = static_cast<Eigen::Index>(k / every);
      const double speed = moved_.dq_rad_s[k], simulated = speed_rad_s[k / every];
      const bool moves = std::abs(speed) > slowest && speed * simulated > 0.0 && std::abs(simulated) > slowest;
      if (!r.valid[k] || !moves || !std::isfinite(e.ddq_rad_s2[k]) || !std::isfinite(moved_.ddq_rad_s2[k])) {
        found_.direction[row] = 0.0;
        continue;
      }
      found_.direction[row] = std::copysign(1.0, simulated);
      found_.missing_Nm[row] = smoothed(pull_Nm, k) + inertia_kg_m2_ * e.ddq_rad_s2[k] +
                               kp_Nm_per_rad_ * apart.recording.q_rad[k] + kd_Nm_s_per_rad_ * e.dq_rad_s[k];
      const double drive_Nm = found_.quantities[static_cast<std::size_t>(model::ResidualQuantity::kDrive)][row];
      found_.tolerances_Nm.row(row) << -found_.direction[row] * kFriction * scale_.torque_Nm,
          -speed * kFriction * scale_.torque_Nm / scale_.speed_rad_s, kConstant * scale_.torque_Nm,
          -kGravity * gravity_Nm(r.q_rad[k]), -kInertia * inertia_kg_m2_ * moved_.ddq_rad_s2[k], kGain * drive_Nm;
    }
  }

  const calib::SingleJoint& joint_;
  calib::JointModel model_;
  const effects::BenchScale& scale_;
  evidence::Motion moved_;
  double kp_Nm_per_rad_ = 0.0, kd_Nm_s_per_rad_ = 0.0, inertia_kg_m2_ = 0.0, pull_rad_s_ = 0.0;
  MissingRun found_;
};

fitting::Blocks thinned_blocks(const effects::NestedFit& fit, std::size_t every) {
  fitting::Blocks blocks;
  for (const calib::SingleJoint& joint : fit.runs()) {
    const std::vector<double>& all_s = joint.run().recording.t_s;
    std::vector<double> t_s;
    for (std::size_t k = 0; k < all_s.size(); k += every) t_s.push_back(all_s[k]);
    blocks.add_run(t_s, std::vector<bool>(t_s.size(), true));
  }
  return blocks;
}

}  // namespace

MissingTorque missing_torque(const bench::Bench& bench, const effects::NestedFit& fit, const calib::JointModel& model,
                             const effects::BenchScale& scale) {
  MissingTorque found;
  const double range_rad = std::max(1e-6, scale.position_high_rad - scale.position_low_rad);
  for (std::size_t w = 0; w < kWidths; ++w) found.widths_rad[w] = kWidthShares[w] * range_rad;
  auto every = static_cast<std::size_t>(std::max(1.0, std::round(kRow_s * bench.sample_rate_hz)));
  found.blocks = thinned_blocks(fit, every);
  if (found.blocks.count() != fit.blocks().count()) {  // a run's end fell on the other side of half a block
    every = 1;
    found.blocks = fit.blocks();
  }
  found.runs.resize(fit.runs().size());
  work::for_each_in_parallel(fit.runs().size(), fit.threads(), [&](std::size_t i) {
    found.runs[i] = PulledJoint(bench, fit.runs()[i], model, scale).run(every, found.widths_rad);
  });
  double coldest_C = 1e9, warmest_C = -1e9;
  for (const MissingRun& run : found.runs) {
    const auto& warm_C = run.quantities[static_cast<std::size_t>(model::ResidualQuantity::kTemperature)];
    coldest_C = std::min(coldest_C, warm_C.minCoeff());
    warmest_C = std::max(warmest_C, warm_C.maxCoeff());
  }
  found.temperature_varies = warmest_C - coldest_C > 2.0;  // a thermometer's noise is less
  return found;
}

}  // namespace pmg::residual_torque
