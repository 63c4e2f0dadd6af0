#include "policy/policy_descriptor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <utility>

#include "files/bounded_file.hpp"
#include "files/config_reader.hpp"
#include "files/nearest_name.hpp"

namespace pmg::policy {

namespace {

constexpr int kFormat = 1;
constexpr int kLongestHistory = 64;
constexpr double kRateRounding = 1e-6;
constexpr double kLargestGoldenTolerance = 0.01;  // for actions of order one; with more the pairs would prove nothing

const std::map<std::string, Signal>& signals() {
  static const std::map<std::string, Signal> names = {{"gyro", Signal::kGyro},
                                                      {"gravity_direction", Signal::kGravityDirection},
                                                      {"command", Signal::kCommand},
                                                      {"command_linear", Signal::kCommandLinear},
                                                      {"command_angular", Signal::kCommandAngular},
                                                      {"joint_position", Signal::kJointPosition},
                                                      {"joint_velocity", Signal::kJointVelocity},
                                                      {"last_action", Signal::kLastAction},
                                                      {"clock_sin", Signal::kClockSin},
                                                      {"clock_cos", Signal::kClockCos}};
  return names;
}

bool tells_time(Signal signal) { return signal == Signal::kClockSin || signal == Signal::kClockCos; }

int size_of(const SignalTerm& term, int joints) {
  switch (term.signal) {
    case Signal::kGyro:
    case Signal::kGravityDirection:
    case Signal::kCommand:
      return 3;
    case Signal::kJointPosition:
    case Signal::kJointVelocity:
    case Signal::kLastAction:
      return joints;
    case Signal::kCommandLinear:
      return 2;
    case Signal::kCommandAngular:
      return 1;
    case Signal::kClockSin:
    case Signal::kClockCos:
      return static_cast<int>(term.clock.offsets_cycle.size());
  }
  return 0;
}

/// The policy's joints by name, each once, of the robot and given to policies.
std::vector<int> read_joints(files::ConfigReader& reader, const model::RobotModel& robot) {
  std::vector<int> joints;
  for (const auto& name : reader.required<std::vector<std::string>>("joints")) {
    const std::optional<int> joint = robot.joint_index.find(name);
    if (!joint) {
      const std::string meant = files::nearest_name(name, robot.joint_index.names());
      reader.fail("joints", fmt::format("'{}' is no joint of {}", name, robot.name),
                  meant.empty() ? "names of robot.yaml's joints" : fmt::format("one of robot.yaml's, as {}", meant));
    }
    if (!robot.joints[static_cast<std::size_t>(*joint)].policy) {
      reader.fail("joints", fmt::format("'{}' is given to no policy", name), "joints of robot.yaml's policy_joints");
    }
    if (std::ranges::find(joints, *joint) != joints.end()) {
      reader.fail("joints", fmt::format("'{}' stands twice", name), "each joint once");
    }
    joints.push_back(*joint);
  }
  if (joints.empty()) reader.fail("joints", "is empty", "the joints in the network's order");
  return joints;
}

void read_posture(files::ConfigReader& reader, const model::RobotModel& robot, PolicyDescriptor& descriptor) {
  descriptor.default_rad = reader.numbers("default_rad", descriptor.joints.size());
  for (std::size_t i = 0; i < descriptor.joints.size(); ++i) {
    const model::Joint& joint = robot.joints[static_cast<std::size_t>(descriptor.joints[i])];
    const double value = descriptor.default_rad[i];
    if (value < joint.lower_rad || value > joint.upper_rad) {
      reader.fail("default_rad", fmt::format("has {} at {} rad", joint.name, value),
                  fmt::format("{} to {}, the joint's limits", joint.lower_rad, joint.upper_rad));
    }
  }
}

void read_gains(files::ConfigReader& reader, const model::RobotModel& robot, PolicyDescriptor& descriptor) {
  const auto n = static_cast<Eigen::Index>(robot.joints.size());
  descriptor.gains = {JointVector(n), JointVector(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    descriptor.gains.kp_Nm_per_rad[i] = robot.joints[static_cast<std::size_t>(i)].kp_Nm_per_rad;
    descriptor.gains.kd_Nm_s_per_rad[i] = robot.joints[static_cast<std::size_t>(i)].kd_Nm_s_per_rad;
  }
  const auto kp = reader.numbers("kp_Nm_per_rad", descriptor.joints.size(), files::positive());
  const auto kd = reader.numbers("kd_Nm_s_per_rad", descriptor.joints.size(), files::positive());
  for (std::size_t i = 0; i < descriptor.joints.size(); ++i) {
    descriptor.gains.kp_Nm_per_rad[descriptor.joints[i]] = kp[i];
    descriptor.gains.kd_Nm_s_per_rad[descriptor.joints[i]] = kd[i];
  }
}

void read_action(files::ConfigReader& reader, PolicyDescriptor& descriptor) {
  descriptor.action_scale_rad = reader.numbers("action_scale_rad", descriptor.joints.size(), files::positive());
  if (reader.has("action_limit")) descriptor.action_limit = reader.required<double>("action_limit", files::positive());
  if (!reader.has("action_bound_rad")) return;
  descriptor.action_bound_rad = reader.required<double>(
      "action_bound_rad",
      {"more than 0 and at most half a turn", [](double value) { return value > 0.0 && value <= std::numbers::pi; }});
}

void read_command(files::ConfigReader reader, VelocityRange& range) {
  for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
    const std::string key = kChannelNames[channel];
    const std::vector<double> ends = reader.numbers(key, 2);
    if (ends[0] > 0.0 || ends[1] < 0.0) {
      reader.fail(key, fmt::format("is [{}, {}]", ends[0], ends[1]), "a range with 0 in it");
    }
    range.lower[channel] = ends[0];
    range.upper[channel] = ends[1];
  }
  reader.finish();
}

Signal read_signal(files::ConfigReader& reader) {
  const auto name = reader.required<std::string>("term");
  const auto found = signals().find(name);
  if (found != signals().end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [known_name, signal] : signals()) known.push_back(known_name);
  reader.fail("term", fmt::format("'{}' isn't measured by this controller", name),
              fmt::format("one of {}", fmt::join(known, ", ")));
}

StepClock read_clock(files::ConfigReader& reader) {
  StepClock clock;
  clock.period_s = reader.required<double>("period_s", files::positive());
  clock.offsets_cycle = reader.required<std::vector<double>>("offsets_cycle", files::in_range(0.0, 1.0));
  if (clock.offsets_cycle.empty()) reader.fail("offsets_cycle", "is empty", "one a foot, or one");
  if (reader.has("at_rest_cycle")) {
    clock.at_rest_cycle = reader.required<double>("at_rest_cycle", files::in_range(0.0, 1.0));
  }
  return clock;
}

SignalTerm read_term(files::ConfigReader reader, int joints) {
  SignalTerm term;
  term.signal = read_signal(reader);
  if (tells_time(term.signal)) term.clock = read_clock(reader);
  term.size = size_of(term, joints);
  term.scale = reader.required<std::vector<double>>("scale");
  if (term.scale.size() == 1) term.scale.resize(static_cast<std::size_t>(term.size), term.scale.front());
  if (term.scale.size() != static_cast<std::size_t>(term.size)) {
    reader.fail("scale", fmt::format("has {} numbers", term.scale.size()), fmt::format("1 or {}", term.size));
  }
  term.clip = reader.optional<double>("clip", term.clip, files::positive());
  term.history = reader.optional<int>("history", 1, files::in_range(1, kLongestHistory));
  reader.finish();
  return term;
}

void read_observation(files::ConfigReader& reader, PolicyDescriptor& descriptor) {
  const auto joints = static_cast<int>(descriptor.joints.size());
  for (files::ConfigReader& term : reader.maps("observation")) {
    descriptor.observation.push_back(read_term(std::move(term), joints));
    descriptor.observation_size += descriptor.observation.back().size * descriptor.observation.back().history;
  }
  if (descriptor.observation.empty()) reader.fail("observation", "is empty", "the terms in the network's order");
  descriptor.order.by_term = reader.one_of("frames", {"by_term", "by_frame"}) == "by_term";
  descriptor.order.oldest_first = reader.one_of("first_frame", {"oldest", "newest"}) == "oldest";
  const auto other_history = [&](const SignalTerm& term) {
    return term.history != descriptor.observation.front().history;
  };
  if (!descriptor.order.by_term && std::ranges::any_of(descriptor.observation, other_history)) {
    reader.fail("frames", "is by_frame with terms of different history", "the same history of all terms, or by_term");
  }
}

/// The base's rates and gravity are the IMU's, turned: they must not move against each other.
void expect_imu_on_base(const files::ConfigReader& reader, const model::RobotModel& robot) {
  for (urdf::LinkConstSharedPtr link = robot.urdf->getLink(robot.imu.link); link->getParent();
       link = link->getParent()) {
    if (link->parent_joint->type == urdf::Joint::FIXED) continue;
    reader.fail("observation",
                fmt::format("is in the base's frame, and joint {} is between the base and the IMU on {}",
                            link->parent_joint->name, robot.imu.link),
                "a robot whose IMU is fixed to its base");
  }
}

/// A row: the observation's numbers, then the action's, separated by commas; no header.
std::vector<GoldenPair> read_golden(const std::filesystem::path& file, std::size_t seen, std::size_t actions) {
  files::expect_bounded_file(file, files::kLargestTable_bytes, "golden pairs");
  std::vector<GoldenPair> pairs;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::vector<float> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      row.push_back(std::strtof(cell.c_str(), &end));
      if (end == cell.c_str() || *end != '\0' || !std::isfinite(row.back())) row.clear();
      if (row.empty()) break;
    }
    const int number = static_cast<int>(pairs.size()) + 1;
    if (row.size() != seen + actions) {
      files::raise({file.string(), number}, "", "is no golden pair",
                   fmt::format("{} finite numbers of the observation and {} of the action", seen, actions));
    }
    const auto middle = row.begin() + static_cast<std::ptrdiff_t>(seen);
    pairs.push_back({{row.begin(), middle}, {middle, row.end()}});
  }
  if (pairs.empty()) files::raise({file.string()}, "", "is empty", "golden pairs, one a row");
  return pairs;
}

}  // namespace

PolicyDescriptor read_policy_descriptor(const std::filesystem::path& file, const model::RobotModel& robot,
                                        double control_rate_Hz) {
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  PolicyDescriptor descriptor;
  if (const int format = reader.required<int>("format"); format != kFormat) {
    reader.fail("format", fmt::format("is {}", format), fmt::format("{}", kFormat));
  }
  reader.required<std::string>("source");  // for people
  descriptor.network = file.parent_path() / reader.required<std::string>("network");
  descriptor.files.push_back(descriptor.network);
  descriptor.input = reader.required<std::string>("input");
  descriptor.output = reader.required<std::string>("output");
  descriptor.rate_Hz = reader.required<double>("rate_Hz", files::positive());
  const double ticks = control_rate_Hz / descriptor.rate_Hz;
  if (std::round(ticks) < 1.0 || std::abs(ticks - std::round(ticks)) > kRateRounding) {
    reader.fail("rate_Hz", fmt::format("is {}", descriptor.rate_Hz),
                fmt::format("the controller's {} divided by a whole number", control_rate_Hz));
  }
  descriptor.joints = read_joints(reader, robot);
  read_posture(reader, robot, descriptor);
  read_action(reader, descriptor);
  read_gains(reader, robot, descriptor);
  read_command(reader.map("command"), descriptor.command);
  read_observation(reader, descriptor);
  expect_imu_on_base(reader, robot);
  if (reader.has("golden")) {
    descriptor.golden_tolerance =
        reader.required<double>("golden_tolerance", files::in_range(1e-7, kLargestGoldenTolerance));
    descriptor.files.push_back(file.parent_path() / reader.required<std::string>("golden"));
    descriptor.golden = read_golden(descriptor.files.back(), static_cast<std::size_t>(descriptor.observation_size),
                                    descriptor.joints.size());
  }
  reader.finish();
  return descriptor;
}

}  // namespace pmg::policy
