#include "data_faults/quick_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bench/noise_floor.hpp"
#include "calib/joint_runs.hpp"
#include "calib/optimizer.hpp"
#include "calib/rollout_residuals.hpp"
#include "calib/unknown.hpp"
#include "fitting/statistics.hpp"
#include "work/parallel.hpp"

namespace pmg::data_faults {

namespace {

constexpr double kBlocksOfRun =
    12.0;  // a run counts as so many independent observations: six seconds, half a second each
constexpr double kGainDeviation = 0.15;    // of ln of a gain or torque constant that bench.yaml gives
constexpr double kTrustedDeviation = 0.3;  // of ln of a number of the given model: friction changes from day to day
// Twice the simulation's own: the model's error, not its numbers, is compared.
constexpr double kCoarsestStep_s = 0.002;
constexpr double kGains[] = {1.0, 2.0, 0.5, 4.0, 0.25};
constexpr std::size_t kScreened = 160, kScreenedRuns = 6;
constexpr double kLightRotor = 0.01;  // of the whole inertia: a lighter rotor moves nothing
constexpr double kLargestFactor = 100.0;
const double kSenseless = std::log(1e3);  // of a model that diverges: above all real ones

/// Van der Corput sequence: element n in this base, 0..1.
double halton(std::size_t n, std::size_t base) {
  double share = 1.0, value = 0.0;
  for (; n > 0; n /= base) {
    share /= static_cast<double>(base);
    value += share * static_cast<double>(n % base);
  }
  return value;
}

/// The first so many points of Halton's sequence; the last coordinate goes through `kinds` values in turn.
std::vector<std::vector<double>> halton_points(std::size_t count, std::size_t coordinates, std::size_t kinds) {
  constexpr std::size_t kBases[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  std::vector<std::vector<double>> points(count);
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t i = 0; i < coordinates; ++i) points[n].push_back(halton(n + 1, kBases[i % std::size(kBases)]));
    points[n].push_back((static_cast<double>(n % kinds) + 0.5) / static_cast<double>(kinds));
  }
  return points;
}

/// The run's start from the recorded trend: noise of its sensor, in the unit of the readings.
double noise_rad(const calib::SingleJoint& joint) {
  return std::max(1e-7, bench::sensor_noise_rad(joint.run().recording));
}

std::vector<RunFactors> factors_of_runs(std::size_t runs, const std::vector<SharedFactor>& shared,
                                        const std::vector<double>& factors) {
  std::vector<RunFactors> found(runs);
  for (std::size_t s = 0; s < shared.size(); ++s) {
    for (const std::size_t run : shared[s].runs) found[run].*shared[s].of *= factors[s];
  }
  return found;
}

double log_of(const Eigen::VectorXd& residual_rad, double noise_rad) {
  const auto counting = static_cast<double>((residual_rad.array() != 0.0).count());
  const double found = 0.5 * std::log(residual_rad.squaredNorm() / std::max(1.0, counting) + noise_rad * noise_rad);
  return std::isfinite(found) ? found : kSenseless;
}

}  // namespace

calib::JointModel with_factors(calib::JointModel model, const RunFactors& factors) {
  model.actuator.drive.kp_scale *= factors.kp;
  model.actuator.drive.kd_scale *= factors.kd;
  model.inertia_scale *= factors.load;
  model.gravity_scale *= factors.load;
  model.feed_forward_scale *= factors.commanded_torque;
  return model;
}

QuickModel::QuickModel(const bench::Bench& bench, const std::optional<model::ActuatorParameters>& given,
                       unsigned threads)
    : bench_(&bench),
      given_(given.has_value()),
      threads_(threads),
      step_s_(std::min(kCoarsestStep_s, 0.5 / bench.sample_rate_hz)) {
  start_.actuator = given.value_or(bench.known);
}

double evidence(const QuickFit& fit, const QuickFit& other) {
  return 2.0 * kBlocksOfRun * static_cast<double>(fit.log_error.size()) * (other.loss_with_prior - fit.loss_with_prior);
}

std::vector<calib::SingleJoint> QuickModel::joints(const std::vector<bench::BenchRun>& runs) const {
  std::vector<calib::SingleJoint> found;
  for (const bench::BenchRun& run : runs) found.push_back(joint(run));
  return found;
}

double QuickModel::log_error(const calib::SingleJoint& joint, const calib::JointModel& model) const {
  try {
    return log_of(calib::run_residual(joint, model, calib::Counted::kDriven), noise_rad(joint));
  } catch (const std::invalid_argument&) {  // the actuator model refuses the parameters
    return kSenseless;
  }
}

std::vector<double> QuickModel::log_errors(const std::vector<calib::SingleJoint>& joints,
                                           const calib::JointModel& model) const {
  std::vector<double> found(joints.size());
  work::for_each_in_parallel(joints.size(), threads_, [&](std::size_t i) { found[i] = log_error(joints[i], model); });
  return found;
}

calib::Unknowns QuickModel::unknowns(const std::vector<calib::SingleJoint>& runs,
                                     const std::vector<std::string>& extra) const {
  std::vector<std::string> names = calib::basic_parameters(*bench_);
  const bool voltage = bench_->law == bench::DriveLaw::kServoVoltage;
  calib::add_missing(names, {"friction.coulomb_Nm"});
  if (!voltage) calib::add_missing(names, {"friction.viscous_Nm_s_per_rad"});  // a servo's back-EMF damps
  calib::add_missing(names, {"command.delay_s", "ripple.offset_Nm"});
  if (bench_->law == bench::DriveLaw::kCascadePd) calib::add_missing(names, {"drive.torque_per_unit_Nm"});
  const effects::BenchScale scale = effects::scale_of(*bench_, runs, start_);
  if (voltage && scale.switches_off) names.emplace_back("drive.brake_when_disabled");
  calib::add_missing(names, extra);
  calib::Unknowns found;
  for (const std::string& name : names) {
    calib::Unknown u = effects::unknown(name, *bench_, scale);
    if (name == "command.delay_s") u.upper = std::min(u.upper, (sim::ActuatorModel::kDelaySteps - 1) * step_s_);
    if (name == "transmission.armature_kg_m2") u.lower = std::max(u.lower, kLightRotor * scale.inertia_kg_m2);
    const double known = calib::value(start_, name);
    const bool listed = std::find(bench_->unknown.begin(), bench_->unknown.end(), name) != bench_->unknown.end();
    const bool drive = name.starts_with("drive.");
    if (u.scale == calib::Scale::kLogarithmic && known > 0.0 && !(listed && !given_)) {
      u.lower = std::min(u.lower, 0.5 * known);
      u.upper = std::max(u.upper, 2.0 * known);
      u.expected = std::log(known);
      u.deviation = drive && name != "drive.kd_scale" ? kGainDeviation : kTrustedDeviation;
    }
    found.push_back(u);
  }
  return found;
}

/// The best of models spread over the parameters without a prior, and over a few factors of the gain: a drive's gain
/// may be off by as much.
calib::JointModel QuickModel::screened(const std::vector<calib::SingleJoint>& runs,
                                       const calib::Unknowns& unknowns) const {
  const std::vector<calib::SingleJoint> few = calib::spread(runs, kScreenedRuns);
  const auto model_at = [&](const std::vector<double>& point) {  // the last coordinate: of the gain
    calib::JointModel model = start_;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const calib::Unknown& u = unknowns[i];
      if (u.name == "drive.kp_scale" && u.deviation > 0.0) {
        const auto gain = static_cast<std::size_t>(point.back() * static_cast<double>(std::size(kGains)));
        calib::set(model, u.name, calib::value(start_, u.name) * kGains[gain]);
      }
      if (given_ || u.deviation > 0.0) continue;
      const bool torque = u.scale == calib::Scale::kLinear;  // friction and offsets are small beside the drive's torque
      calib::set(model, u.name, torque ? point[i] * std::min(u.upper, u.typical) : u.at_share(point[i]));
      if (u.name == "ripple.offset_Nm") calib::set(model, u.name, 0.0);
      if (u.name == "command.delay_s") calib::set(model, u.name, 0.5 * point[i] * u.upper);
    }
    return model;
  };
  const auto loss = [&](const std::vector<double>& point) {
    const calib::JointModel model = model_at(point);
    double sum = 0.0;
    for (const calib::SingleJoint& run : few) sum += log_error(run, model);
    return sum;
  };
  const std::size_t count = given_ ? std::size(kGains) : kScreened;
  return model_at(
      calib::screened(loss, halton_points(count, unknowns.size(), std::size(kGains)), threads_).front().point);
}

QuickFit QuickModel::minimised(const std::vector<calib::SingleJoint>& runs, const calib::Unknowns& unknowns,
                               const QuickFit& from, const std::vector<SharedFactor>& shared,
                               int most_iterations) const {
  const auto base = std::ssize(unknowns);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(base + std::ssize(shared));
  x.head(base) = calib::coordinates(unknowns, from.model);
  std::vector<double> weights(runs.size(), 1.0);
  fitting::Problem problem{.residuals = {}, .coordinates = calib::ranges(unknowns), .prior_weight = 1.0};
  for (std::size_t s = 0; s < shared.size(); ++s) {
    const double most = std::log(kLargestFactor);
    problem.coordinates.push_back({-most, most, 1e-2, 0.0, shared[s].deviation});
    if (from.factors.size() == shared.size()) x[base + static_cast<Eigen::Index>(s)] = std::log(from.factors[s]);
  }
  const auto at = [&](const Eigen::VectorXd& point) {
    QuickFit fit = from;
    fit.model = calib::model_at(from.model, unknowns, point);
    fit.factors.clear();
    for (Eigen::Index s = base; s < point.size(); ++s) fit.factors.push_back(std::exp(point[s]));
    return fit;
  };
  const auto unweighted = [&](const Eigen::VectorXd& point) {
    const QuickFit fit = at(point);
    const std::vector<RunFactors> factors = factors_of_runs(runs.size(), shared, fit.factors);
    return calib::residuals([&](std::size_t run) { return with_factors(fit.model, factors[run]); }, runs, threads_,
                            calib::Counted::kDriven);
  };
  problem.residuals = [&](const Eigen::VectorXd& point) {
    fitting::Residuals found = unweighted(point);
    for (std::size_t i = 0; i < found.size(); ++i) found[i] *= weights[i];
    return found;
  };
  std::vector<double> logs(runs.size());
  const auto weigh = [&] {
    const fitting::Residuals now = unweighted(x);
    for (std::size_t i = 0; i < now.size(); ++i) {
      logs[i] = log_of(now[i], noise_rad(runs[i]));
      weights[i] = std::exp(-logs[i]) * std::sqrt(kBlocksOfRun / static_cast<double>(now[i].size()));
    }
  };
  for (int round = 0; round < 3; ++round) {
    weigh();
    x = fitting::gauss_newton(problem, x,
                              {.most_iterations = most_iterations,
                               .relative_tolerance = 1e-3,
                               .most_tries = 12,  // from a screened start the first step may be far too long
                               .longest_step = 0.2})
            .x;
  }
  weigh();
  QuickFit fit = at(x);
  fit.log_error = logs;
  fit.loss = 0.0;
  for (const double log : logs) fit.loss += log / static_cast<double>(logs.size());
  const double prior = fitting::prior(problem.coordinates, x, problem.prior_weight).squares;
  fit.loss_with_prior = fit.loss + prior / (2.0 * kBlocksOfRun * static_cast<double>(runs.size()));
  return fit;
}

QuickFit QuickModel::fit(const std::vector<calib::SingleJoint>& runs) const {
  const calib::Unknowns free = unknowns(runs, {});
  return with_rate_limit(runs, minimised(runs, free, {.model = screened(runs, free)}, {}, 8));
}

QuickFit QuickModel::refit(const std::vector<calib::SingleJoint>& runs, const QuickFit& from,
                           const std::vector<SharedFactor>& shared, int most_iterations) const {
  return minimised(runs, unknowns(runs, from.extra), from, shared, most_iterations);
}

}  // namespace pmg::data_faults
