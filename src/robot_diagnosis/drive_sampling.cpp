#include "robot_diagnosis/drive_sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "model/constants.hpp"

namespace pmg::robot_diagnosis {

namespace {

/// Weights of q0, q1, T dq0, T dq1 at both ends of one tick: Hermite's cubic, its integral from 0 to s, and its slope.
using CubicWeights = Eigen::Vector4d;
CubicWeights cubic(double s) {
  const double s2 = s * s, s3 = s2 * s;
  return {2.0 * s3 - 3.0 * s2 + 1.0, 3.0 * s2 - 2.0 * s3, s3 - 2.0 * s2 + s, s3 - s2};
}
CubicWeights cubic_integral(double s) {
  const double s2 = s * s, s3 = s2 * s, s4 = s3 * s;
  return {0.5 * s4 - s3 + s, s3 - 0.5 * s4, 0.25 * s4 - s3 / 1.5 + 0.5 * s2, 0.25 * s4 - s3 / 3.0};
}
CubicWeights cubic_slope(double s) {
  return {6.0 * s * (s - 1.0), 6.0 * s * (1.0 - s), (3.0 * s - 1.0) * (s - 1.0), s * (3.0 * s - 2.0)};
}

/// (weights of a tick's ends, whether it is the first of the two ticks) => (weights of the three states).
PathWeights of_tick(const CubicWeights& w, bool first) {
  PathWeights path;
  if (first) {
    path << w[0], w[1], 0.0, w[2], w[3], 0.0;
  } else {
    path << 0.0, w[0], w[1], 0.0, w[2], w[3];
  }
  return path;
}

PathWeights path_slope(double s) { return of_tick(cubic_slope(s < 0.0 ? 1.0 + s : s), s < 0.0); }

bool among(const std::vector<int>& joints, int joint) { return std::ranges::find(joints, joint) != joints.end(); }

/// A time within a control tick; nullopt: the log doesn't say.
std::optional<double> time_of_log(const nlohmann::json& options, const char* key) {
  if (!options.is_object() || !options.contains(key)) return std::nullopt;
  const nlohmann::json& value = options[key];
  if (!value.is_number() || !(value.get<double>() >= 0.0 && value.get<double>() <= model::kControlPeriod_s))
    throw std::runtime_error(fmt::format("ROBOT_INFO's {} is {}; expected seconds from 0 to {}", key, value.dump(),
                                         model::kControlPeriod_s));
  return value.get<double>();
}

/// The joints in the list; none when the log has no such key.
std::vector<int> joints_of_log(const nlohmann::json& options, const char* key, const model::JointIndex& joints) {
  std::vector<int> found;
  if (!options.is_object() || !options.contains(key)) return found;
  for (const nlohmann::json& name : options[key]) {
    const auto joint = name.is_string() ? joints.find(name.get<std::string>()) : std::nullopt;
    if (!joint) throw std::runtime_error(fmt::format("ROBOT_INFO's {} has {}; expected joints", key, name.dump()));
    found.push_back(*joint);
  }
  return found;
}

}  // namespace

PathWeights path_position(double s) { return of_tick(cubic(s < 0.0 ? 1.0 + s : s), s < 0.0); }

PathWeights path_integral(double s) {
  return s < 0.0 ? of_tick(cubic_integral(1.0 + s) - cubic_integral(1.0), true) : of_tick(cubic_integral(s), false);
}

PathWeights DriveSampling::mean_position(double from, double to, double tick_s) const {
  const double h = step_s / tick_s;
  return (path_integral(to) - path_integral(from) - 0.5 * h * (path_position(to) - path_position(from)) +
          h * h / 12.0 * (path_slope(to) - path_slope(from))) /
         (to - from);
}

std::array<CommandInForce, 2> DriveSampling::in_force(int joint, double tick_s) const {
  const bool by_bus = among(closed_by_bus, joint);
  const DriveSampling at_once;
  const auto part = [&](double from, double to) -> CommandInForce {
    if (to <= from) return {};
    const double age = by_bus ? bus_loop_age_s / tick_s : 0.0;
    return {.share = to - from,
            .position = (by_bus ? at_once : *this).mean_position(from - age, to - age, tick_s),
            .speed = (path_position(to - age) - path_position(from - age)) / (to - from)};
  };
  const double begins = std::min(1.0, (command_delay_s + (among(older_joints, joint) ? older_by_s : 0.0)) / tick_s);
  return {part(0.0, begins), part(begins, 1.0)};
}

DriveSampling drive_sampling(const std::string& backend, const std::string& options, const model::JointIndex& joints) {
  const nlohmann::json json = nlohmann::json::parse(options, nullptr, false);
  const bool simulated = backend == "sil";
  const std::string unknown = fmt::format("the log of backend '{}' doesn't say; ", backend);
  DriveSampling sampling;
  if (const auto step_s = time_of_log(json, "drive_sampling_s")) {
    sampling.step_s = *step_s;
    sampling.known_from = "the log says so";
  } else if (simulated) {
    sampling.step_s = model::kBusPeriod_s;
    sampling.known_from = "the log's backend is sil, whose drives have it";
  } else {
    sampling.known_from = unknown + "much faster than the control tick is assumed";
  }
  if (const auto delay_s = time_of_log(json, "command_delay_s")) {
    sampling.command_delay_s = *delay_s;
    sampling.delay_known_from = "the log says so";
  } else {
    sampling.delay_known_from = simulated ? "the log's backend is sil" : unknown + "none is assumed";
  }
  sampling.older_joints = joints_of_log(json, "older_joints", joints);
  sampling.older_imu = json.is_object() && json.value("older_imu", nlohmann::json(false)) == true;
  sampling.older_by_s = time_of_log(json, "older_by_s").value_or(0.0);
  sampling.closed_by_bus = joints_of_log(json, "closed_by_bus", joints);
  sampling.bus_loop_age_s = time_of_log(json, "bus_loop_age_s").value_or(0.0);
  return sampling;
}

std::string drive_sampling_text(const DriveSampling& sampling) {
  const std::string what = sampling.step_s > 0.0
                               ? fmt::format("drives take positions every {:g} ms", 1e3 * sampling.step_s)
                               : "drives take positions all the time";
  std::string text = fmt::format("{} ({}), and their commands act {:g} ms after the states that they answer ({})", what,
                                 sampling.known_from, 1e3 * sampling.command_delay_s, sampling.delay_known_from);
  if (sampling.older_by_s > 0.0)
    text += fmt::format("; {} joints{} are {:g} ms older than the rest of a state", sampling.older_joints.size(),
                        sampling.older_imu ? " and the IMU" : "", 1e3 * sampling.older_by_s);
  if (!sampling.closed_by_bus.empty())
    text += fmt::format("; the bus thread closes the loops of {} joints, from positions that are {:g} ms old",
                        sampling.closed_by_bus.size(), 1e3 * sampling.bus_loop_age_s);
  return text;
}

}  // namespace pmg::robot_diagnosis
