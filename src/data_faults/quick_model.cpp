#include "data_faults/quick_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bench/noise_floor.hpp"
#include "calib/fit_problem.hpp"
#include "calib/joint_runs.hpp"
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
constexpr int kScreened = 160, kScreenedRuns = 6;
constexpr double kLightRotor = 0.01;  // of the whole inertia: a lighter rotor moves nothing
constexpr double kLargestFactor = 100.0;
const double kSenseless = std::log(1e3);  // of a model that diverges: above all real ones

/// Van der Corput sequence: element n in this base, 0..1.
double halton(int n, int base) {
  double share = 1.0, value = 0.0;
  for (; n > 0; n /= base) {
    share /= base;
    value += share * (n % base);
  }
  return value;
}

/// The run's start from the recorded trend: noise of its sensor, in the unit of the readings.
double noise_rad(const calib::SingleJoint& joint) {
  return std::max(1e-7, bench::sensor_noise_rad(joint.run().recording));
}

calib::JointModel with_factors(calib::JointModel model, const RunFactors& factors) {
  model.actuator.drive.kp_scale *= factors.kp;
  model.actuator.drive.kd_scale *= factors.kd;
  model.inertia_scale *= factors.load;
  model.gravity_scale *= factors.load;
  model.feed_forward_scale *= factors.told_torque;
  return model;
}

std::vector<RunFactors> factors_of_runs(std::size_t runs, const std::vector<SharedFactor>& shared,
                                        const std::vector<double>& factors) {
  std::vector<RunFactors> found(runs);
  for (std::size_t s = 0; s < shared.size(); ++s) {
    for (const std::size_t run : shared[s].runs) found[run].*shared[s].of *= factors[s];
  }
  return found;
}

/// Simulated minus measured reading; 0 for dropouts and while the drive is off: a free swing magnifies every error.
/// Throws std::invalid_argument on impossible parameters.
Eigen::VectorXd residual(const calib::SingleJoint& joint, const calib::JointModel& model) {
  const bench::Recording& r = joint.run().recording;
  const std::vector<double> simulated_rad = joint.rollout(model);
  Eigen::VectorXd found(static_cast<Eigen::Index>(simulated_rad.size()));
  for (std::size_t k = 0; k < simulated_rad.size(); ++k) {
    const bool counts = r.valid[k] && (r.enabled.empty() || r.enabled[k]);
    found[static_cast<Eigen::Index>(k)] = counts ? simulated_rad[k] - r.q_rad[k] : 0.0;
  }
  return found;
}

double log_of(const Eigen::VectorXd& residual_rad, double noise_rad) {
  const auto counting = static_cast<double>((residual_rad.array() != 0.0).count());
  const double found = 0.5 * std::log(residual_rad.squaredNorm() / std::max(1.0, counting) + noise_rad * noise_rad);
  return std::isfinite(found) ? found : kSenseless;
}

}  // namespace

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
    return log_of(residual(joint, model), noise_rad(joint));
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

std::vector<effects::Unknown> QuickModel::unknowns(const std::vector<calib::SingleJoint>& runs,
                                                   const std::vector<std::string>& extra) const {
  std::vector<std::string> names = calib::basic_parameters(*bench_);
  const bool voltage = bench_->law == bench::DriveLaw::kServoVoltage;
  for (const char* name : {"friction.coulomb_Nm", "friction.viscous_Nm_s_per_rad", "command.delay_s",
                           "ripple.offset_Nm", "drive.torque_per_unit_Nm"}) {
    const bool torque = name == std::string("drive.torque_per_unit_Nm");
    if (torque && bench_->law != bench::DriveLaw::kCascadePd) continue;
    if (voltage && name == std::string("friction.viscous_Nm_s_per_rad")) continue;  // the back-EMF damps
    if (std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
  }
  const bool switched_off = std::any_of(runs.begin(), runs.end(), [](const calib::SingleJoint& joint) {
    const std::vector<bool>& enabled = joint.run().recording.enabled;
    return std::find(enabled.begin(), enabled.end(), false) != enabled.end();
  });
  if (voltage && switched_off) names.emplace_back("drive.brake_when_disabled");
  for (const std::string& name : extra) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  const effects::BenchScale scale = effects::scale_of(*bench_, runs, start_);
  std::vector<effects::Unknown> found;
  for (const std::string& name : names) {
    effects::Unknown u = effects::unknown(name, *bench_, scale);
    if (name == "command.delay_s") u.upper = std::min(u.upper, (sim::ActuatorModel::kDelaySteps - 1) * step_s_);
    if (name == "transmission.armature_kg_m2") u.lower = std::max(u.lower, kLightRotor * scale.inertia_kg_m2);
    const double known = calib::value(start_, name);
    const bool listed = std::find(bench_->unknown.begin(), bench_->unknown.end(), name) != bench_->unknown.end();
    const bool drive = name.starts_with("drive.");
    if (u.logarithmic && known > 0.0 && !(listed && !given_)) {
      u.lower = std::min(u.lower, 0.5 * known);
      u.upper = std::max(u.upper, 2.0 * known);
      u.expected = std::log(known);
      u.deviation = drive && name != "drive.kd_scale" ? kGainDeviation : kTrustedDeviation;
    }
    found.push_back(u);
  }
  return found;
}

/// Halton screening of the parameters without a prior, with a few scales of the gains: a drive's gain may be off by a
/// factor.
calib::JointModel QuickModel::screened(const std::vector<calib::SingleJoint>& runs,
                                       const std::vector<effects::Unknown>& unknowns) const {
  const std::vector<calib::SingleJoint> few = calib::spread(runs, kScreenedRuns);
  std::vector<calib::JointModel> models(given_ ? std::size(kGains) : kScreened, start_);
  constexpr int kBases[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  for (int n = 0; n < static_cast<int>(models.size()); ++n) {
    std::size_t dimension = 0;
    for (const effects::Unknown& u : unknowns) {
      const double share = halton(n + 1, kBases[dimension++ % std::size(kBases)]);
      calib::JointModel& model = models[static_cast<std::size_t>(n)];
      if (u.name == "drive.kp_scale" && u.deviation > 0.0) {
        calib::set(model, u.name,
                   calib::value(start_, u.name) * kGains[static_cast<std::size_t>(n) % std::size(kGains)]);
      }
      if (given_ || u.deviation > 0.0) continue;
      const double low = u.coordinate(u.lower), high = u.coordinate(u.upper);
      const bool torque = !u.logarithmic;  // friction and offsets are small beside the drive's torque
      calib::set(model, u.name, torque ? share * std::min(u.upper, u.typical) : u.value(low + share * (high - low)));
      if (u.name == "ripple.offset_Nm") calib::set(model, u.name, 0.0);
      if (u.name == "command.delay_s") calib::set(model, u.name, 0.5 * share * u.upper);
    }
  }
  std::vector<double> losses(models.size(), 0.0);
  work::for_each_in_parallel(models.size(), threads_, [&](std::size_t n) {
    for (const calib::SingleJoint& run : few) losses[n] += log_error(run, models[n]);
  });
  return models[static_cast<std::size_t>(std::min_element(losses.begin(), losses.end()) - losses.begin())];
}

QuickFit QuickModel::minimised(const std::vector<calib::SingleJoint>& runs,
                               const std::vector<effects::Unknown>& unknowns, const QuickFit& from,
                               const std::vector<SharedFactor>& shared, int most_iterations) const {
  const auto base = static_cast<Eigen::Index>(unknowns.size());
  Eigen::VectorXd x(base + static_cast<Eigen::Index>(shared.size()));
  fitting::Problem problem;
  for (Eigen::Index i = 0; i < base; ++i) {
    const effects::Unknown& u = unknowns[static_cast<std::size_t>(i)];
    problem.coordinates.push_back(u.range());
    x[i] = u.coordinate(calib::value(from.model, u.name));
  }
  for (std::size_t s = 0; s < shared.size(); ++s) {
    const double most = std::log(kLargestFactor);
    problem.coordinates.push_back({-most, most, 1e-2, 0.0, shared[s].deviation});
    x[base + static_cast<Eigen::Index>(s)] = from.factors.size() == shared.size() ? std::log(from.factors[s]) : 0.0;
  }
  problem.prior_weight = 1.0;
  const auto at = [&](const Eigen::VectorXd& point) {
    QuickFit fit = from;
    for (Eigen::Index i = 0; i < base; ++i) {
      const effects::Unknown& u = unknowns[static_cast<std::size_t>(i)];
      calib::set(fit.model, u.name, u.value(point[i]));
    }
    fit.factors.clear();
    for (Eigen::Index s = base; s < point.size(); ++s) fit.factors.push_back(std::exp(point[s]));
    return fit;
  };
  std::vector<double> weights(runs.size(), 1.0);
  const auto unweighted = [&](const Eigen::VectorXd& point) {
    const QuickFit fit = at(point);
    const std::vector<RunFactors> factors = factors_of_runs(runs.size(), shared, fit.factors);
    fitting::Residuals found(runs.size());
    try {
      work::for_each_in_parallel(runs.size(), threads_, [&](std::size_t i) {
        found[i] = residual(runs[i], with_factors(fit.model, factors[i]));
      });
    } catch (const std::invalid_argument&) {
      return fitting::Residuals{};
    }
    return found;
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
  double prior = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const fitting::Coordinate& c = problem.coordinates[static_cast<std::size_t>(i)];
    if (c.deviation > 0.0 && std::isfinite(c.expected)) prior += std::pow((x[i] - c.expected) / c.deviation, 2);
  }
  fit.loss_with_prior = fit.loss + prior / (2.0 * kBlocksOfRun * static_cast<double>(runs.size()));
  return fit;
}

QuickFit QuickModel::fit(const std::vector<calib::SingleJoint>& runs) const {
  const std::vector<effects::Unknown> free = unknowns(runs, {});
  return with_rate_limit(runs, minimised(runs, free, {.model = screened(runs, free)}, {}, 8));
}

QuickFit QuickModel::refit(const std::vector<calib::SingleJoint>& runs, const QuickFit& from,
                           const std::vector<SharedFactor>& shared, int most_iterations) const {
  return minimised(runs, unknowns(runs, from.extra), from, shared, most_iterations);
}

}  // namespace pmg::data_faults
