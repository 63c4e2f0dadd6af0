#include "data_faults/shared_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "calib/joint_runs.hpp"
#include "calib/unknown.hpp"
#include "data_faults/column_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

constexpr int kIterations = 5;

/// Runs that have one value of a number in common; indices into the few runs that are fitted.
struct Group {
  std::vector<std::size_t> runs;
  double value = 0.0;
};

/// A fit with one factor free, and the mean fall of ln(error) over the runs.
struct Tried {
  QuickFit fit;
  double factor = 1.0;
  double gain = 0.0, gain_deviation = 0.0;  ///< mean over the group's runs of the fall of ln error, and its deviation
};

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Mean, and its standard deviation.
std::pair<double, double> mean_and_deviation(const std::vector<double>& values) {
  const double middle = mean(values);
  double squares = 0.0;
  for (const double value : values) squares += std::pow(value - middle, 2);
  const auto n = static_cast<double>(values.size());
  return {middle, n < 2.0 ? 0.0 : std::sqrt(squares / (n - 1.0) / n)};
}

class Groups {
 public:
  Groups(const Examined& examined, double RunFactors::*of) : e_(&examined), of_(of) {
    std::map<double, Group> found;
    for (std::size_t i = 0; i < e_->few().size(); ++i) {
      const bench::BenchRun& run = e_->runs()[e_->few()[i]];
      const double value = of == &RunFactors::kp ? run.kp : of == &RunFactors::kd ? run.kd : run.load.inertia_kg_m2;
      found[value].runs.push_back(i);
      found[value].value = value;
    }
    for (auto& [value, group] : found) {
      if (value != 0.0) groups_.push_back(group);
    }
    joints_ = e_->few_of(e_->runs());
    // The same number of steps without a factor: what is left of the fit's own way is no gain of a factor.
    without_ = e_->model().refit(joints_, e_->fitted(), {}, kIterations);
  }

  const std::vector<Group>& all() const { return groups_; }

  /// The same groups beside the effect that explains the runs best without a factor.
  Groups beside_physics() const {
    Groups found = *this;
    found.without_ = e_->model().with_best_effect(joints_, without_);
    return found;
  }

  /// One factor for these groups together.
  Tried with(const std::vector<std::size_t>& which) const {
    return judged(refit({{.of = of_, .runs = of(which)}}), which);
  }

  /// A fit with one factor for these groups, against the fit without.
  Tried judged(const QuickFit& fit, const std::vector<std::size_t>& which) const {
    Tried tried{.fit = fit, .factor = fit.factors.front()};
    std::vector<double> gains;
    for (const std::size_t run : of(which)) gains.push_back(without_.log_error[run] - fit.log_error[run]);
    std::tie(tried.gain, tried.gain_deviation) = mean_and_deviation(gains);
    return tried;
  }

  Tried common() const {
    std::vector<std::size_t> every(groups_.size());
    for (std::size_t g = 0; g < every.size(); ++g) every[g] = g;
    return with(every);
  }

  /// All factors at once, each expected near 1: which group stands apart.
  std::vector<double> together() const {
    std::vector<SharedFactor> shared;
    for (const Group& group : groups_) shared.push_back({.of = of_, .runs = group.runs, .deviation = 0.3});
    return refit(shared).factors;
  }

  /// Share of the runs that a group has.
  double share(std::size_t group) const {
    return static_cast<double>(groups_[group].runs.size()) / static_cast<double>(joints_.size());
  }

  const QuickFit& without() const { return without_; }

 private:
  std::vector<std::size_t> of(const std::vector<std::size_t>& which) const {
    std::vector<std::size_t> runs;
    for (const std::size_t g : which) runs.insert(runs.end(), groups_[g].runs.begin(), groups_[g].runs.end());
    return runs;
  }

  QuickFit refit(const std::vector<SharedFactor>& shared) const {
    return e_->model().refit(joints_, without_, shared, kIterations);
  }

  const Examined* e_;
  double RunFactors::*of_;
  std::vector<Group> groups_;
  std::vector<calib::SingleJoint> joints_;
  QuickFit without_;
};

bool beyond(double factor, double least) { return std::abs(std::log(factor)) > std::log(least); }

bool firmware_factor(double factor, double tolerance) {
  constexpr double kFactors[] = {2.0, 4.0, 8.0, 10.0, 16.0, 32.0, 57.29577951308232, 64.0, 100.0};
  return std::any_of(std::begin(kFactors), std::end(kFactors),
                     [&](double known) { return std::abs(std::abs(std::log(factor)) - std::log(known)) < tolerance; });
}

/// What a factor must be and do to be believed.
struct Demand {
  double least_factor, least_gain;
  bool small_if_exact;       ///< a smaller factor is believed, too, if it leaves nothing to explain
  bool known_factors_count;  ///< a firmware's factor needs no comparison with physics
};

struct Odd {
  int group = -1;
  Tried tried;
  bool sure = false;                   ///< however small its factor is
  std::vector<std::string> instead{};  ///< other groups whose factor explains the runs as well, as sentences
};

/// True if the factor surely divides the error of its runs by so much.
bool divides_error(const Tried& tried, double by, const DataFaultOptions& o) {
  return tried.gain > std::log(by) && tried.gain > o.factor_deviations * tried.gain_deviation;
}

/// Clear by its size, whatever else the joint does.
bool clear(const Tried& tried, const Demand& demand, const DataFaultOptions& o) {
  return beyond(tried.factor, demand.least_factor) && divides_error(tried, demand.least_gain, o);
}

/// A small factor after which the model misses the readings by no more than repeats differ, or by so much less that
/// nothing else does that.
bool sure(const Examined& e, const Groups& groups, const Tried& tried, const Demand& demand) {
  const DataFaultOptions& o = e.options();
  return demand.small_if_exact && beyond(tried.factor, o.least_exact_factor) &&
         (divides_error(tried, o.overwhelming_gain, o) || e.floors(tried.fit) < o.exact_floors) &&
         evidence(tried.fit, groups.without()) > o.exact_evidence;
}

/// How far a model's torque per radian is from the one that was known before [logarithm].
double gain_off(const Examined& e, const calib::JointModel& model) {
  const auto& now = model.actuator.drive;
  const auto& known = e.model().start().drive;
  return std::abs(std::log(now.kp_scale * now.torque_per_unit_Nm / (known.kp_scale * known.torque_per_unit_Nm)));
}

/// The group whose factor alone explains the runs, clearly better than a common factor of all groups does, and than one
/// effect of the catalogue; -1 if none.
Odd odd_one(const Examined& e, const Groups& groups, const Demand& demand) {
  const DataFaultOptions& o = e.options();
  Odd found;
  if (groups.all().size() < 2) return found;
  const double least_factor = demand.small_if_exact ? o.least_exact_factor : demand.least_factor;
  const std::vector<double> together = groups.together();
  const auto [low, high] = std::minmax_element(together.begin(), together.end());
  if (!beyond(*high / *low, least_factor)) return found;
  std::vector<Odd> believed;
  for (std::size_t g = 0; g < groups.all().size(); ++g) {
    std::vector<double> others;
    for (std::size_t i = 0; i < together.size(); ++i) {
      if (i != g) others.push_back(std::log(together[i]));
    }
    if (std::abs(std::log(together[g]) - fitting::median(others)) < 0.5 * std::log(least_factor)) continue;
    const Tried tried = groups.with({g});
    const Odd odd{static_cast<int>(g), tried, sure(e, groups, tried, demand)};
    if (odd.sure || clear(tried, demand, o)) believed.push_back(odd);
  }
  if (believed.empty()) return found;
  const QuickFit best =
      std::ranges::min_element(believed, {}, [](const Odd& one) { return one.tried.fit.loss_with_prior; })->tried.fit;
  // Where both are sure, the better fit is the quick model's form.
  std::erase_if(believed, [&](const Odd& one) {
    return !one.sure && evidence(best, one.tried.fit) > std::pow(o.factor_deviations, 2);
  });
  // Either of two halves may be odd where the drive's gain is free: the other is as that is known. Then the best fit.
  found = *std::ranges::min_element(believed, {}, [&](const Odd& one) {
    return std::pair(gain_off(e, one.tried.fit.model), one.tried.fit.loss_with_prior);
  });
  for (const Odd& other : believed) {
    if (other.group == found.group) continue;
    found.instead.push_back(fmt::format("{:.3g} instead, times {:.3g}, explains the runs as well: check both",
                                        groups.all()[static_cast<std::size_t>(other.group)].value, other.tried.factor));
  }
  const auto group = static_cast<std::size_t>(found.group);
  // What all groups share is physics, or another fault.
  if (groups.common().fit.loss - found.tried.fit.loss < groups.share(group) * std::log(o.better_than_common)) return {};
  if (demand.known_factors_count && firmware_factor(found.tried.factor, o.unit_tolerance) &&
      found.tried.gain > std::log(o.clear_gain))
    return found;
  // What one effect of the catalogue explains, too, is physics.
  const Groups physics = groups.beside_physics();
  Tried beside = physics.with({group});
  // The factor alone is one of the fits that have the effect as well.
  if (beside.fit.loss > found.tried.fit.loss) beside = physics.judged(found.tried.fit, {group});
  if (clear(beside, demand, o))
    return {found.group, beside, found.sure, found.instead};  // the better model knows the factor better
  if (found.sure && evidence(found.tried.fit, physics.without()) > o.exact_evidence) return found;
  return {};
}

std::string deviation_text(const Tried& tried) {
  return fmt::format("with this factor the model's error on these runs falls to {:.2g} of what it is without",
                     std::exp(-tried.gain));
}

std::vector<std::string> files_with(const Examined& e, const std::function<bool(const bench::BenchRun&)>& holds) {
  std::vector<std::string> files;
  for (const bench::BenchRun& run : e.runs()) {
    if (holds(run)) files.push_back(run.file);
  }
  return files;
}

DataFault gain_text(const Examined& e, const std::string& column, double value, double factor, const Tried& tried) {
  DataFault fault{.kind = Kind::kGainFactor, .where = {}, .correction = {}};
  const bool one = value > 0.0;
  fault.where = one ? fmt::format("runs.csv, column {}, rows with {:.6g}", column, value)
                    : fmt::format("runs.csv, column {}, all rows", column);
  fault.correction = fmt::format("{} acts as {:.3g} times its number{}", column, factor,
                                 one ? fmt::format(": {:.4g} instead of {:.4g}", value * factor, value) : "");
  fault.evidence = {fmt::format("{} runs of {} were compared", e.few().size(), e.runs().size()), deviation_text(tried)};
  return fault;
}

DataFault one_gain(const Examined& e, double RunFactors::*of, double value, const Tried& tried) {
  const bool kp = of == &RunFactors::kp;
  const std::string column = !kp                                               ? "kd_Nm_s_per_rad"
                             : e.bench().law == bench::DriveLaw::kServoVoltage ? "kp_firmware"
                                                                               : "kp_Nm_per_rad";
  DataFault fault = gain_text(e, column, value, tried.factor, tried);
  fault.files = files_with(e, [&](const bench::BenchRun& run) { return (kp ? run.kp : run.kd) == value; });
  bench::Correction fix{.files = fault.files, .columns = {}};
  (kp ? fix.kp_factor : fix.kd_factor) = tried.factor;
  fault.fixes = {fix};
  return fault;
}

DataFault one_load(const Examined& e, double inertia_kg_m2, const Tried& tried) {
  DataFault fault{.kind = Kind::kMass, .where = {}, .correction = {}};
  fault.where = fmt::format("bench.yaml, loads: the one with inertia_kg_m2 {:.6g}", inertia_kg_m2);
  for (std::size_t l = 0; l < e.bench().loads.size(); ++l) {
    const bench::BenchLoad& load = e.bench().loads[l];
    if (load.load.inertia_kg_m2 != inertia_kg_m2) continue;
    fault.where =
        fmt::format("bench.yaml, loads[{}] (mass_kg {:.6g}, length_m {:.6g})", l, load.mass_kg, load.length_m);
    fault.correction = fmt::format("mass_kg {:.4g} instead of {:.4g}: ", load.mass_kg * tried.factor, load.mass_kg);
  }
  fault.correction += fmt::format("inertia and gravity times {:.3g}", tried.factor);
  fault.evidence = {deviation_text(tried)};
  fault.files = files_with(e, [&](const bench::BenchRun& run) { return run.load.inertia_kg_m2 == inertia_kg_m2; });
  fault.fixes = {{.files = fault.files, .columns = {}, .load_factor = tried.factor}};
  return fault;
}

std::vector<DataFault> gain_fault_of(const Examined& e, double RunFactors::*of) {
  const DataFaultOptions& o = e.options();
  const bool kp = of == &RunFactors::kp;
  const Groups groups(e, of);
  if (groups.all().empty()) return {};
  const Odd odd = odd_one(e, groups, {o.least_gain_factor, kp ? o.gain_gain : o.damping_gain, kp, kp});
  // Friction and speed limits change what a damping does by any factor: of kd only a firmware's factor is believed.
  if (odd.group < 0 || !(kp || firmware_factor(odd.tried.factor, o.unit_tolerance))) return {};
  DataFault fault = one_gain(e, of, groups.all()[static_cast<std::size_t>(odd.group)].value, odd.tried);
  fault.evidence.insert(fault.evidence.end(), odd.instead.begin(), odd.instead.end());
  return {fault};
}

/// The factor of one number with which a given model misses some runs least, whatever it is for the other runs.
struct BestFactor {
  double value = 0.0;  ///< of the number
  std::vector<calib::SingleJoint> runs;
  double log_factor = 0.0;
};

std::vector<double> errors_with(const Examined& e, const BestFactor& one, const calib::JointModel& model,
                                double RunFactors::*of, double log_factor) {
  RunFactors factors;
  factors.*of = std::exp(log_factor);
  return e.model().log_errors(one.runs, with_factors(model, factors));
}

std::vector<BestFactor> best_factors(const Examined& e, const calib::JointModel& model, double RunFactors::*of) {
  constexpr std::size_t kMostRuns = 12;
  constexpr int kSteps = 12;
  const double step = std::log(2.5) / kSteps;
  std::map<double, std::vector<calib::SingleJoint>> runs;
  for (const bench::BenchRun& run : e.runs())
    runs[of == &RunFactors::kp ? run.kp : run.load.inertia_kg_m2].push_back(e.model().joint(run));
  std::vector<BestFactor> found;
  for (const auto& [value, all] : runs) {
    if (value == 0.0) continue;
    BestFactor one{.value = value, .runs = calib::spread(all, kMostRuns)};
    std::vector<double> loss;
    for (int i = -kSteps; i <= kSteps; ++i) loss.push_back(mean(errors_with(e, one, model, of, i * step)));
    const auto least = std::clamp<std::ptrdiff_t>(std::ranges::min_element(loss) - loss.begin(), 1, 2 * kSteps - 1);
    const double before = loss[least - 1], at = loss[least], after = loss[least + 1];
    const double bend = before - 2.0 * at + after;
    const double beside = bend > 0.0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
    one.log_factor = (static_cast<double>(least - kSteps) + beside) * step;
    found.push_back(std::move(one));
  }
  return found;
}

/// The value whose runs want another factor than those of all other values, which want about the same; and that factor
/// over theirs.
std::optional<std::pair<double, Tried>> apart(const Examined& e, const calib::JointModel& model, double RunFactors::*of,
                                              double least_factor, double least_gain) {
  constexpr std::size_t kFewestValues = 3;  // of two nothing tells which one is wrong
  constexpr std::size_t kFewestRunsOfValue = 3;
  const DataFaultOptions& o = e.options();
  const std::vector<BestFactor> all = best_factors(e, model, of);
  if (all.size() < kFewestValues) return std::nullopt;
  for (const BestFactor& one : all) {
    std::vector<double> others;
    for (const BestFactor& other : all) {
      if (other.value != one.value) others.push_back(other.log_factor);
    }
    const double usual = fitting::median(others), off = one.log_factor - usual;
    const bool stands_apart = std::ranges::all_of(
        others, [&](double other) { return std::abs(other - usual) < o.others_within * std::abs(off); });
    Tried tried{.fit = {}, .factor = std::exp(off)};
    if (one.runs.size() < kFewestRunsOfValue || !stands_apart || !beyond(tried.factor, least_factor)) continue;
    std::vector<double> gains = errors_with(e, one, model, of, usual);
    const std::vector<double> with = errors_with(e, one, model, of, one.log_factor);
    for (std::size_t i = 0; i < gains.size(); ++i) gains[i] -= with[i];
    std::tie(tried.gain, tried.gain_deviation) = mean_and_deviation(gains);
    if (divides_error(tried, least_gain, o)) return std::pair(one.value, tried);
  }
  return std::nullopt;
}

}  // namespace

std::vector<DataFault> mass_fault(const Examined& e) {
  const DataFaultOptions& o = e.options();
  const Groups groups(e, &RunFactors::load);
  const Odd odd = odd_one(e, groups, {o.least_mass_factor, o.mass_gain, true, false});
  if (odd.group < 0) return {};
  DataFault fault = one_load(e, groups.all()[static_cast<std::size_t>(odd.group)].value, odd.tried);
  fault.evidence.insert(fault.evidence.end(), odd.instead.begin(), odd.instead.end());
  return {fault};
}

std::vector<DataFault> gain_fault_beside(const Examined& e, const calib::JointModel& model) {
  if (e.bench().law == bench::DriveLaw::kTorque) return {};
  const DataFaultOptions& o = e.options();
  const auto odd = apart(e, model, &RunFactors::kp, o.least_gain_factor, o.gain_gain);
  if (!odd) return {};
  return {one_gain(e, &RunFactors::kp, odd->first, odd->second)};
}

std::vector<DataFault> mass_fault_beside(const Examined& e, const calib::JointModel& model) {
  const DataFaultOptions& o = e.options();
  const auto odd = apart(e, model, &RunFactors::load, o.least_mass_factor, o.mass_gain);
  if (!odd) return {};
  return {one_load(e, odd->first, odd->second)};
}

std::vector<DataFault> gain_fault(const Examined& e) {
  if (e.bench().law == bench::DriveLaw::kTorque) return {};  // it has no gains
  std::vector<DataFault> found = gain_fault_of(e, &RunFactors::kp);
  if (!found.empty() || e.bench().law == bench::DriveLaw::kServoVoltage) return found;
  found = gain_fault_of(e, &RunFactors::kd);
  if (!found.empty()) return found;
  // All gains: beyond what a drive's gain is off by. Without known loads nothing tells the gain from them.
  if (!calib::unknown_loads(e.bench()).empty()) return {};
  const double factor = e.fitted().model.actuator.drive.kp_scale / e.bench().known.drive.kp_scale;
  if (e.bench().law != bench::DriveLaw::kPositionPd ||
      !beyond(factor, 1.0 + 0.5 * (e.options().least_common_gain - 1.0)))
    return {};
  const Groups groups(e, &RunFactors::kp);
  const Tried common = groups.common();
  const double whole = common.factor * common.fit.model.actuator.drive.kp_scale;
  if (!beyond(whole, e.options().least_common_gain)) return {};
  // A joint that does something else is best hidden by a gain.
  if (const double floors = e.floors(common.fit); std::isfinite(floors) && floors > e.options().largest_usual_error)
    return {};
  DataFault fault = gain_text(e, "kp_Nm_per_rad", 0.0, whole, common);
  fault.evidence = {fmt::format("load and inertia of bench.yaml need {:.3g} times the gain", whole)};
  fault.fixes = {{.files = {}, .columns = {}, .kp_factor = whole}};
  return {fault};
}

}  // namespace pmg::data_faults
