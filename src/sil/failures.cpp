#include "sil/failures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "files/config_reader.hpp"

namespace pmg::sil {

namespace {

constexpr double kLatest_s = 86'400.0;
constexpr std::size_t kMost = 100;

/// What a kind needs beside its times.
struct KindRow {
  const char* name = "";
  bool joint = false;
  bool value = false;
  double least = 0.0, most = 0.0;  ///< of the value
};

constexpr std::array<KindRow, 22> kKinds = {{
    {"encoder_stuck", true, false},
    {"encoder_offset", true, true, -10.0, 10.0},
    {"encoder_lost", true, false},
    {"speed_reading", true, true, -1e3, 1e3},
    {"torque_reading", true, true, -1e4, 1e4},
    {"hot", true, true, -50.0, 500.0},
    {"motor_silent", true, false},
    {"imu_lost", false, false},
    {"imu_frozen", false, false},
    {"imu_drift", false, true, -10.0, 10.0},
    {"packet_loss", false, true, 0.0, 100.0},
    {"delay", false, true, 0.0, 1.0},
    {"bus_lost", false, false},
    {"stall", false, false},
    {"stall_bus", false, false},
    {"stall_control", false, false},
    {"policy_late", false, false},
    {"policy_not_finite", false, false},
    {"policy_far", true, true, -std::numbers::pi, std::numbers::pi},
    {"overrun", false, true, 0.0, 0.1},
    {"reference_not_finite", false, false},
    {"command_not_finite", false, false},
}};

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const KindRow& row : kKinds) names.emplace_back(row.name);
  return names;
}

Failure read_failure(files::ConfigReader& entry, const model::RobotModel& robot) {
  Failure failure;
  const std::vector<std::string> names = kind_names();
  const std::string name = entry.one_of("kind", names);
  const auto index = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  const KindRow& row = kKinds[index];
  failure.kind = static_cast<FailureKind>(index);
  failure.at_s = entry.required<double>("at_s", files::in_range(0.0, kLatest_s));
  failure.for_s = entry.required<double>("for_s", files::in_range(0.0, kLatest_s));
  if (row.joint) failure.joint = robot.joint_index.at(entry.one_of("joint", robot.joint_index.names()));
  if (row.value) failure.value = entry.required<double>("value", files::in_range(row.least, row.most));
  entry.finish();
  return failure;
}

}  // namespace

const char* to_string(FailureKind kind) noexcept { return kKinds[static_cast<std::size_t>(kind)].name; }

std::vector<Failure> load_failures(const std::filesystem::path& file, const model::RobotModel& robot) {
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  std::vector<Failure> failures;
  for (files::ConfigReader& entry : reader.maps("failures")) failures.push_back(read_failure(entry, robot));
  if (failures.empty() || failures.size() > kMost) {
    reader.fail("failures", "has " + std::to_string(failures.size()), "1 to " + std::to_string(kMost));
  }
  reader.finish();
  std::ranges::stable_sort(failures, {}, &Failure::at_s);
  return failures;
}

}  // namespace pmg::sil
