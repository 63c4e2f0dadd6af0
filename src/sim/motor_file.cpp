#include "sim/motor_file.hpp"

#include <fmt/format.h>

#include "files/config_reader.hpp"
#include "files/nearest_name.hpp"
#include "model/constants.hpp"
#include "model/residual_torque_file.hpp"
#include "sim/actuator_model.hpp"

namespace pmg::sim {

namespace {

/// Reads the groups in the table's order, in which the keys of a group are neighbours.
model::ActuatorParameters read_actuator(files::ConfigReader& joint) {
  model::ActuatorParameters parameters;
  const auto table = model::actuator_parameters();
  for (std::size_t i = 0; i < table.size();) {
    const std::string group(table[i].group());
    const bool there = joint.has(group);
    std::optional<files::ConfigReader> reader;
    if (there) reader = joint.map(group);
    for (; i < table.size() && table[i].group() == group; ++i) {
      const model::ActuatorParameter& p = table[i];
      if (!reader || !reader->has(std::string(p.key()))) {
        if (reader) reader->optional<double>(std::string(p.key()), 0.0);
        continue;
      }
      p.in(parameters) = reader->required<double>(std::string(p.key()),
                                                  p.may_be_negative() ? files::any_number() : files::non_negative());
    }
    if (reader)
      reader->finish();
    else
      joint.optional<std::string>(group, "");
  }
  parameters.residual_torque = model::read_residual_torque(joint);
  joint.finish();
  return parameters;
}

}  // namespace

ActuatorsByJoint read_motor_file(const std::filesystem::path& file) {
  if (std::filesystem::exists(file / "motor.yaml"))
    throw files::ConfigError(
        fmt::format("{}: is a folder; did you mean {}?", file.string(), (file / "motor.yaml").string()));
  files::ConfigReader reader = files::ConfigReader::from_file(file);
  constexpr const char* kExpected = "a motor.yaml, as pmg_calibrate_motor and pmg_diagnose write it";
  if (reader.has("urdf")) reader.fail("urdf", "is of a robot", kExpected);
  if (!reader.has("joints")) reader.fail("joints", "is missing", kExpected);
  ActuatorsByJoint actuators;
  files::ConfigReader joints = reader.map("joints");
  for (const std::string& name : joints.keys()) {
    files::ConfigReader joint = joints.map(name);
    const model::ActuatorParameters parameters = read_actuator(joint);
    try {
      ActuatorModel(parameters, model::kBusPeriod_s);
    } catch (const std::invalid_argument& error) {
      joints.fail(name, error.what(), "an actuator that can be simulated");
    }
    actuators.emplace(name, parameters);
  }
  reader.finish();
  return actuators;
}

ActuatorsByJoint read_motor_file(const std::filesystem::path& file, const model::JointIndex& joints) {
  const ActuatorsByJoint actuators = read_motor_file(file);
  for (const auto& [name, parameters] : actuators) {
    if (joints.find(name)) continue;
    files::ConfigReader reader = files::ConfigReader::from_file(file);
    const std::string nearest = files::nearest_name(name, joints.names());
    reader.map("joints").fail(
        name, "isn't a joint of this robot" + (nearest.empty() ? "" : "; did you mean " + nearest + "?"),
        nearest.empty() ? "names of robot.yaml's `joints`" : "");
  }
  return actuators;
}

std::string motor_yaml(const ActuatorsByJoint& actuators, const std::vector<std::string>& remarks) {
  std::string text;
  for (const std::string& remark : remarks) text += fmt::format("# {}\n", remark);
  text += "joints:\n";
  model::ActuatorParameters neutral;
  for (const auto& [name, parameters] : actuators) {
    text += fmt::format("  {}:{}\n", name, parameters == neutral ? " {}" : "");
    std::string_view group;
    for (const model::ActuatorParameter& p : model::actuator_parameters()) {
      if (p.value(parameters) == p.value(neutral)) continue;
      if (p.group() != group) text += fmt::format("    {}:\n", p.group());
      group = p.group();
      text += fmt::format("      {}: {}\n", p.key(), p.value(parameters));
    }
    text += model::residual_torque_yaml(parameters.residual_torque);
  }
  return text;
}

}  // namespace pmg::sim
