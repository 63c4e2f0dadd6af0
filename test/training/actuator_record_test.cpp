// The record of actuator models at work, which training's batched ones are tested against, is what src/sim's do.
// Written anew with PMG_WRITE_RECORDS=1 when an effect is added or changed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/actuator_model.hpp"

namespace pmg::test {
namespace {

using nlohmann::ordered_json;
using Values = std::map<std::string, double>;  // of what isn't neutral, by the names of motor.yaml

constexpr double kStep_s = 0.002;
constexpr int kSteps = 120;
constexpr double kOtherLibm_Nm = 1e-9;

const std::string kActuatorRecord = PMG_SOURCE_DIR "/test/data/training/actuators.json";

/// Each effect by itself, then with what it meets.
const std::map<std::string, Values> kCases = {
    {"neutral", {}},
    {"delay", {{"command.delay_s", 0.0073}}},
    {"rate limit", {{"command.rate_limit_rad_s", 1.5}}},
    {"hold", {{"command.hold_s", 0.007}}},
    {"gains, limit, dead band",
     {{"drive.kp_scale", 0.9}, {"drive.kd_scale", 1.2}, {"drive.limit", 6.0}, {"drive.dead_band_rad", 0.02}}},
    {"voltage",
     {{"drive.torque_per_unit_Nm", 1.3},
      {"drive.back_emf_s_per_rad", 0.4},
      {"drive.limit", 15.0},
      {"drive.supply_sag_per_Nm", 0.05},
      {"drive.brake_when_disabled", 0.5}}},
    {"torque and speed", {{"drive.stall_torque_Nm", 9.0}, {"drive.no_load_rad_s", 4.0}}},
    {"sensor", {{"sensor.zero_offset_rad", 0.03}, {"sensor.quantum_rad", 0.0015}}},
    {"hysteresis, eccentricity",
     {{"sensor.hysteresis_rad", 0.02},
      {"sensor.eccentricity_rad", 0.015},
      {"sensor.eccentricity_phase_rad", 0.7},
      {"sensor.zero_offset_rad", 0.01}}},
    {"lag", {{"sensor.lag_s", 0.006}}},
    {"velocity lag", {{"sensor.velocity_lag_s", 0.008}}},
    {"friction",
     {{"friction.viscous_Nm_s_per_rad", 0.3},
      {"friction.coulomb_Nm", 0.8},
      {"friction.stribeck_Nm", 0.4},
      {"friction.stribeck_rad_s", 0.2},
      {"friction.asymmetry", 0.15}}},
    {"friction under load",
     {{"friction.coulomb_Nm", 0.5},
      {"friction.load_driving", 0.12},
      {"friction.load_backdriving", 0.06},
      {"friction.presliding_rad", 0.003},
      {"transmission.armature_kg_m2", 0.03}}},
    {"elastic",
     {{"transmission.armature_kg_m2", 0.03},
      {"transmission.stiffness_Nm_per_rad", 900.0},
      {"transmission.damping_Nm_s_per_rad", 0.5},
      {"transmission.backlash_rad", 0.01}}},
    {"warm",
     {{"thermal.friction_per_K", -0.02},
      {"thermal.torque_per_K", -0.004},
      {"drive.back_emf_s_per_rad", 0.2},
      {"drive.brake_when_disabled", 0.5},
      {"friction.viscous_Nm_s_per_rad", 0.3},
      {"friction.coulomb_Nm", 0.8}}},
    {"heats up", {{"thermal.friction_per_Nm2_s", -0.05}, {"thermal.cooling_s", 0.2}, {"friction.coulomb_Nm", 0.8}}},
    {"ripple",
     {{"ripple.amplitude_Nm", 0.5}, {"ripple.order", 12.0}, {"ripple.phase_rad", 0.4}, {"ripple.offset_Nm", -0.2}}},
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
                .temperature_C = 25.0 + 15.0 * std::sin(4.0 * t)};
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
                     {"q_rad", q_rad},
                     {"dq_rad_s", dq_rad_s}});
  }
  return steps;
}

ordered_json outputs(const Values& values) {
  model::ActuatorParameters parameters;
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
  return {{"parameters", values}, {"torque_Nm", torque_Nm}, {"slope_Nm_s_per_rad", slope}};
}

ordered_json actuators_now() {
  ordered_json names = ordered_json::array(), cases = ordered_json::object();
  for (const model::ActuatorParameter& parameter : model::actuator_parameters()) names.push_back(parameter.name);
  for (const auto& [name, values] : kCases) cases[name] = outputs(values);
  return {{"step_s", kStep_s}, {"names", names}, {"steps", inputs()}, {"cases", cases}};
}

TEST(ActuatorRecord, ShowsEveryEffectAtWork) {
  const std::vector<double> neutral = outputs({})["torque_Nm"];
  for (const auto& [name, values] : kCases) {
    if (values.empty()) continue;
    EXPECT_NE(outputs(values)["torque_Nm"].get<std::vector<double>>(), neutral) << name;
  }
  for (const model::ActuatorParameter& parameter : model::actuator_parameters()) {
    bool used = false;
    for (const auto& [name, values] : kCases) used = used || values.contains(std::string(parameter.name));
    EXPECT_TRUE(used) << parameter.name;
  }
}

TEST(ActuatorRecord, IsWhatTheActuatorModelsGive) {
  const ordered_json now = actuators_now();
  if (std::getenv("PMG_WRITE_RECORDS") != nullptr) std::ofstream(kActuatorRecord) << now.dump() << '\n';
  const auto record = ordered_json::parse(std::ifstream(kActuatorRecord));
  ASSERT_EQ(record["names"], now["names"]);
  for (const auto& [name, values] : kCases) {
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
