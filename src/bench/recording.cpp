#include "bench/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "bench/csv_table.hpp"
#include "fitting/statistics.hpp"

namespace pmg::bench {

namespace {

constexpr std::size_t kFewestSamples = 50;
constexpr std::size_t kSamplesPerDropout = 20;  // a sensor that drops out more often is refused
constexpr double kLongestGap_samples = 5.0;
constexpr double kLargestAngle_rad =
    100.0;  // sixteen turns, more than any bench needs; in degrees a bit more than a quarter turn
constexpr double kLargestPosition_m = 20.0;  // longer than any bench's axis; in millimetres only 20 mm
constexpr double kSmallestUnit = 1000.0;     // thousandths: the smallest unit that somebody takes for radians or metres

double largest_position(bool linear) { return linear ? kLargestPosition_m : kLargestAngle_rad; }

void check_times(const CsvTable& table, const std::vector<double>& t_s, double sample_rate_hz) {
  const double step_s = 1.0 / sample_rate_hz;
  std::vector<double> steps_s;
  for (std::size_t k = 1; k < t_s.size(); ++k) {
    steps_s.push_back(t_s[k] - t_s[k - 1]);
    if (steps_s.back() == 0.0)
      files::raise(table.place(k), "t_s", fmt::format("{} is there twice", t_s[k]), "times that increase");
    if (steps_s.back() < 0.0) {
      files::raise(table.place(k), "t_s", fmt::format("{} after {}", t_s[k], t_s[k - 1]), "times that increase");
    }
  }
  const double usual_s = fitting::median(steps_s);
  if (usual_s > 2.0 * step_s || usual_s < 0.5 * step_s) {
    files::raise({table.file.string()}, "t_s", fmt::format("steps of {:.4g}", usual_s),
                 fmt::format("seconds, {:.4g} apart as sample_rate_hz of bench.yaml says", step_s));
  }
  for (std::size_t k = 1; k < t_s.size(); ++k) {
    if (steps_s[k - 1] <= kLongestGap_samples * step_s) continue;
    files::raise(table.place(k), "t_s", fmt::format("a gap of {:.4g} s", steps_s[k - 1]),
                 fmt::format("at most {:.4g} s between samples", kLongestGap_samples * step_s));
  }
}

void check_positions(const CsvTable& table, const std::string& column, const std::vector<double>& values,
                     const RecordingFormat& format) {
  const bool linear = format.linear;
  const double most = largest_position(linear) * (format.other_units ? kSmallestUnit : 1.0);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::abs(values[k]) <= most) continue;
    files::raise(table.place(k), column, fmt::format("is {}", values[k]),
                 fmt::format("{} within +-{}; is it in {}?", linear ? "metres" : "radians", most,
                             linear ? "millimetres" : "degrees"));
  }
}

/// From which distance to both neighbours on a reading may be a dropout: twenty usual steps. Of a coarse sensor most
/// steps are none and the others at least a quantum; then five of these are enough.
double far_rad(const std::vector<double>& q_rad) {
  std::vector<double> steps_rad;
  for (std::size_t k = 1; k < q_rad.size(); ++k) steps_rad.push_back(std::abs(q_rad[k] - q_rad[k - 1]));
  std::ranges::sort(steps_rad);
  const auto moves = std::ranges::upper_bound(steps_rad, 0.0);
  if (moves == steps_rad.end()) return std::numeric_limits<double>::infinity();
  const double move_rad = fitting::median({moves, steps_rad.end()});
  steps_rad.resize(steps_rad.size() * 19 / 20);  // dropouts themselves are among the largest
  const double step_rad =
      std::accumulate(steps_rad.begin(), steps_rad.end(), 0.0) / static_cast<double>(steps_rad.size());
  return std::clamp(20.0 * step_rad, 5.0 * move_rad, 20.0 * move_rad);
}

/// A dropout: one reading that is far from both neighbours and differs from them by more than five times their
/// difference. No joint moves there and back within two samples.
std::vector<bool> find_valid(const std::vector<double>& q_rad) {
  std::vector<bool> valid(q_rad.size(), true);
  const double far = far_rad(q_rad);
  for (std::size_t k = 0; k < q_rad.size(); ++k) {
    const double before_rad = q_rad[k == 0 ? 1 : k - 1], after_rad = q_rad[k + 1 == q_rad.size() ? k - 1 : k + 1];
    const double there_rad = q_rad[k] - before_rad, back_rad = q_rad[k] - after_rad;
    const double nearest_rad = std::min(std::abs(there_rad), std::abs(back_rad));
    valid[k] =
        !(there_rad * back_rad > 0.0 && nearest_rad > far && nearest_rad > 5.0 * std::abs(after_rad - before_rad));
  }
  return valid;
}

/// Single readings of the bus voltage may fail (zero, or twice the value). The run's median replaces them.
void mend_bus(std::vector<double>& bus_V) {
  if (bus_V.empty()) return;
  const double usual_V = fitting::median(bus_V);
  for (double& value : bus_V) {
    if (value < 0.7 * usual_V || value > 1.3 * usual_V) value = usual_V;
  }
}

}  // namespace

std::size_t Recording::dropouts() const {
  return static_cast<std::size_t>(std::count(valid.begin(), valid.end(), false));
}

bool plausible_positions(const Recording& recording, bool linear) {
  const auto plausible = [&](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [&](double v) { return std::abs(v) <= largest_position(linear); });
  };
  return plausible(recording.q_cmd_rad) && plausible(recording.q_rad);
}

Recording read_recording(const std::filesystem::path& file, const RecordingFormat& format) {
  const CsvTable table = read_csv(file);
  const std::string unit = format.linear ? "_m" : "_rad", rate = unit + "_s";
  const std::string force = format.linear ? "_N" : "_Nm";
  const auto column = [&](const std::string& quantity) {  // the error of a missing column names the unit that is there
    const std::string name = quantity + unit;
    if (table.find(name)) return table.numbers(name);
    for (const std::string& other : table.header) {
      if (other.starts_with(quantity + "_") && !other.ends_with("_raw")) {
        files::raise({file.string(), table.header_line}, other, "is in another unit", name);
      }
    }
    return table.numbers(name);
  };
  const auto if_there = [&](const std::string& name) {
    return table.find(name) ? table.numbers(name) : std::vector<double>{};
  };
  Recording recording;
  recording.file = file;
  recording.t_s = table.numbers("t_s");
  recording.q_cmd_rad = column("q_cmd");
  recording.q_rad = column("q");
  recording.dq_cmd_rad_s = if_there("dq_cmd" + rate);
  recording.dq_rad_s = if_there("dq" + rate);
  recording.tau_ff_Nm = if_there("tau_ff" + force);
  recording.torque_Nm = if_there("torque" + force);
  recording.bus_V = if_there("bus_V");
  recording.drive_V = if_there("drive_V");
  recording.temp_C = if_there("temp_C");
  for (const double on : if_there("enabled")) recording.enabled.push_back(on != 0.0);

  if (table.rows.size() < kFewestSamples) {
    files::raise({file.string()}, "", fmt::format("{} samples", table.rows.size()),
                 fmt::format("at least {}", kFewestSamples));
  }
  check_times(table, recording.t_s, format.sample_rate_hz);
  check_positions(table, "q_cmd" + unit, recording.q_cmd_rad, format);
  check_positions(table, "q" + unit, recording.q_rad, format);
  const auto constant = [](const std::vector<double>& values) {
    return values.empty() || std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); });
  };
  if (format.commanded && constant(recording.q_cmd_rad) && constant(recording.tau_ff_Nm)) {
    files::raise({file.string()}, "q_cmd" + unit, "never changes", "a command that excites the joint");
  }
  if (!format.commanded && constant(recording.torque_Nm)) {
    files::raise({file.string()}, "torque" + force, "is missing or never changes", "the torque that drove the joint");
  }
  mend_bus(recording.bus_V);
  recording.valid = find_valid(recording.q_rad);
  if (recording.dropouts() > table.rows.size() / kSamplesPerDropout) {
    files::raise({file.string()}, "q" + unit, fmt::format("the sensor drops out in {} samples", recording.dropouts()),
                 fmt::format("at most one in {}", kSamplesPerDropout));
  }
  return recording;
}

}  // namespace pmg::bench
