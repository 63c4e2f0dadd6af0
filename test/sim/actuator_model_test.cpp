// One actuator as a whole: each effect acts as its name says, and does nothing when it is neutral.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "generator_core/allocation_count.hpp"
#include "one_joint.hpp"

namespace pmg::test {
namespace {

TEST(ActuatorModel, IsAPdWhenNeutral) {
  sim::ActuatorModel actuator({}, kActuatorStep_s);
  const sim::ActuatorTorque torque =
      actuator.step({.q_rad = 0.5, .dq_rad_s = 0.2, .kp = 30.0, .kd = 2.0, .feed_forward_Nm = 0.7}, 0.1, -0.3);
  EXPECT_DOUBLE_EQ(torque.torque_Nm, 30.0 * 0.4 + 2.0 * 0.5 + 0.7);
  EXPECT_DOUBLE_EQ(torque.slope_Nm_s_per_rad, -2.0);
}

TEST(ActuatorModel, NeverAllocatesInAStep) {
  PMG_SKIP_IF_HEAP_IS_NOT_COUNTED();
  sim::ActuatorModel actuator(with([](auto& p) {
                                p.command = {.delay_s = 0.02, .rate_limit_rad_s = 4.0};
                                p.friction = {.coulomb_Nm = 0.1, .stribeck_Nm = 0.1, .load_driving = 0.1};
                              }),
                              kActuatorStep_s);
  const long before = test::allocation_count();
  for (int k = 0; k < 100; ++k) actuator.step({.q_rad = 1.0, .kp = 1.0}, 0.0, 0.1);
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(ActuatorModel, RestsWithEveryFormAsAfterALongTime) {
  for (const double friction_on_joint : {0.0, 0.6}) {
    OneJoint joint(with([&](auto& p) {
      p.command.delay_s = 0.01, p.command.update_s = 0.008, p.command.acceleration_limit_rad_s2 = 50.0;
      p.drive.torque_delay_s = 0.005, p.drive.output_rate_limit_per_s = 100.0, p.drive.output_dead_band = 0.2;
      p.drive.torque_scale = 0.9, p.drive.saturation_per_Nm = 0.05, p.drive.most_power_W = 30.0;
      p.sensor.delay_s = 0.003, p.sensor.hold_s = 0.006, p.sensor.on_motor = friction_on_joint == 0.0 ? 1.0 : 0.0;
      p.transmission.armature_kg_m2 = 0.02, p.transmission.stiffness_Nm_per_rad = 200.0;
      p.transmission.hardening_Nm_per_rad3 = 1e5, p.transmission.damping_Nm_s_per_rad = 0.5;
      p.transmission.friction_on_joint = friction_on_joint;
      p.friction.coulomb_Nm = 1.0, p.friction.stribeck_Nm = 0.5, p.friction.stribeck_exponent = 1.0;
    }));
    const sim::ActuatorInput input{.q_rad = 0.55, .kp = 20.0, .kd = 1.0};
    joint.q_rad = 0.5;
    joint.actuator.reset_at_rest(input, joint.q_rad, 1.5);
    joint.run(1.0, input, -1.5);
    EXPECT_NEAR(joint.q_rad, 0.5, 1e-9) << "friction on the joint: " << friction_on_joint;
    EXPECT_NEAR(joint.torque.torque_Nm, 1.5, 1e-7);
  }
}

TEST(ActuatorModel, RefusesWhatMakesNoSense) {
  const std::vector<std::pair<const char*, std::function<void(model::ActuatorParameters&)>>> senseless = {
      {"command.delay_s", [](auto& p) { p.command.delay_s = 2.0; }},
      {"command.rate_limit_rad_s", [](auto& p) { p.command.rate_limit_rad_s = 0.0; }},
      {"command.acceleration_limit_rad_s2", [](auto& p) { p.command.acceleration_limit_rad_s2 = 0.0; }},
      {"command.update_s", [](auto& p) { p.command.update_s = -0.1; }},
      {"drive.torque_delay_s", [](auto& p) { p.drive.torque_delay_s = 2.0; }},
      {"drive.output_rate_limit_per_s", [](auto& p) { p.drive.output_rate_limit_per_s = 0.0; }},
      {"drive.output_dead_band", [](auto& p) { p.drive.output_dead_band = -1.0; }},
      {"drive.dead_band_subtracts", [](auto& p) { p.drive.dead_band_subtracts = 1.1; }},
      {"drive.dead_band_wake_rad", [](auto& p) { p.drive.dead_band_wake_rad = -0.1; }},
      {"drive.torque_scale", [](auto& p) { p.drive.torque_scale = 0.0; }},
      {"drive.saturation_per_Nm", [](auto& p) { p.drive.saturation_per_Nm = -0.1; }},
      {"drive.most_power_W", [](auto& p) { p.drive.most_power_W = 0.0; }},
      {"drive.cut_speed_rad_s", [](auto& p) { p.drive.cut_speed_rad_s = 0.0; }},
      {"drive.supply_sag_time_s", [](auto& p) { p.drive.supply_sag_time_s = -1.0; }},
      {"drive.supply_sag_slow_share", [](auto& p) { p.drive.supply_sag_slow_share = 1.5; }},
      {"drive.supply_limit_Nm", [](auto& p) { p.drive.supply_limit_Nm = 0.0; }},
      {"sensor.delay_s", [](auto& p) { p.sensor.delay_s = 2.0; }},
      {"sensor.hold_s", [](auto& p) { p.sensor.hold_s = -0.1; }},
      {"sensor.on_motor", [](auto& p) { p.sensor.on_motor = 2.0; }},
      {"eccentricity", [](auto& p) { p.sensor.eccentricity_rad = 1.0; }},
      {"stiffness", [](auto& p) { p.transmission.backlash_rad = 0.01; }},
      {"stiffness", [](auto& p) { p.transmission.hardening_Nm_per_rad3 = 1.0; }},
      {"armature", [](auto& p) { p.transmission.stiffness_Nm_per_rad = 100.0; }},
      {"transmission.friction_on_joint", [](auto& p) { p.transmission.friction_on_joint = -0.5; }},
      {"friction.presliding_rad", [](auto& p) { p.friction.presliding_rad = 0.0; }},
      {"friction.stribeck_exponent", [](auto& p) { p.friction.stribeck_exponent = 0.0; }},
      {"friction.viscous_quadratic_Nm_s2_per_rad2",
       [](auto& p) { p.friction.viscous_quadratic_Nm_s2_per_rad2 = -1.0; }},
      {"friction.viscous_asymmetry", [](auto& p) { p.friction.viscous_asymmetry = 1.5; }},
      {"friction.stribeck_asymmetry", [](auto& p) { p.friction.stribeck_asymmetry = -1.5; }},
      {"friction.load_by_motor", [](auto& p) { p.friction.load_by_motor = 1.5; }},
      {"friction.load_net", [](auto& p) { p.friction.load_by_motor = p.friction.load_net = 0.7; }},
      {"thermal.cooling_s", [](auto& p) { p.thermal.cooling_s = 0.0; }},
      {"thermal.torque_fade_s", [](auto& p) { p.thermal.torque_fade_s = 0.0; }},
      {"thermal.torque_fade_share", [](auto& p) { p.thermal.torque_fade_share = 1.5; }}};
  for (const auto& [name, set] : senseless) {
    try {
      sim::ActuatorModel(with(set), kActuatorStep_s);
      ADD_FAILURE() << name << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(name));
    }
  }
}

TEST(ActuatorModel, RefusesByItsNameWhatANumberMayNotBe) {
  for (const model::ActuatorParameter& p : model::actuator_parameters()) {
    if (p.allowed == model::Allowed::kAny) continue;
    model::ActuatorParameters parameters;
    p.in(parameters) = p.allowed == model::Allowed::kNotNegative ? -1e-3
                       : p.allowed == model::Allowed::kPositive  ? 0.0
                                                                 : 1.5;
    try {
      sim::ActuatorModel(parameters, 0.002);
      ADD_FAILURE() << p.name << " may be " << p.value(parameters);
    } catch (const std::invalid_argument& error) {
      EXPECT_TRUE(std::string_view(error.what()).starts_with(p.name)) << error.what();
    }
  }
}

}  // namespace
}  // namespace pmg::test
