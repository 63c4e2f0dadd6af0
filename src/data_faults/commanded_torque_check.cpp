// Sign and unit of the torque that the drive is commanded: a feed-forward, or the command of a drive whose law is
// torque.
#include "data_faults/commanded_torque_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/fit_results.hpp"
#include "data_faults/column_checks.hpp"
#include "data_faults/position_checks.hpp"
#include "data_faults/row_checks.hpp"
#include "data_faults/shared_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

constexpr int kRefitSteps = 5;
constexpr std::size_t kRefitted = 6;

struct Unit {
  std::string what;
  double factor;  ///< right value over the recorded one
};

std::vector<Unit> known_units(const Examined& e) {
  std::vector<Unit> units = {{"thousandths of its unit", 1e-3},
                             {"thousands of its unit", 1e3},
                             {"kilogram-force", 9.80665},
                             {"kilogram-force centimetres", 0.0980665}};
  const bench::DriveLaw law = e.bench().law;
  const double constant = e.fitted().model.actuator.drive.torque_per_unit_Nm;
  if (law == bench::DriveLaw::kCascadePd || law == bench::DriveLaw::kServoVoltage) {
    units.push_back({"volts", constant});
    units.push_back({"newtons that were divided by the torque constant twice", 1.0 / constant});
    if (law == bench::DriveLaw::kServoVoltage) units.push_back({"duty", constant * e.bench().supply_V});
  }
  return units;
}

bool commands_torque(const Examined& e, std::size_t run) {
  const std::vector<double>& torque = bench::values(e.runs()[run].recording, commanded_torque(e));
  return std::any_of(torque.begin(), torque.end(), [](double value) { return value != 0.0; });
}

/// The unit nearest to a measured factor; "" if the factor is none of a unit.
Unit unit_of(const Examined& e, double factor) {
  Unit nearest{"", factor};
  double apart = e.options().unit_tolerance;
  for (const Unit& unit : known_units(e)) {
    if (const double here = std::abs(std::log(std::abs(factor) / unit.factor)); here < apart) {
      apart = here;
      nearest = {unit.what, std::copysign(unit.factor, factor)};
    }
  }
  if (nearest.what.empty() && std::abs(std::log(std::abs(factor))) > std::log(e.options().strange_factor)) {
    nearest.what = "another unit";
  }
  return nearest;
}

/// Neither sign nor size of the factor is a fault: less than another unit is physics.
bool harmless(const Unit& unit) { return unit.what.empty() && unit.factor > 0.0; }

DataFault fault_of(const Examined& e, const Unit& unit, const std::vector<std::string>& files) {
  const std::string column = bench::column_name(commanded_torque(e), e.linear());
  const bool sign_only = unit.what.empty();
  DataFault fault{.kind = sign_only ? Kind::kSign : Kind::kUnit, .where = place_of(column, files), .correction = {}};
  const std::string of = files.empty() ? column : fmt::format("{} of {}", column, files.front());
  const double factor = sign_only ? -1.0 : unit.factor;
  fault.correction = sign_only ? fmt::format("turn the sign of {}", of)
                               : fmt::format("{} is in {}: multiply it by {:.5g}", of, unit.what, factor);
  fault.fixes = {{.files = files, .columns = {commanded_torque(e)}, .factor = factor}};
  fault.files = files;
  return fault;
}

/// A fit in which the commanded torque of some runs has another factor.
struct Outcome {
  double factor = 1.0, loss = 0.0;
  QuickFit fit;
};

Outcome refitted(const Examined& e, const std::vector<calib::SingleJoint>& joints, const std::vector<std::size_t>& with,
                 Outcome from) {
  if (from.factor == 0.0 || from.factor == 1.0) {
    from.fit = e.model().refit(joints, from.fit, {}, kRefitSteps);
  } else {
    from.fit = e.model().refit(joints, from.fit, {{.of = &RunFactors::commanded_torque, .runs = with}}, kRefitSteps);
    from.factor *= from.fit.factors.front();
  }
  from.loss = from.fit.loss;
  return from;
}

/// ln of the run's error with its commanded torque multiplied by the factor.
double log_error_with(const Examined& e, std::size_t run, double factor) {
  return data_faults::log_error_with(e, run, {.files = {}, .columns = {commanded_torque(e)}, .factor = factor});
}

/// The factor on one run's commanded torque that explains the run best, of one sign.
Outcome best_factor(const Examined& e, std::size_t run, double sign) {
  constexpr int kOctaves = 4, kRefinements = 8;  // the bracket falls to a fiftieth
  constexpr double kGolden = 0.6180339887498949;
  const auto error = [&](double log_factor) { return log_error_with(e, run, sign * std::exp(log_factor)); };
  const double grid = 0.5 * std::log(2.0);
  double best = 0.0, lowest = error(0.0);
  for (int k = -2 * kOctaves; k <= 2 * kOctaves; ++k) {
    if (const double here = error(grid * k); here < lowest) lowest = here, best = grid * k;
  }
  if (e.log_error()[run] - lowest < 0.5 * std::log(e.options().clear_gain)) return {sign, lowest, {}};
  double low = best - grid, high = best + grid;
  for (int k = 0; k < kRefinements; ++k) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (error(a) < error(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  if (const double here = error(0.5 * (low + high)); here < lowest) lowest = here, best = 0.5 * (low + high);
  return {sign * std::exp(best), lowest, {}};
}

/// True if a repeat of the run wants the factor, too: what comes again is no slip of one recording.
bool repeats_want_it(const Examined& e, std::size_t run, double factor) {
  return std::ranges::any_of(repeats_of(e, run), [&](std::size_t repeat) {
    return e.log_error()[repeat] - log_error_with(e, repeat, factor) > std::log(e.options().clear_gain);
  });
}

}  // namespace

bench::Column commanded_torque(const Examined& e) {
  return e.bench().law == bench::DriveLaw::kTorque ? bench::Column::kTorque : bench::Column::kFeedForward;
}

std::vector<DataFault> commanded_torque_fault(const Examined& e) {
  const DataFaultOptions& o = e.options();
  std::vector<std::size_t> with;
  for (std::size_t i = 0; i < e.few().size(); ++i) {
    if (commands_torque(e, e.few()[i])) with.push_back(i);
  }
  if (with.empty()) return {};
  const std::vector<calib::SingleJoint> joints = e.few_of(e.runs());
  std::vector<double> factors = {1.0, 4.0, 0.25, 2.0, 0.5};
  for (const Unit& unit : known_units(e)) factors.push_back(unit.factor);
  std::vector<Outcome> outcomes;
  const auto add = [&](double factor) {
    QuickFit from = e.fitted();
    from.model.feed_forward_scale = factor;
    double loss = 0.0;
    for (const double log : e.model().log_errors(joints, from.model)) loss += log / static_cast<double>(joints.size());
    outcomes.push_back({factor, loss, from});
  };
  for (const double factor : factors) add(factor);
  add(0.0);  // as well without it: then it tells nothing
  for (const double factor : factors) add(-factor);
  std::stable_sort(outcomes.begin() + 1, outcomes.end(),
                   [](const Outcome& a, const Outcome& b) { return a.loss < b.loss; });
  outcomes.resize(std::min(outcomes.size(), kRefitted));
  for (Outcome& outcome : outcomes) outcome = refitted(e, joints, with, outcome);
  const Outcome as_is = outcomes.front();
  const Outcome best = *std::min_element(outcomes.begin(), outcomes.end(),
                                         [](const Outcome& a, const Outcome& b) { return a.loss < b.loss; });
  const double share = static_cast<double>(with.size()) / static_cast<double>(joints.size());
  const double least = share * std::log(o.feed_forward_gain);
  const Unit unit = unit_of(e, best.factor);
  if (best.factor == 0.0 || harmless(unit) || as_is.loss - best.loss < least) return {};
  // A torque that is next to nothing explains a joint that sticks.
  double at_rest = 0.0;
  for (const calib::SingleJoint& joint : joints)
    at_rest += log_error_standing_still(joint) / static_cast<double>(joints.size());
  if (best.loss > at_rest + std::log(calib::kExplainedShare)) return {};
  // What one effect of the catalogue explains, too, is physics.
  if (e.model().with_best_effect(joints, as_is.fit).loss - best.loss < least) return {};
  DataFault fault = fault_of(e, unit, {});
  fault.evidence = {fmt::format("the model's error falls to {:.2g} of what it is without the correction",
                                std::exp((best.loss - as_is.loss) / share))};
  return {fault};
}

void try_commanded_torque(const Examined& e, std::size_t run, std::vector<Explained>& into) {
  const double before = e.log_error()[run];
  if (!commands_torque(e, run) || before < fitting::median(e.log_error())) return;  // no worse than the others
  const std::string file = e.runs()[run].file;
  const Follows by = follows(e, e.runs()[run]);
  // Where the torque is the command, readings and torque turned are the same joint; the planned motion tells them
  // apart.
  const bool readings_turned = e.bench().law == bench::DriveLaw::kTorque && by.known && by.turned;
  for (const double sign : {1.0, -1.0}) {
    if (sign < 0.0 && readings_turned) continue;
    const Unit unit = unit_of(e, best_factor(e, run, sign).factor);
    if (harmless(unit)) continue;
    DataFault fault = fault_of(e, unit, {file});
    const double after = data_faults::log_error_with(e, run, fault.fixes.front());
    fault.evidence = {gain_text(e, before, after)};
    bool sure = before - after > std::log(e.options().clear_gain) && mends(e, run, before, after);
    // A run in another load's row needs another torque, too.
    if (fault.kind == Kind::kUnit)
      sure = sure && after < lowest_log_error_of_rows(e, run) && !repeats_want_it(e, run, unit.factor);
    into.push_back({fault, before - after, sure});
  }
}

}  // namespace pmg::data_faults
