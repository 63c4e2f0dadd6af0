#include "evidence/power.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/noise_floor.hpp"
#include "fitting/statistics.hpp"

namespace pmg::evidence {

namespace {

const Signature* same_check(const std::vector<Signature>& checks, const Signature& as) {
  const auto found = std::find_if(checks.begin(), checks.end(), [&](const Signature& one) {
    return one.effect == as.effect && one.check == as.check && one.unit == as.unit;
  });
  return found == checks.end() || !std::isfinite(found->value.value + deviation(*found)) ? nullptr : &*found;
}

/// -2 log L of a normal distribution, without its constant.
double surprise(double away, double variance) { return away * away / variance + std::log(variance); }

}  // namespace

double deviation(const Signature& check) { return (check.value.high - check.value.low) / (2.0 * fitting::kNormal95); }

std::vector<bench::BenchRun> simulated_runs(const std::vector<calib::SingleJoint>& runs, const calib::JointModel& model,
                                            double quantum_rad, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<bench::BenchRun> found;
  for (const calib::SingleJoint& joint : runs) {
    found.push_back(joint.run());
    bench::Recording& r = found.back().recording;
    const double noise_rad = bench::sensor_noise_rad(r);
    try {
      r.q_rad = joint.rollout(model);
    } catch (const std::invalid_argument&) {
      continue;
    }
    r.valid.assign(r.valid.size(), true);
    for (double& q_rad : r.q_rad) {
      q_rad += noise_rad * normal(random);
      if (quantum_rad > 0.0) q_rad = quantum_rad * std::round(q_rad / quantum_rad);
    }
  }
  return found;
}

std::vector<Signature> CheckPower::expected(const calib::JointModel& model) const {
  return signatures(bench_, simulated_runs(runs_, model, quantum_rad_, 1), options_);
}

const std::vector<Signature>& CheckPower::recorded() {
  if (recorded_.empty()) {
    std::vector<bench::BenchRun> runs;
    for (const calib::SingleJoint& joint : runs_) runs.push_back(joint.run());
    recorded_ = signatures(bench_, runs, options_);
  }
  return recorded_;
}

bool CheckPower::refutes(const std::string& effect, const calib::JointModel& with, const calib::JointModel& without) {
  const std::vector<Signature> there = expected(with), absent = expected(without);
  const PowerOptions& o = options_.power;
  return std::any_of(recorded().begin(), recorded().end(), [&](const Signature& check) {
    if (check.effect != effect || check.agreement != Agreement::kDisagrees) return false;
    const Signature *with_it = same_check(there, check), *without_it = same_check(absent, check);
    if (with_it == nullptr || without_it == nullptr || with_it->agreement == Agreement::kDisagrees) return false;
    const double x = check.value.value, own = std::pow(deviation(check), 2);
    const double variance_with = own + std::pow(deviation(*with_it), 2) + 1e-300;
    const double variance_without = own + std::pow(deviation(*without_it), 2) + 1e-300;
    const double from_with = x - with_it->value.value, from_without = x - without_it->value.value;
    const bool compatible = std::abs(from_without) <= o.compatible_deviations * std::sqrt(variance_without);
    return compatible &&
           0.5 * (surprise(from_with, variance_with) - surprise(from_without, variance_without)) > o.refuting_log_ratio;
  });
}

std::optional<std::string> size_conflict(const Signature& recorded, const std::vector<Signature>& expected,
                                         const PowerOptions& options) {
  const Signature* simulated = same_check(expected, recorded);
  const double seen = recorded.value.value, own = deviation(recorded);
  if (simulated == nullptr || !std::isfinite(seen + own)) return std::nullopt;
  const double should = simulated->value.value, apart = std::abs(seen - should);
  if (apart <= options.size_deviations * std::hypot(own, deviation(*simulated)) ||
      apart <= options.size_share * std::max(std::abs(seen), std::abs(should)))
    return std::nullopt;
  return fmt::format("it measures {:.3g} {}, and would measure {:.3g} of the fitted joint", seen, recorded.unit,
                     should);
}

}  // namespace pmg::evidence
