// The record of actuator models at work, which training's batched ones are tested against, is what src/sim's do.
// Written anew with PMG_WRITE_RECORDS=1 when an effect is added or changed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "effects/examples.hpp"
#include "folders.hpp"
#include "sim/actuator_model.hpp"
#include "sim/motor_file.hpp"
#include "temporary_folder.hpp"

namespace pmg::test {
namespace {

using nlohmann::ordered_json;
using Values = std::map<std::string, double>;  // of what isn't neutral, by the names of motor.yaml

constexpr double kStep_s = 0.002;
constexpr int kSteps = 120;
constexpr double kOtherLibm_Nm = 1e-9;

const std::string kActuatorRecord = pmg::test::project_folder() + "/test/data/training/actuators.json";

/// Each effect by itself, then with what it meets.
const std::map<std::string, Values> kCombined = {
    {"neutral", {}},
    {"gains, limit, dead band",
     {{"drive.kp_scale", 0.9}, {"drive.kd_scale", 1.2}, {"drive.limit", 6.0}, {"drive.dead_band_rad", 0.02}}},
    {"voltage",
     {{"drive.torque_per_unit_Nm", 1.3},
      {"drive.back_emf_s_per_rad", 0.4},
      {"drive.limit", 15.0},
      {"drive.supply_sag_per_Nm", 0.05},
      {"drive.brake_when_disabled", 0.5}}},
    {"hysteresis, eccentricity",
     {{"sensor.hysteresis_rad", 0.02},
      {"sensor.eccentricity_rad", 0.015},
      {"sensor.eccentricity_phase_rad", 0.7},
      {"sensor.zero_offset_rad", 0.01}}},
    {"velocity lag", {{"sensor.velocity_lag_s", 0.008}}},
    {"friction under load",
     {{"friction.coulomb_Nm", 0.5},
      {"friction.load_driving", 0.12},
      {"friction.load_backdriving", 0.06},
      {"friction.presliding_rad", 0.003},
      {"transmission.armature_kg_m2", 0.03}}},
    {"profile without a rate limit", {{"command.acceleration_limit_rad_s2", 20.0}}},
    {"update", {{"command.update_s", 0.033}, {"command.delay_s", 0.003}}},
    {"dead band that subtracts and sleeps",
     {{"drive.dead_band_rad", 0.05}, {"drive.dead_band_subtracts", 0.8}, {"drive.dead_band_wake_rad", 0.04}}},
    {"output", {{"drive.output_dead_band", 1.5}, {"drive.output_rate_limit_per_s", 300.0}}},
    {"late and slow output",
     {{"drive.torque_delay_s", 0.004}, {"drive.output_rate_limit_per_s", 150.0}, {"drive.limit", 9.0}}},
    {"overspeed guard of a limited drive", {{"drive.cut_speed_rad_s", 1.2}, {"drive.limit", 8.0}}},
    {"sensor on the motor, hard shaft, friction behind it",
     {{"sensor.on_motor", 1.0},
      {"sensor.delay_s", 0.001},
      {"transmission.armature_kg_m2", 0.03},
      {"transmission.stiffness_Nm_per_rad", 300.0},
      {"transmission.hardening_Nm_per_rad3", 40000.0},
      {"transmission.friction_on_joint", 0.7},
      {"friction.coulomb_Nm", 0.6},
      {"friction.load_driving", 0.1}}},
    {"offset of the drive", {{"drive.offset_Nm", 0.8}, {"friction.coulomb_Nm", 0.3}}},
    {"belt",
     {{"transmission.armature_kg_m2", 0.03},
      {"transmission.stiffness_Nm_per_rad", 300.0},
      {"transmission.damping_Nm_s_per_rad", 0.4},
      {"transmission.hysteretic_share", 0.6},
      {"transmission.hysteresis_rad", 0.015},
      {"friction.coulomb_Nm", 0.3}}},
    {"other friction",
     {{"friction.viscous_Nm_s_per_rad", 0.2},
      {"friction.viscous_quadratic_Nm_s2_per_rad2", 0.15},
      {"friction.viscous_asymmetry", 0.4},
      {"friction.coulomb_Nm", 0.5},
      {"friction.stribeck_Nm", 0.5},
      {"friction.stribeck_rad_s", 0.3},
      {"friction.stribeck_exponent", 0.7},
      {"friction.stribeck_asymmetry", -0.5}}},
    {"warm, other forms",
     {{"thermal.viscous_per_K", -0.03},
      {"thermal.resistance_per_K", 0.0039},
      {"thermal.friction_per_J", -0.4},
      {"thermal.torque_per_Nm2_s", -0.04},
      {"thermal.torque_fade_share", 0.4},
      {"thermal.torque_fade_s", 0.1},
      {"drive.back_emf_s_per_rad", 0.2},
      {"friction.viscous_Nm_s_per_rad", 0.3},
      {"friction.coulomb_Nm", 0.8}}},
    {"residual of position and of speed", {{"friction.coulomb_Nm", 0.6}}},
    {"residual of error, time and bend", {{"command.delay_s", 0.003}}},
    {"residual of a change, friction behind the shaft",
     {{"transmission.armature_kg_m2", 0.03},
      {"transmission.stiffness_Nm_per_rad", 900.0},
      {"transmission.friction_on_joint", 0.6},
      {"drive.kp_scale", 0.9},
      {"friction.coulomb_Nm", 0.4}}},
    {"residual of integral, drive and rest", {{"friction.coulomb_Nm", 0.8}, {"friction.presliding_rad", 0.02}}},
    {"residual that repeats every turn, elastic",
     {{"transmission.armature_kg_m2", 0.03}, {"transmission.stiffness_Nm_per_rad", 900.0}}},
    {"much, rigid",
     {{"command.delay_s", 0.005},
      {"command.rate_limit_rad_s", 3.0},
      {"command.hold_s", 0.004},
      {"drive.limit", 12.0},
      {"drive.back_emf_s_per_rad", 0.2},
      {"sensor.lag_s", 0.003},
      {"friction.coulomb_Nm", 0.6},
      {"friction.load_driving", 0.1},
      {"friction.load_backdriving", 0.05},
      {"ripple.amplitude_Nm", 0.3}}},
    {"much, elastic",
     {{"transmission.armature_kg_m2", 0.04},
      {"transmission.stiffness_Nm_per_rad", 600.0},
      {"transmission.backlash_rad", 0.005},
      {"friction.coulomb_Nm", 0.6},
      {"friction.load_driving", 0.1},
      {"drive.stall_torque_Nm", 12.0},
      {"drive.no_load_rad_s", 6.0},
      {"sensor.quantum_rad", 0.0005}}},
};

const std::map<std::string, Values>& cases() {
  static const std::map<std::string, Values> kCases = [] {
    std::map<std::string, Values> all = kCombined;
    for (const effects::Effect& effect : effects::catalogue()) {
      for (const effects::Form& form : effect.forms) {
        const model::ActuatorParameters with = with_effect(effect, form).actuator;
        for (const model::ActuatorParameter& p : model::actuator_parameters()) {
          if (effect.name != "load" && p.value(with) != p.value({}))
            all[effect.name + ", " + form.name][std::string(p.name)] = p.value(with);
        }
      }
    }
    return all;
  }();
  return kCases;
}

/// Residual torques of some cases, as motor.yaml has them: every quantity, within and beyond its axis.
const std::map<std::string, std::string> kResidualTorques = {
    {"residual of position and of speed",
     R"({"terms": [{"acts_as": "torque", "over": [{"quantity": "position_rad", "from": -0.2, "to": 0.15, "knots": 4}],
         "values_Nm": [0.3, -0.2, 0.5, 0.1]},
        {"acts_as": "friction", "over": [{"quantity": "speed_rad_s", "from": 0.1, "to": 2.2, "knots": 3},
         {"quantity": "temperature_C", "from": 15, "to": 35, "knots": 2}], "values_Nm": [0.2, 0.3, 0.1, -0.4, 0.6, 0.5]}]})"},
    {"residual of error, time and bend",
     R"({"terms": [{"acts_as": "torque", "over": [{"quantity": "error_rad", "from": -0.2, "to": 0.25, "knots": 3},
         {"quantity": "time_s", "from": 0.0, "to": 0.2, "knots": 3}], "values_Nm": [0.3, -0.2, 0.5, 0.1, 0.2, 0.3, -0.4, 0.3, 0.2]},
        {"acts_as": "torque", "over": [{"quantity": "bend_rad", "from": -0.1, "to": 0.1, "knots": 4}],
         "values_Nm": [0.5, 0.1, -0.2, -0.6]}]})"},
    {"residual of a change, friction behind the shaft",
     R"({"terms": [{"acts_as": "torque", "over": [{"quantity": "drive_Nm", "from": -4, "to": 3, "knots": 3},
         {"quantity": "command_change_Nm", "from": -2, "to": 3, "knots": 2, "lag_s": 0.08}], "values_Nm": [0.9, 0.5, 0.1, 0.1, -0.6, -0.8]},
        {"acts_as": "friction", "over": [{"quantity": "position_rad", "from": -0.2, "to": 0.2, "knots": 3}],
         "values_Nm": [0.3, -0.2, 0.4]}]})"},
    {"residual of integral, drive and rest",
     R"({"terms": [{"acts_as": "torque", "over": [{"quantity": "integral_Nm_s", "from": -0.3, "to": 0.2, "knots": 4},
         {"quantity": "drive_Nm", "from": -4, "to": 5, "knots": 2}], "values_Nm": [-0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.5, 0.4]},
        {"acts_as": "friction", "over": [{"quantity": "rest_s", "from": 0.0, "to": 0.01, "knots": 3}],
         "values_Nm": [-0.4, 0.5, 0.6]}]})"},
    {"residual that repeats every turn, elastic",
     R"({"terms": [{"acts_as": "torque", "over": [{"quantity": "position_rad", "periodic": true, "from": -0.1, "knots": 9}],
         "values_Nm": [0.3, -0.2, 0.5, 0.1, 0.2, 0.3, -0.4, 0.3, 0.2]},
        {"acts_as": "torque", "over": [{"quantity": "time_s", "periodic": true, "from": 0.01, "to": 0.06, "knots": 4}],
         "values_Nm": [0.3, -0.2, 0.5, 0.1]}]})"},
};

struct Step {
  sim::ActuatorInput input;
  double q_rad = 0.0, dq_rad_s = 0.0;
};

/// A joint that swings by 0.3 rad while its command, new every five steps, swings otherwise; switched off for a while.
Step step_at(int k) {
  const int commanded_step = k / 5 * 5;
  const double t = k * kStep_s, commanded_at = commanded_step * kStep_s;
  Step step;
  step.q_rad = 0.3 * std::sin(9.0 * t + 0.5);
  step.dq_rad_s = 2.7 * std::cos(9.0 * t + 0.5);
  step.input = {.q_rad = 0.35 * std::sin(13.0 * commanded_at) + 0.1,
                .dq_rad_s = 0.2,
                .kp = 60.0,
                .kd = 2.0,
                .feed_forward_Nm = 0.7 * std::cos(5.0 * t),
                .supply = 1.0 - 0.1 * std::sin(7.0 * t),
                .enabled = k < 70 || k >= 80,
                .temperature_C = 25.0 + 15.0 * std::sin(4.0 * t),
                .external_Nm = 2.0 * std::sin(11.0 * t)};
  return step;
}

ordered_json inputs() {
  ordered_json steps = ordered_json::array();
  for (int k = 0; k < kSteps; ++k) {
    const auto [input, q_rad, dq_rad_s] = step_at(k);
    steps.push_back({{"q_des_rad", input.q_rad},
                     {"dq_des_rad_s", input.dq_rad_s},
                     {"kp", input.kp},
                     {"kd", input.kd},
                     {"feed_forward_Nm", input.feed_forward_Nm},
                     {"supply", input.supply},
                     {"enabled", input.enabled},
                     {"temperature_C", input.temperature_C},
                     {"external_Nm", input.external_Nm},
                     {"q_rad", q_rad},
                     {"dq_rad_s", dq_rad_s}});
  }
  return steps;
}

model::ResidualTorque residual_torque(const std::string& text) {
  if (text.empty()) return {};
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.file("motor.yaml");
  std::ofstream(file) << R"({"joints": {"one": {"residual_torque": )" << text << "}}}";
  return sim::read_motor_file(file).at("one").residual_torque;
}

ordered_json outputs(const Values& values, const std::string& residual = "") {
  model::ActuatorParameters parameters;
  parameters.residual_torque = residual_torque(residual);
  for (const auto& [name, value] : values) model::actuator_parameter(name).in(parameters) = value;
  sim::ActuatorModel model(parameters, kStep_s);
  model.reset(step_at(0).q_rad);
  ordered_json torque_Nm = ordered_json::array(), slope = ordered_json::array();
  for (int k = 0; k < kSteps; ++k) {
    const auto [input, q_rad, dq_rad_s] = step_at(k);
    const sim::ActuatorTorque torque = model.step(input, q_rad, dq_rad_s);
    torque_Nm.push_back(torque.torque_Nm);
    slope.push_back(torque.slope_Nm_s_per_rad);
  }
  ordered_json of_file = values;
  if (!residual.empty()) of_file["residual_torque"] = ordered_json::parse(residual);
  return {{"parameters", of_file}, {"torque_Nm", torque_Nm}, {"slope_Nm_s_per_rad", slope}};
}

ordered_json actuators_now() {
  ordered_json found = ordered_json::object();
  for (const auto& [name, values] : cases()) {
    const auto residual = kResidualTorques.find(name);
    found[name] = outputs(values, residual == kResidualTorques.end() ? "" : residual->second);
  }
  return {{"step_s", kStep_s}, {"steps", inputs()}, {"cases", found}};
}

/// Beside the joint that lacks it alone.
TEST(ActuatorRecord, ShowsEveryEffectAtWork) {
  const auto torque = [](const model::ActuatorParameters& parameters) {
    Values values;
    for (const model::ActuatorParameter& p : model::actuator_parameters())
      values[std::string(p.name)] = p.value(parameters);
    return outputs(values)["torque_Nm"];
  };
  for (const effects::Effect& effect : effects::catalogue()) {
    for (const effects::Form& form : effect.forms) {
      if (effect.name == "load") continue;  // of the joint, not of its actuator
      EXPECT_NE(torque(with_effect(effect, form).actuator), torque(without_effect(effect).actuator))
          << effect.name << ", " << form.name;
    }
  }
  for (const model::ActuatorParameter& parameter : model::actuator_parameters()) {
    bool used = false;
    for (const auto& [name, values] : cases()) used = used || values.contains(std::string(parameter.name));
    EXPECT_TRUE(used) << parameter.name;
  }
}

TEST(ActuatorRecord, ShowsEveryQuantityOfAResidualTorqueAtWork) {
  std::string all;
  for (const auto& [name, text] : kResidualTorques) {
    all += text;
    EXPECT_NE(outputs(cases().at(name), text)["torque_Nm"], outputs(cases().at(name))["torque_Nm"]) << name;
  }
  for (const auto& [quantity, quantity_name] : model::residual_quantities())
    EXPECT_NE(all.find(std::string(quantity_name)), std::string::npos) << quantity_name;
}

TEST(ActuatorRecord, TrainingKnowsEachNumbersNeutralValue) {
  ordered_json neutral = ordered_json::object();  // null for infinity
  for (const model::ActuatorParameter& p : model::actuator_parameters()) neutral[std::string(p.name)] = p.value({});
  const std::string file = project_folder() + "/training/pmg_train/actuator_parameters.json";
  if (std::getenv("PMG_WRITE_RECORDS") != nullptr) std::ofstream(file) << neutral.dump() << '\n';
  EXPECT_EQ(ordered_json::parse(std::ifstream(file)).dump(), neutral.dump());
}

TEST(ActuatorRecord, IsWhatTheActuatorModelsGive) {
  const ordered_json now = actuators_now();
  if (std::getenv("PMG_WRITE_RECORDS") != nullptr) std::ofstream(kActuatorRecord) << now.dump() << '\n';
  const auto record = ordered_json::parse(std::ifstream(kActuatorRecord));
  for (const auto& [name, values] : cases()) {
    const ordered_json &then = record["cases"][name], &there = now["cases"][name];
    ASSERT_EQ(then["parameters"], there["parameters"]) << name;
    for (std::size_t k = 0; k < static_cast<std::size_t>(kSteps); ++k) {
      for (const char* what : {"torque_Nm", "slope_Nm_s_per_rad"}) {
        EXPECT_NEAR(then[what][k].get<double>(), there[what][k].get<double>(), kOtherLibm_Nm) << name << ", step " << k;
      }
    }
  }
}

}  // namespace
}  // namespace pmg::test
