#include "data_faults/column_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "evidence/motion.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// A column and what it should be by the others.
struct Pair {
  bench::Column column;
  std::string expected;  ///< in words
  std::function<std::vector<double>(std::size_t run)> of;
  std::vector<WrongUnit> units;
  double may_lag_s;       ///< a reading may be filtered
  double strange_factor;  ///< a factor beyond it is a fault though no unit is known for it
};

std::vector<double> derivative_of_readings(const bench::Bench& bench, const bench::BenchRun& run) {
  return evidence::motion(bench, run).dq_rad_s;
}

/// Central differences; unknown beside a jump.
std::vector<double> derivative_of_commands(const bench::Recording& r) {
  std::vector<double> found(r.t_s.size(), kNothing);
  for (std::size_t k = 1; k + 1 < r.t_s.size(); ++k) {
    found[k] = (r.q_cmd_rad[k + 1] - r.q_cmd_rad[k - 1]) / (r.t_s[k + 1] - r.t_s[k - 1]);
  }
  for (const std::size_t step : evidence::command_steps(r)) {
    for (std::size_t k = step < 2 ? 0 : step - 2; k < std::min(step + 3, found.size()); ++k) found[k] = kNothing;
  }
  return found;
}

std::vector<WrongUnit> speed_units(const bench::Bench& bench) {
  const bool linear = bench.rig == bench::Rig::kLinear;
  std::vector<WrongUnit> units = position_units(linear);
  if (!linear) units.push_back({"revolutions per minute", 30.0 / std::numbers::pi});
  return units;
}

/// What the drive's law gives for a run's readings, in Nm or V.
class LawOutput {
 public:
  LawOutput(const bench::Bench& bench, const bench::BenchRun& run) : bench_(bench), run_(run), computed_(run) {
    computed_.recording.torque_Nm.clear();
    motion_ = evidence::motion(bench, computed_);
  }
  /// With the commands of `delay_s` before; unknown at the limit.
  std::vector<double> after(double delay_s) {
    const bench::Recording& r = run_.recording;
    bench::Recording& late = computed_.recording;
    for (auto commands : {&bench::Recording::q_cmd_rad, &bench::Recording::dq_cmd_rad_s, &bench::Recording::tau_ff_Nm})
      if (!(r.*commands).empty()) late.*commands = bench::shifted(r.t_s, r.*commands, -delay_s);
    evidence::compute_drive(bench_, computed_, motion_);
    for (std::size_t k = 0; k < motion_.drive.size(); ++k) {
      const bool on = r.enabled.empty() || r.enabled[k];
      if (motion_.at_limit[k] || !on || !r.valid[k]) motion_.drive[k] = kNothing;
    }
    return motion_.drive;
  }

 private:
  const bench::Bench& bench_;
  const bench::BenchRun& run_;
  bench::BenchRun computed_;
  evidence::Motion motion_;
};

struct Finding {
  std::size_t run;
  Alignment by;
  WrongUnit unit;  ///< empty: none
  bool turned = false, strange = false, shifted = false;
  bool faulty() const { return turned || strange || shifted || !unit.name.empty(); }
  bool same_as(const Finding& other, double sample_s) const {
    const bool factor = turned == other.turned && strange == other.strange && unit.name == other.unit.name;
    const bool time = shifted == other.shifted && (!shifted || std::abs(by.lag_s - other.by.lag_s) <=
                                                                   std::max(2.5 * sample_s, 0.2 * std::abs(by.lag_s)));
    return factor && time;
  }
};

Finding judged(std::size_t run, const Alignment& by, const Pair& pair, double sample_s, const DataFaultOptions& o) {
  Finding found{.run = run, .by = by, .unit = {}};
  if (!by.known || std::abs(by.correlation) < o.sure_correlation) return found;
  found.turned = by.factor < 0.0;
  found.unit = unit_of_factor(std::abs(by.factor), pair.units, o.unit_tolerance);
  const double size = std::max(std::abs(by.factor), 1.0 / std::abs(by.factor));
  found.strange = found.unit.name.empty() && size > pair.strange_factor;
  const double least_s = std::max<double>(o.shift_samples * sample_s, o.least_shift_s);
  const double before = 1.0 - std::pow(by.correlation_unshifted, 2), after = 1.0 - std::pow(by.correlation, 2);
  const bool late = by.lag_s > std::max(least_s, pair.may_lag_s), early = by.lag_s < -least_s;
  found.shifted = (late || early) && after < o.shift_rest * before;
  return found;
}

/// One fault of those runs that show the same.
void describe(const Finding& one, const std::vector<double>& factors, const std::vector<double>& lags_s,
              const Pair& pair, const std::string& column, const std::vector<std::string>& files,
              std::vector<DataFault>& into) {
  const double factor = fitting::median(factors), lag_s = fitting::median(lags_s);
  const std::string where = place_of(column, files);
  const std::string measured = fmt::format("{} is {:.4g} times {} (median of {} runs, correlation {:.3f})", column,
                                           factor, pair.expected, factors.size(), std::abs(one.by.correlation));
  if (one.turned || one.strange || !one.unit.name.empty()) {
    const double by = (one.turned ? -1.0 : 1.0) / (one.strange             ? std::abs(factor)
                                                   : one.unit.name.empty() ? 1.0
                                                                           : one.unit.per_unit);
    const bool sign_only = one.turned && one.unit.name.empty() && !one.strange;
    DataFault fault{.kind = sign_only ? Kind::kSign : Kind::kUnit, .where = where, .correction = {}};
    fault.correction = sign_only ? fmt::format("turn the sign of {}", column)
                       : one.unit.name.empty()
                           ? fmt::format("multiply {} by {:.4g}: its unit is another one", column, by)
                           : fmt::format("{} is in {}: multiply it by {:.6g}", column, one.unit.name, by);
    fault.evidence = {measured};
    fault.files = files;
    fault.fixes = {{.files = files, .columns = {pair.column}, .factor = by}};
    into.push_back(fault);
  }
  if (one.shifted) {
    DataFault fault{.kind = Kind::kTimeShift, .where = where, .correction = {}};
    fault.correction = fmt::format("{} is {:.4g} s {}: move it by {:.4g} s", column, std::abs(lag_s),
                                   lag_s > 0.0 ? "late" : "early", -lag_s);
    fault.evidence = {fmt::format("{} correlates with {} by {:.3f} if it is moved by {:.4g} s, by {:.3f} as it is",
                                  column, pair.expected, std::abs(one.by.correlation), -lag_s,
                                  std::abs(one.by.correlation_unshifted))};
    fault.files = files;
    fault.fixes = {{.files = files, .columns = {pair.column}, .shift_s = lag_s}};
    into.push_back(fault);
  }
}

void check(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs, const Pair& pair,
           const DataFaultOptions& o, std::vector<DataFault>& into) {
  const double sample_s = 1.0 / bench.sample_rate_hz;
  std::vector<Finding> findings;
  std::size_t informative = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::vector<double>& column = bench::values(runs[i].recording, pair.column);
    if (column.empty()) continue;
    const Alignment by = align(pair.of(i), column, sample_s, o.longest_shift_s, o.longest_shift_s);
    if (by.known && std::abs(by.correlation) >= o.sure_correlation) ++informative;
    const Finding one = judged(i, by, pair, sample_s, o);
    if (one.faulty()) findings.push_back(one);
  }
  const std::string column = bench::column_name(pair.column, bench.rig == bench::Rig::kLinear);
  while (!findings.empty()) {
    const Finding first = findings.front();
    std::vector<double> factors, lags_s;
    std::vector<std::string> files;
    std::erase_if(findings, [&](const Finding& one) {
      if (!first.same_as(one, sample_s)) return false;
      factors.push_back(one.by.factor);
      lags_s.push_back(one.by.lag_s);
      files.push_back(runs[one.run].file);
      return true;
    });
    const bool all = static_cast<double>(files.size()) >= o.same_kind_share * static_cast<double>(informative);
    describe(first, factors, lags_s, pair, column, all ? std::vector<std::string>{} : files, into);
  }
}

/// How long ago the commands were given that the drives follow, [s]: at high gains a delay's error of position exceeds
/// what makes the torque. The model's delay comes from the readings; a command that is held acts up to a sample later.
/// Of these the delay at which the law's output and the column are most alike, whatever lies between them in time: the
/// median over some of the runs.
double delay_of_commands_s(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs, bench::Column column,
                           std::vector<LawOutput>& laws, double model_delay_s, const DataFaultOptions& o) {
  constexpr std::size_t kRuns = 8;
  constexpr std::array kHeld = {0.0, 0.25, 0.5, 0.75, 1.0, 1.25};  // samples
  const double sample_s = 1.0 / bench.sample_rate_hz;
  std::array<std::vector<double>, kHeld.size()> alike;
  for (std::size_t i = 0; i < runs.size(); i += (runs.size() + kRuns - 1) / kRuns) {
    const std::vector<double>& recorded = bench::values(runs[i].recording, column);
    if (recorded.empty()) continue;
    for (std::size_t h = 0; h < kHeld.size(); ++h) {
      const Alignment by = align(laws[i].after(model_delay_s + kHeld[h] * sample_s), recorded, sample_s,
                                 o.longest_shift_s, o.longest_shift_s);
      alike[h].push_back(by.known ? std::abs(by.correlation) : 0.0);
    }
  }
  if (alike.front().empty()) return model_delay_s;
  const auto best = std::ranges::max_element(alike, {}, [](const auto& one) { return fitting::median(one); });
  return model_delay_s + kHeld[static_cast<std::size_t>(best - alike.begin())] * sample_s;
}

}  // namespace

std::vector<WrongUnit> position_units(bool linear) {
  if (linear) return {{"millimetres", 1000.0}, {"centimetres", 100.0}, {"inches", 1.0 / 0.0254}};
  return {{"degrees", 180.0 / std::numbers::pi}, {"turns", 0.5 / std::numbers::pi}, {"milliradians", 1000.0}};
}

WrongUnit unit_of_factor(double factor, const std::vector<WrongUnit>& units, double tolerance) {
  for (const WrongUnit& unit : units) {
    if (std::abs(std::log(factor / unit.per_unit)) < tolerance) return unit;
  }
  return {};
}

std::string place_of(const std::string& column, const std::vector<std::string>& files) {
  constexpr std::size_t kNamed = 6;
  if (files.empty()) return fmt::format("column {} of all runs", column);
  const std::vector<std::string> first(files.begin(),
                                       files.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, files.size())));
  const std::string more = files.size() > kNamed ? fmt::format(" and {} more", files.size() - kNamed) : "";
  return fmt::format("column {} of {}{}", column, fmt::join(first, ", "), more);
}

std::vector<DataFault> supply_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                     const DataFaultOptions& options) {
  std::vector<double> supplies_V;
  std::vector<std::size_t> recorded;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].recording.bus_V.empty()) continue;
    recorded.push_back(i);
    supplies_V.push_back(fitting::median(runs[i].recording.bus_V));
  }
  if (recorded.empty()) return {};
  const double usual_V = fitting::median(supplies_V), nominal_V = bench.nominal_supply_V.value_or(usual_V);
  const std::string column = bench::column_name(bench::Column::kBus, false);
  std::vector<DataFault> found;
  for (const auto& [name, per_unit] :
       {std::pair{"tenths of a volt", 10.0}, {"hundredths of a volt", 100.0}, {"mV", 1000.0}}) {
    std::vector<std::string> files;
    std::vector<double> values_V;
    for (std::size_t i = 0; i < recorded.size(); ++i) {
      if (!(std::abs(std::log(supplies_V[i] / per_unit / nominal_V)) < options.supply_tolerance)) continue;
      files.push_back(runs[recorded[i]].file);
      values_V.push_back(supplies_V[i]);
    }
    if (files.empty()) continue;
    if (static_cast<double>(files.size()) >= options.same_kind_share * static_cast<double>(recorded.size()))
      files.clear();
    found.push_back(
        {.kind = Kind::kUnit,
         .where = place_of(column, files),
         .correction = fmt::format("{} is in {}: multiply it by {:g}", column, name, 1.0 / per_unit),
         .evidence = {fmt::format("its median is {:.4g} V; {} {:.4g} V", fitting::median(values_V),
                                  bench.nominal_supply_V ? "bench.yaml says" : "that of all runs is", nominal_V)},
         .fixes = {{.files = files, .columns = {bench::Column::kBus}, .factor = 1.0 / per_unit}},
         .files = files});
  }
  return found;
}

Alignment following(const bench::Bench& bench, const bench::BenchRun& run, double longest_s) {
  const bench::Recording& r = run.recording;
  std::vector<double> reading = r.q_rad;
  for (std::size_t k = 0; k < reading.size(); ++k) {
    if (!r.valid[k] || (!r.enabled.empty() && !r.enabled[k])) reading[k] = kNothing;
  }
  return align(r.q_cmd_rad, reading, 1.0 / bench.sample_rate_hz, longest_s, longest_s);
}

Alignment speed_of_readings(const bench::Bench& bench, const bench::BenchRun& run, double longest_s) {
  if (run.recording.dq_rad_s.empty()) return {};
  return align(derivative_of_readings(bench, run), run.recording.dq_rad_s, 1.0 / bench.sample_rate_hz, longest_s,
               longest_s);
}

std::vector<DataFault> speed_command_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                            const DataFaultOptions& o) {
  std::vector<DataFault> found;
  const auto derivative = [&](std::size_t run) { return derivative_of_commands(runs[run].recording); };
  check(bench, runs,
        {bench::Column::kSpeedCommand, "the derivative of the position command", derivative, speed_units(bench), 0.0,
         o.strange_factor},
        o, found);
  return found;
}

std::vector<DataFault> derived_column_faults(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                             const DataFaultOptions& o, double model_delay_s) {
  std::vector<DataFault> found = speed_command_faults(bench, runs, o);
  const auto derivative = [&](std::size_t run) { return derivative_of_readings(bench, runs[run]); };
  check(bench, runs,
        {bench::Column::kSpeed, "the derivative of the readings", derivative, speed_units(bench), o.sensor_lag_s,
         o.strange_factor},
        o, found);
  if (bench.law == bench::DriveLaw::kTorque) return found;
  const bool torque = bench.law == bench::DriveLaw::kPositionPd;
  const bench::Column column = torque ? bench::Column::kTorque : bench::Column::kDriveVoltage;
  std::vector<LawOutput> laws;
  laws.reserve(runs.size());
  for (const bench::BenchRun& run : runs) laws.emplace_back(bench, run);
  const double delay_s = delay_of_commands_s(bench, runs, column, laws, model_delay_s, o);
  const auto law = [&](std::size_t run) { return laws[run].after(delay_s); };
  check(bench, runs,
        {column, "the output of the drive's law", law, {{"thousandths", 1000.0}}, o.longest_delay_s, o.law_factor}, o,
        found);
  return found;
}

}  // namespace pmg::data_faults
