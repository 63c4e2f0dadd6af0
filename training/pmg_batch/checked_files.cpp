#include "checked_files.hpp"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "files/bounded_file.hpp"
#include "model/residual_torque_file.hpp"
#include "model/robot_model.hpp"
#include "sil/scenario.hpp"
#include "sim/motor_file.hpp"
#include "sim/variation_ranges.hpp"

namespace pmg::training {

namespace {

using nlohmann::ordered_json;

/// A number as files::ConfigReader reads it, whole ones stay whole; true or false; else a word.
ordered_json scalar_of(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  double value = 0.0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc{}) return text;
  if (text.find_first_of(".eE") != std::string::npos) return value;
  return static_cast<std::int64_t>(value);
}

/// Of a file that its reader has accepted: mappings, lists, numbers and words.
ordered_json json_of(const YAML::Node& node) {
  ordered_json json;
  if (node.IsMap()) {
    json = ordered_json::object();
    for (const auto& item : node) json[item.first.Scalar()] = json_of(item.second);
  } else if (node.IsSequence()) {
    json = ordered_json::array();
    for (const YAML::Node& item : node) json.push_back(json_of(item));
  } else {
    json = scalar_of(node.Scalar());
  }
  return json;
}

}  // namespace

std::string randomization_json(const std::filesystem::path& file) {
  sim::check_training_ranges(file);
  return json_of(YAML::Load(files::read_bounded_text(file, files::kLargestYaml_bytes, "a YAML file"))).dump();
}

std::string motors_json(const std::filesystem::path& robot, const std::filesystem::path& file) {
  const sim::ActuatorsByJoint motors = sim::read_motor_file(file, model::load_robot(robot).joint_index);
  const model::ActuatorParameters neutral;
  ordered_json json = ordered_json::object();
  for (const auto& [joint, actuator] : motors) {
    ordered_json& values = json[joint] = ordered_json::object();
    for (const model::ActuatorParameter& p : model::actuator_parameters()) {
      if (p.value(actuator) != p.value(neutral)) values[std::string(p.name)] = p.value(actuator);
    }
    if (actuator.residual_torque.count > 0)
      values["residual_torque"] =
          json_of(YAML::Load(model::residual_torque_yaml(actuator.residual_torque)))["residual_torque"];
  }
  return json.dump();
}

std::string scenario_json(const std::filesystem::path& file) {
  ordered_json json = ordered_json::array();
  for (const sil::ScenarioStep& step : sil::load_scenario(file).steps) {
    json.push_back({{"text", step.text},
                    {"for_s", step.duration_s},
                    {"command", step.command.u},
                    {"hoist_without_policy", step.hoist_without_policy}});
  }
  return json.dump();
}

}  // namespace pmg::training
