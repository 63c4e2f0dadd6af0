// The simulation that fits are made with is the one that the SIL runs.
#include <gtest/gtest.h>

#include <algorithm>

#include "calib/mujoco_joint.hpp"
#include "calib/single_joint.hpp"
#include "calib/synthetic_bench.hpp"
#include "effects/examples.hpp"
#include "model/hanging_load.hpp"
#include "sim/motors_in_force.hpp"
#include "sim/robots.hpp"
#include "sim/world.hpp"

namespace pmg {
namespace {

struct Kind {
  std::string name;
  model::ActuatorParameters actuator;
};
std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }

/// Each form of each effect by itself, then with what it meets.
std::vector<Kind> kinds() {
  std::vector<Kind> found;
  for (const effects::Effect& effect : effects::catalogue()) {
    for (const effects::Form& form : effect.forms) {
      found.push_back({effect.name + "_" + form.name, test::with_effect(effect, form).actuator});
      // What a belt keeps of the example's stiffness is less than the gain of a run: such a joint swings up.
      auto& transmission = found.back().actuator.transmission;
      if (transmission.hysteretic_share > 0.0) transmission.stiffness_Nm_per_rad *= 5.0;
    }
  }
  const auto add = [&](const char* name, const auto& set) {
    found.push_back({name, {}});
    set(found.back().actuator);
  };
  add("Pd", [](auto&) {});
  add("Gain", [](auto& p) { p.drive.kd_scale = 1.4; });
  add("Voltage", [](auto& p) {
    p.drive.torque_per_unit_Nm = 0.9;
    p.drive.back_emf_s_per_rad = 0.3;
    p.drive.limit = 6.0;
    p.drive.supply_sag_per_Nm = 0.05;
    p.drive.brake_when_disabled = 0.8;
  });
  add("Friction", [](auto& p) {
    p.friction = {.viscous_Nm_s_per_rad = 0.1, .coulomb_Nm = 0.4, .asymmetry = 0.2, .presliding_rad = 0.02};
  });
  add("Delay", [](auto& p) { p.command.delay_s = 0.0237, p.command.rate_limit_rad_s = 3.0; });
  add("Sensor", [](auto& p) {
    p.sensor = {.zero_offset_rad = 0.03, .angle_scale = 1.1, .lag_s = 0.004, .velocity_lag_s = 0.002};
  });
  add("ReadingsScale", [](auto& p) { p.sensor.angle_scale = 0.9; });
  add("Hold", [](auto& p) { p.command.hold_s = 0.006, p.drive.dead_band_rad = 0.01; });
  add("DeadBandForms", [](auto& p) {
    p.drive.dead_band_rad = 0.02;
    p.drive.dead_band_subtracts = 0.8;
    p.drive.dead_band_wake_rad = 0.02;
    p.drive.output_dead_band = 0.1;
  });
  add("LateOutput", [](auto& p) { p.drive.torque_delay_s = 0.0037, p.drive.output_rate_limit_per_s = 60.0; });
  add("Battery", [](auto& p) {
    p.drive.limit = 5.0;
    p.drive.supply_sag_per_Nm = 0.1;
    p.drive.supply_sag_time_s = 0.3;
    p.drive.supply_sag_slow_share = 0.7;
    p.drive.supply_limit_Nm = 2.0;
  });
  add("LateReadings", [](auto& p) { p.sensor.delay_s = 0.0053, p.sensor.hold_s = 0.005; });
  add("SensorOnTheMotor", [](auto& p) {
    p.sensor.on_motor = 1.0;
    p.transmission.stiffness_Nm_per_rad = 60.0;
    p.transmission.hardening_Nm_per_rad3 = 1e4;
    p.transmission.friction_on_joint = 0.6;
    p.friction.coulomb_Nm = 0.1;
  });
  add("OffsetOfTheDrive", [](auto& p) { p.drive.offset_Nm = 0.6; });
  add("Belt", [](auto& p) {
    p.transmission.stiffness_Nm_per_rad = 200.0;
    p.transmission.hysteretic_share = 0.6;
    p.transmission.hysteresis_rad = 0.012;
    p.friction.coulomb_Nm = 0.1;
  });
  add("OtherLoadFriction", [](auto& p) {
    p.friction.load_driving = 0.2;
    p.friction.load_backdriving = 0.1;
    p.friction.load_by_motor = 0.4;
    p.friction.load_net = 0.5;
  });
  add("ResidualTorque", [](auto& p) {
    using model::ResidualQuantity;
    p.friction.coulomb_Nm = 0.1;
    p.residual_torque.count = 2;
    p.residual_torque.terms[0] = {model::ResidualActs::kTorque,
                                  {model::ResidualAxis{ResidualQuantity::kPosition, -1.0, 1.0, 3},
                                   model::ResidualAxis{ResidualQuantity::kTime, 0.0, 2.0, 2}},
                                  {0.3, -0.2, 0.1, 0.4, -0.3, 0.2}};
    p.residual_torque.terms[1] = {model::ResidualActs::kFriction,
                                  {model::ResidualAxis{ResidualQuantity::kSpeed, 0.0, 3.0, 3}, {}},
                                  {0.1, 0.3, 0.2}};
  });
  for (Kind& kind : found) kind.actuator.transmission.armature_kg_m2 = 0.02;
  return found;
}

/// The same run of a load that hangs askew, on a day when the joint warms from 25 to 55 degrees, switched off towards
/// its end.
calib::SingleJoint warming(const bench::Bench& bench, const calib::SingleJoint& joint) {
  bench::BenchRun run = joint.run();
  run.load.hangs_at_rad = 0.3;
  const std::size_t samples = run.recording.t_s.size();
  for (std::size_t k = 0; k < samples; ++k) {
    run.recording.temp_C.push_back(25.0 + 30.0 * static_cast<double>(k) / static_cast<double>(samples));
    run.recording.enabled.push_back(k < 250);
  }
  return {bench, run, joint.step_s()};
}

class BothSimulators : public testing::TestWithParam<Kind> {};

// 1e-6 rad is what the two may differ by after 3 s of 2 ms steps; the same arithmetic in another order leaves 1e-10.
TEST_P(BothSimulators, MoveAJointAlike) {
  const bench::Bench bench = test::pd_bench(true);
  const calib::JointModel model{.actuator = GetParam().actuator};
  const std::vector<calib::SingleJoint> joints = test::record(bench, model, 2);
  for (const calib::SingleJoint& recorded : joints) {
    const calib::SingleJoint joint = warming(bench, recorded);
    test::MujocoJoint mujoco(joint.run().load, model.actuator, joint.step_s());
    mujoco.reset(joint.input(0), joint.start(model).q_rad);
    const std::vector<double> compiled = joint.rollout(model);
    double largest_rad = 0.0, farthest_rad = 0.0;
    for (std::size_t k = 0; k < joint.steps(); ++k) {
      mujoco.step(joint.input(k));
      farthest_rad = std::max(farthest_rad, std::abs(mujoco.q_rad()));
      if ((k + 1) % 5 != 0) continue;  // five steps a sample
      largest_rad = std::max(largest_rad, std::abs(mujoco.reading_rad() - compiled[(k + 1) / 5]));
    }
    EXPECT_LT(largest_rad, 1e-6);
    EXPECT_GT(farthest_rad, 0.3) << "nothing moved, so nothing was compared";
  }
}

INSTANTIATE_TEST_SUITE_P(EveryEffect, BothSimulators, testing::ValuesIn(kinds()),
                         [](const auto& instance) { return instance.param.name; });

TEST(BothSimulators, AreComparedInEveryParameterThatMotorYamlHas) {
  for (const model::ActuatorParameter& parameter : model::actuator_parameters()) {
    const auto changes = [&](const Kind& kind) { return parameter.value(kind.actuator) != parameter.value({}); };
    EXPECT_TRUE(std::ranges::any_of(kinds(), changes)) << parameter.name;
  }
}

// The same 1e-6 rad, of a whole robot's joint. Without a motor.yaml its numbers are robot.yaml's, and friction is the
// actuator model's: MuJoCo's own moves a knee by up to a milliradian otherwise.
TEST(BothSimulators, MoveARobotsJointAlikeWithoutAMotorFile) {
  for (const char* name : {"left_knee", "left_ankle_roll", "head_pitch"}) {
    const int index = z1().joint_index.at(name);
    const model::Joint& joint = z1().joints[static_cast<std::size_t>(index)];
    sim::WorldOptions options;
    options.gantry = true;
    options.benched_joint = name;
    sim::World world(z1(), options);
    model::JointCommand command = standing_command(z1());
    model::RobotState state;
    const double middle_rad = std::max(joint.stand_rad, joint.lower_rad + 0.3);  // no stop is met
    command.q[index] = middle_rad;
    for (int step = 0; step < 1000; ++step) world.step(command);  // comes to rest

    const model::HangingLoad load = model::hanging_load(z1(), name);
    bench::Bench bench = test::pd_bench(true);
    bench.sample_rate_hz = 500.0;
    bench::BenchRun run;
    run.kp = joint.kp_Nm_per_rad, run.kd = joint.kd_Nm_s_per_rad;
    run.load = {load.inertia_kg_m2, load.gravity_Nm, load.hangs_at_rad};
    for (int step = 0; step < 1500; ++step) {
      const double t_s = 0.002 * step;
      world.read(state);
      command.q[index] = middle_rad + (t_s < 0.1 ? 0.0 : t_s < 1.5 ? 0.2 * std::sin(9.0 * (t_s - 0.1)) : 0.15);
      run.recording.t_s.push_back(t_s);
      run.recording.q_cmd_rad.push_back(command.q[index]);
      run.recording.q_rad.push_back(state.q[index]);
      run.recording.valid.push_back(true);
      world.step(command);
    }
    const calib::SingleJoint alone(bench, run, options.timestep_s);
    const std::vector<double> q_rad = alone.rollout({.actuator = sim::actuator_in_force(joint, {})});
    double worst_rad = 0.0, moved_rad = 0.0;
    for (std::size_t k = 0; k < q_rad.size(); ++k) {
      worst_rad = std::max(worst_rad, std::abs(q_rad[k] - run.recording.q_rad[k]));
      moved_rad = std::max(moved_rad, std::abs(q_rad[k] - q_rad[0]));
    }
    EXPECT_GT(moved_rad, 0.1) << name;
    EXPECT_LT(worst_rad, 1e-6) << name;
  }
}

}  // namespace
}  // namespace pmg
