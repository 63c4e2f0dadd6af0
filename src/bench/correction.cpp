#include "bench/correction.hpp"

#include <algorithm>
#include <cmath>

#include "bench/bench.hpp"

namespace pmg::bench {

namespace {

constexpr double kRounding_s = 1e-9;

/// Keeps the samples from first to last of every column.
void cut(Recording& r, std::size_t first, std::size_t last) {
  const auto keep = [&](auto& column) {
    if (column.empty()) return;
    column.erase(column.begin() + static_cast<std::ptrdiff_t>(last + 1), column.end());
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(first));
  };
  keep(r.t_s);
  for (const Column column : {Column::kPositionCommand, Column::kPosition, Column::kSpeedCommand, Column::kSpeed,
                              Column::kFeedForward, Column::kTorque, Column::kDriveVoltage, Column::kBus}) {
    keep(values(r, column));
  }
  keep(r.temp_C);
  keep(r.enabled);
  keep(r.valid);
}

void shift(Recording& r, const std::vector<Column>& columns, double shift_s) {
  for (const Column column : columns) {
    std::vector<double>& of = values(r, column);
    if (of.empty()) continue;
    of = shifted(r.t_s, of, shift_s);
  }
  const bool position = std::find(columns.begin(), columns.end(), Column::kPosition) != columns.end();
  if (position && !r.valid.empty()) {  // a dropout moves with its reading, and spreads over the samples beside it
    const std::vector<bool> before = r.valid;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const auto above = std::upper_bound(r.t_s.begin(), r.t_s.end(), r.t_s[k] + shift_s) - r.t_s.begin();
      const auto last = static_cast<std::ptrdiff_t>(before.size()) - 1;
      const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above, 0, last));
      r.valid[k] = before[i] && before[i == 0 ? 0 : i - 1];
    }
  }
  std::size_t first = 0, last = r.t_s.size() - 1;
  while (first < last && r.t_s[first] + shift_s < r.t_s.front() - kRounding_s) ++first;
  while (last > first && r.t_s[last] + shift_s > r.t_s.back() + kRounding_s) --last;
  cut(r, first, last);
}

void leave_out(Recording& r, const std::vector<std::size_t>& samples) {
  for (const std::size_t k : samples) r.valid.at(k) = false;
  for (const std::size_t k : samples) {
    std::size_t before = k, after = k;
    while (before > 0 && !r.valid[before]) --before;
    while (after + 1 < r.valid.size() && !r.valid[after]) ++after;
    if (!r.valid[before] || !r.valid[after]) continue;  // at an end there is nothing on the other side
    const double share = (r.t_s[k] - r.t_s[before]) / (r.t_s[after] - r.t_s[before]);
    r.q_rad[k] = r.q_rad[before] + share * (r.q_rad[after] - r.q_rad[before]);
  }
}

}  // namespace

std::vector<double> shifted(const std::vector<double>& t_s, const std::vector<double>& values, double shift_s) {
  std::vector<double> found;
  found.reserve(values.size());
  for (const double now_s : t_s) {
    const double wanted_s = now_s + shift_s;
    const auto above = std::upper_bound(t_s.begin(), t_s.end(), wanted_s);
    if (above == t_s.begin() || above == t_s.end()) {
      found.push_back(above == t_s.begin() ? values.front() : values.back());
      continue;
    }
    const auto k = static_cast<std::size_t>(above - t_s.begin());
    const double share = (wanted_s - t_s[k - 1]) / (t_s[k] - t_s[k - 1]);
    found.push_back(values[k - 1] + share * (values[k] - values[k - 1]));
  }
  return found;
}

std::string column_name(Column column, bool linear) {
  const std::string position = linear ? "_m" : "_rad", torque = linear ? "_N" : "_Nm";
  switch (column) {
    case Column::kPositionCommand:
      return "q_cmd" + position;
    case Column::kPosition:
      return "q" + position;
    case Column::kSpeedCommand:
      return "dq_cmd" + position + "_s";
    case Column::kSpeed:
      return "dq" + position + "_s";
    case Column::kFeedForward:
      return "tau_ff" + torque;
    case Column::kTorque:
      return "torque" + torque;
    case Column::kDriveVoltage:
      return "drive_V";
    case Column::kBus:
      break;
  }
  return "bus_V";
}

std::vector<double>& values(Recording& r, Column column) {
  switch (column) {
    case Column::kPositionCommand:
      return r.q_cmd_rad;
    case Column::kPosition:
      return r.q_rad;
    case Column::kSpeedCommand:
      return r.dq_cmd_rad_s;
    case Column::kSpeed:
      return r.dq_rad_s;
    case Column::kFeedForward:
      return r.tau_ff_Nm;
    case Column::kTorque:
      return r.torque_Nm;
    case Column::kDriveVoltage:
      return r.drive_V;
    case Column::kBus:
      break;
  }
  return r.bus_V;
}

const std::vector<double>& values(const Recording& recording, Column column) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): one function reads and writes; here it reads
  return values(const_cast<Recording&>(recording), column);
}

void correct(BenchRun& run, const Correction& correction) {
  const auto named = std::find(correction.files.begin(), correction.files.end(), run.file);
  if (!correction.files.empty() && named == correction.files.end()) return;
  for (const Column column : correction.columns) {
    for (double& value : values(run.recording, column)) value *= correction.factor;
  }
  if (correction.shift_s != 0.0) shift(run.recording, correction.columns, correction.shift_s);
  run.kp *= correction.kp_factor;
  run.kd *= correction.kd_factor;
  run.load.inertia_kg_m2 *= correction.load_factor;
  run.load.gravity_Nm *= correction.load_factor;
  leave_out(run.recording, correction.unknown_readings);
  if (!correction.conditions) return;
  const RowConditions& c = *correction.conditions;
  run.trajectory = c.trajectory;
  run.repeat = c.repeat;
  run.kp = c.kp;
  run.kd = c.kd;
  run.load = c.load;
}

Bench corrected(const Bench& bench, const std::vector<Correction>& corrections,
                const std::vector<std::string>& left_out) {
  Bench found = bench;
  found.corrections.insert(found.corrections.end(), corrections.begin(), corrections.end());
  found.left_out.insert(found.left_out.end(), left_out.begin(), left_out.end());
  return found;
}

}  // namespace pmg::bench
