#include "data_faults/position_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data_faults/column_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

using bench::Column;

constexpr double kFullTurn_rad = 6.283185307179586;

double deviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value, squares += value * value;
  const auto n = static_cast<double>(values.size());
  return std::sqrt(std::max(1e-30, squares / n - sum * sum / (n * n)));
}

/// Mean over few runs of ln(error / deviation of the readings): does not depend on the readings' unit.
double relative_loss(const Examined& examined, const std::vector<bench::BenchRun>& runs) {
  const std::vector<calib::SingleJoint> few = examined.few_of(runs);
  const QuickFit fit = examined.model().fit(few);
  double loss = 0.0;
  for (std::size_t i = 0; i < few.size(); ++i) {
    loss += fit.log_error[i] - std::log(deviation(few[i].run().recording.q_rad));
  }
  return loss / static_cast<double>(few.size());
}

struct Candidate {
  std::vector<Column> columns;
  double factor = 1.0;
  std::string unit;
};

DataFault fault_of(const Examined& e, const Candidate& candidate, const std::string& measured, double gain) {
  DataFault fault{.kind = candidate.unit.empty() ? Kind::kSign : Kind::kUnit, .where = {}, .correction = {}};
  std::string columns;
  for (const Column column : candidate.columns)
    columns += (columns.empty() ? "" : ", ") + bench::column_name(column, e.linear());
  fault.where = place_of(columns, {});
  fault.correction = candidate.unit.empty()
                         ? fmt::format("turn the sign of {}", columns)
                         : fmt::format("{} is in {}: multiply it by {:.6g}", columns, candidate.unit, candidate.factor);
  fault.evidence = {
      measured, fmt::format("the joint's model misses the corrected readings by {:.2g} times what it misses them by "
                            "as they are",
                            std::exp(-gain))};
  fault.fixes = {{.files = {}, .columns = candidate.columns, .factor = candidate.factor}};
  return fault;
}

/// Readings and commands that go opposite ways: which of them is turned. The recorded speed decides; without it the
/// model, if it can tell.
void name_turned(const Examined& e, DataFault& fault, std::vector<Candidate>& candidates) {
  std::vector<double> signs;
  for (const std::size_t i : e.few()) {
    const Alignment speed = speed_of_readings(e.bench(), e.runs()[i], e.options().longest_shift_s);
    if (speed.known && std::abs(speed.correlation) >= e.options().sure_correlation) signs.push_back(speed.factor);
  }
  const std::string q = bench::column_name(Column::kPosition, e.linear());
  const std::string command = bench::column_name(Column::kPositionCommand, e.linear());
  if (!signs.empty()) {
    const bool readings = fitting::median(signs) < 0.0;
    fault.where = place_of(readings ? q : command, {});
    fault.evidence.push_back(
        fmt::format("the recorded speed {} the readings", readings ? "contradicts" : "agrees with"));
    fault.fixes.front().columns = candidates[readings ? 0 : 1].columns;
  } else {
    constexpr double kTold = 0.05;  // of ln of the error
    const double turned_q = relative_loss(e, e.with({{.columns = {Column::kPosition}, .factor = -1.0}}));
    const double turned_command = relative_loss(e, e.with({{.columns = {Column::kPositionCommand}, .factor = -1.0}}));
    const bool readings = turned_q <= turned_command;
    fault.fixes.front().columns = candidates[readings ? 0 : 1].columns;
    fault.where = place_of(readings ? q : command, {});
    if (std::abs(turned_q - turned_command) < kTold) {
      fault.evidence.push_back(
          fmt::format("nothing else in the recordings tells {} from {}: the joint is the same "
                      "either way",
                      q, command));
      fault.where += fmt::format(" (or {})", readings ? command : q);
    }
  }
  fault.correction =
      fmt::format("turn the sign of {}", bench::column_name(fault.fixes.front().columns.front(), e.linear()));
}

}  // namespace

Follows follows(const Examined& e, const bench::BenchRun& run) {
  const Alignment by = following(e.bench(), run, e.options().longest_shift_s);
  Follows found{.unit = {}};
  found.slope = by.factor;
  found.correlation = by.correlation;
  found.known = by.known && std::abs(by.correlation) >= e.options().follows_correlation;
  if (!found.known) return found;
  found.turned = by.factor < 0.0;
  for (const WrongUnit& unit : position_units(e.linear())) {
    for (const bool readings : {true, false}) {
      const double expected = readings ? unit.per_unit : 1.0 / unit.per_unit;
      if (std::abs(std::log(std::abs(by.factor) / expected)) > std::log(e.options().slope_tolerance)) continue;
      found.unit = unit.name;
      found.column = readings ? Column::kPosition : Column::kPositionCommand;
      found.per_unit = unit.per_unit;
      return found;
    }
  }
  return found;
}

std::vector<DataFault> position_faults(const Examined& e) {
  std::vector<Follows> known;
  std::vector<double> slopes, ranges;
  for (const bench::BenchRun& run : e.runs()) {
    const Follows one = follows(e, run);
    const auto [low, high] = std::minmax_element(run.recording.q_cmd_rad.begin(), run.recording.q_cmd_rad.end());
    ranges.push_back(*high - *low);
    if (!one.known) continue;
    known.push_back(one);
    slopes.push_back(one.slope);
  }
  if (known.empty()) return {};
  const auto share = [&](const auto& holds) {
    return static_cast<double>(std::count_if(known.begin(), known.end(), holds)) / static_cast<double>(known.size());
  };
  const double enough = e.options().same_kind_share;
  std::vector<Candidate> candidates;
  const Follows& middle = *std::min_element(known.begin(), known.end(), [&](const Follows& a, const Follows& b) {
    const double median = fitting::median(slopes);
    return std::abs(a.slope - median) < std::abs(b.slope - median);
  });
  const bool turned = share([](const Follows& f) { return f.turned; }) >= enough;
  const bool unit = !middle.unit.empty() && share([&](const Follows& f) {
                                              return f.unit == middle.unit && f.column == middle.column;
                                            }) >= enough;
  const double sign = turned ? -1.0 : 1.0;
  if (unit) {
    candidates.push_back({{middle.column}, sign / middle.per_unit, middle.unit});
  } else if (turned) {
    candidates.push_back({{Column::kPosition}, -1.0, ""});
    candidates.push_back({{Column::kPositionCommand}, -1.0, ""});
  } else if (fitting::median(ranges) > kFullTurn_rad && !e.linear()) {
    candidates.push_back({{Column::kPosition, Column::kPositionCommand}, std::numbers::pi / 180.0, "degrees"});
  }
  if (candidates.empty()) return {};
  const Candidate& first = candidates.front();
  const bench::Correction fix{.files = {}, .columns = first.columns, .factor = first.factor};
  const double gain = relative_loss(e, e.runs()) - relative_loss(e, e.with({fix}));
  if (gain < std::log(e.options().column_gain)) return {};
  const std::string measured = fmt::format("{} moves {:.3g} times as far as {} (median of {} runs)",
                                           bench::column_name(Column::kPosition, e.linear()), fitting::median(slopes),
                                           bench::column_name(Column::kPositionCommand, e.linear()), slopes.size());
  DataFault fault = fault_of(e, first, measured, gain);
  if (candidates.size() > 1) name_turned(e, fault, candidates);
  return {fault};
}

}  // namespace pmg::data_faults
