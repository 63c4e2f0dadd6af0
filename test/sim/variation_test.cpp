#include "sim/variation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "files/config_error.hpp"
#include "refusal.hpp"
#include "robots.hpp"
#include "sim/world.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

using testing::HasSubstr;

double total_mass(sim::World& world) {
  double sum = 0.0;
  for (int body = 0; body < world.mj_model()->nbody; ++body) sum += world.mj_model()->body_mass[body];
  return sum;
}

int body(const sim::World& world, const std::string& name) {
  return mj_name2id(world.mj_model(), mjOBJ_BODY, name.c_str());
}

sim::WorldOptions drawn(std::uint64_t seed) {
  sim::WorldOptions options;
  sim::vary(options, sim::load_variation_ranges("training/randomization.yaml"), z1(), seed);
  return options;
}

TEST(Variation, NothingVariedIsTheModelToTheLastBit) {
  sim::WorldOptions written_out;
  written_out.variation.kp_factor = written_out.variation.kd_factor = JointVector::Ones(z1().joint_index.size());
  written_out.variation.encoder_offset_rad = JointVector::Zero(z1().joint_index.size());
  sim::World plain(z1(), {}), varied(z1(), written_out);
  const mjModel *a = plain.mj_model(), *b = varied.mj_model();
  for (int dof = 0; dof < a->nv; ++dof) ASSERT_EQ(a->dof_invweight0[dof], b->dof_invweight0[dof]);
  for (int step = 0; step < 200; ++step) {
    plain.step(standing_command(z1()));
    varied.step(standing_command(z1()));
  }
  for (int i = 0; i < a->nq; ++i) EXPECT_EQ(plain.mj_data()->qpos[i], varied.mj_data()->qpos[i]);
}

TEST(Variation, MassesAddUpAndPayloadIsInTheHands) {
  sim::World plain(z1(), {});
  sim::WorldOptions options;
  options.variation.torso_mass_kg = 2.0;
  options.variation.hand_payload_kg = {1.5, 0.5};
  options.variation.link_mass_factor["left_elbow_link"] = 1.5;
  sim::World world(z1(), options);
  const double elbow_kg = plain.mj_model()->body_mass[body(plain, "left_elbow_link")];
  EXPECT_NEAR(total_mass(world), total_mass(plain) + 2.0 + 1.5 + 0.5 + 0.5 * elbow_kg, 1e-9);
  EXPECT_NEAR(total_mass(plain), z1().total_mass_kg, 1e-9);
  const int hand = body(world, "left_wrist_pitch_link");
  EXPECT_NEAR(world.mj_model()->body_mass[hand], plain.mj_model()->body_mass[hand] + 1.5, 1e-12);
  const int base = body(world, z1().base_link);
  EXPECT_NEAR(world.mj_model()->body_subtreemass[base], total_mass(world), 1e-9) << "derived constants follow";
}

TEST(Variation, HandsAreWhatTheArmsEndIn) {
  EXPECT_THAT(sim::hand_links(z1()), testing::ElementsAre("left_wrist_pitch_link", "right_wrist_pitch_link"));
}

TEST(Variation, TheTorsosCentreOfMassMoves) {
  sim::WorldOptions options;
  options.variation.torso_center_of_mass_m = {0.02, -0.01, 0.03};
  sim::World plain(z1(), {}), world(z1(), options);
  const int torso = body(plain, z1().torso_link);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(world.mj_model()->body_ipos[3 * torso + axis] - plain.mj_model()->body_ipos[3 * torso + axis],
                options.variation.torso_center_of_mass_m[axis], 1e-12);
  }
}

TEST(Variation, FrictionIsThatOfTheSoleOnTheFloor) {
  sim::WorldOptions options;
  options.floor_friction = 0.4;
  sim::World world(z1(), options);
  world.step(standing_command(z1()));
  const mjData* data = world.mj_data();
  ASSERT_GT(data->ncon, 0);
  for (int c = 0; c < data->ncon; ++c) EXPECT_DOUBLE_EQ(data->contact[c].friction[0], 0.4);
}

TEST(Variation, ArmatureAndDryFrictionAreScaled) {
  const int n = z1().joint_index.size();
  sim::Variation variation;
  variation.armature_factor = JointVector::Constant(n, 1.3);
  variation.joint_friction_factor = JointVector::Constant(n, 0.5);
  model::ActuatorParameters nominal;
  nominal.transmission.armature_kg_m2 = 0.04;
  nominal.friction = {.viscous_Nm_s_per_rad = 0.3,
                      .coulomb_Nm = 0.6,
                      .stribeck_Nm = -0.2,
                      .load_driving = 0.1,
                      .load_backdriving = 0.08};
  const model::ActuatorParameters drawn = sim::varied(nominal, variation, 3);
  EXPECT_NEAR(drawn.transmission.armature_kg_m2, 0.052, 1e-12);
  EXPECT_NEAR(drawn.friction.coulomb_Nm, 0.3, 1e-12);
  EXPECT_NEAR(drawn.friction.stribeck_Nm, -0.1, 1e-12);
  EXPECT_NEAR(drawn.friction.load_driving, 0.05, 1e-12);
  EXPECT_NEAR(drawn.friction.load_backdriving, 0.04, 1e-12);
  EXPECT_EQ(drawn.friction.viscous_Nm_s_per_rad, 0.3);
  EXPECT_EQ(sim::varied(nominal, {}, 3), nominal);

  sim::WorldOptions options;
  options.variation = variation;
  sim::World world(z1(), options);
  for (const model::Joint& joint : z1().joints) {
    const int dof = world.mj_model()->jnt_dofadr[mj_name2id(world.mj_model(), mjOBJ_JOINT, joint.name.c_str())];
    EXPECT_NEAR(world.mj_model()->dof_armature[dof], 1.3 * joint.armature_kg_m2, 1e-12) << joint.name;
  }
}

/// Number of steps from a command to the first joint's torque, at rest in the air.
int steps_until_torque(double delay_s) {
  sim::WorldOptions options;
  options.variation.delay_s = delay_s;
  sim::World world(z1(), options);
  model::JointCommand command = standing_command(z1());
  command.kp.setZero();
  command.kd.setZero();
  command.tau_ff[0] = 5.0;
  model::RobotState state;
  for (int step = 1; step < 50; ++step) {
    world.step(command);
    world.read(state);
    if (std::abs(state.tau[0] - 5.0) < 1e-9) return step;
  }
  return -1;
}

TEST(Variation, DelayIsSoManyWholeSteps) {
  EXPECT_EQ(steps_until_torque(0.0), 1);
  EXPECT_EQ(steps_until_torque(0.002), 2);
  EXPECT_EQ(steps_until_torque(0.02), 11);
  EXPECT_EQ(steps_until_torque(0.0209), 11) << "rounded";
}

TEST(Variation, DelayedCommandsComeInTheirOrderAndNotBeforeReset) {
  sim::WorldOptions options;
  options.variation.delay_s = 0.006;
  sim::World world(z1(), options);
  model::JointCommand command = standing_command(z1());
  command.kp.setZero();
  command.kd.setZero();
  model::RobotState state;
  const auto torques = [&] {
    std::vector<double> seen;
    for (int step = 1; step <= 6; ++step) {
      command.tau_ff[0] = step;
      world.step(command);
      world.read(state);
      seen.push_back(state.tau[0]);
    }
    return seen;
  };
  EXPECT_THAT(torques(), testing::ElementsAre(0, 0, 0, 1, 2, 3));
  world.reset();
  EXPECT_THAT(torques(), testing::ElementsAre(0, 0, 0, 1, 2, 3)) << "nothing is left underway";
}

TEST(Variation, DrivesGoByTheirEncodersAndTheirOwnGains) {
  const int n = z1().joint_index.size();
  sim::WorldOptions options;
  options.variation.encoder_offset_rad = JointVector::Constant(n, 0.01);
  options.variation.kp_factor = JointVector::Constant(n, 1.1);
  sim::World world(z1(), options);
  model::RobotState before, after;
  world.read(before);
  EXPECT_NEAR(before.q[0], z1().q_stand()[0] + 0.01, 1e-12) << "measured with the offset";
  world.step(standing_command(z1()));
  world.read(after);
  EXPECT_NEAR(after.tau[0], -1.1 * z1().joints[0].kp_Nm_per_rad * 0.01, 1e-9) << "and driven by what is measured";
}

TEST(Variation, MeasuredVelocitiesCarryTheirNoise) {
  sim::WorldOptions options;
  options.velocity_noise_rad_s = 0.1;
  options.gantry = true;
  sim::World world(z1(), options);
  model::RobotState state;
  double squares = 0.0;
  int count = 0;
  for (int step = 0; step < 400; ++step) {
    world.step(standing_command(z1()));
    world.read(state);
    const int dof =
        world.mj_model()->jnt_dofadr[mj_name2id(world.mj_model(), mjOBJ_JOINT, z1().joints[0].name.c_str())];
    const double noise = state.dq[0] - world.mj_data()->qvel[dof];
    squares += noise * noise;
    ++count;
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.1, 0.015) << "four standard errors of 400 samples";
}

TEST(Variation, SameSeedSameRobotAndOtherSeedAnother) {
  const sim::WorldOptions a = drawn(3), b = drawn(3), c = drawn(4);
  EXPECT_EQ(a.floor_friction, b.floor_friction);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.variation.link_mass_factor, b.variation.link_mass_factor);
  EXPECT_EQ(a.variation.encoder_offset_rad, b.variation.encoder_offset_rad);
  EXPECT_NE(a.floor_friction, c.floor_friction);
  EXPECT_NE(a.seed, c.seed);
}

TEST(Variation, DrawsFillTheirRangesAndStayInside) {
  double least = 1e9, most = -1e9;
  int payloads = 0;
  constexpr int kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const sim::WorldOptions options = drawn(seed);
    least = std::min(least, options.floor_friction);
    most = std::max(most, options.floor_friction);
    payloads += options.variation.hand_payload_kg[kLeft] > 0.0 ? 1 : 0;
    EXPECT_LE(options.variation.encoder_offset_rad.cwiseAbs().maxCoeff(), 0.015);
    EXPECT_GE(options.variation.delay_s, 0.0);
    EXPECT_LE(options.variation.delay_s, 0.02);
    for (const auto& [link, factor] : options.variation.link_mass_factor) EXPECT_NEAR(factor, 1.0, 0.07) << link;
  }
  EXPECT_GE(least, 0.4);
  EXPECT_LE(most, 1.2);
  EXPECT_LT(least, 0.45);
  EXPECT_GT(most, 1.15);
  EXPECT_NEAR(payloads, kSeeds / 2.0, 4 * std::sqrt(kSeeds / 4.0));
}

TEST(Variation, WhatTheRangesDontNameIsAsTheModelSays) {
  sim::WorldOptions options;
  sim::vary(options, {}, z1(), 5);
  EXPECT_EQ(options.floor_friction, 0.8);
  EXPECT_EQ(options.variation.kp_factor, JointVector::Ones(z1().joint_index.size()));
  EXPECT_EQ(options.variation.delay_s, 0.0);
  EXPECT_EQ(options.gyro_noise_rad_s, 0.0);
}

class RangesFile : public testing::Test {
 protected:
  std::string refusal(const std::string& yaml) {
    std::ofstream(file_) << yaml;
    return test::refusal_by<files::ConfigError>([&] { sim::load_variation_ranges(file_); });
  }
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.file("ranges.yaml");
};

TEST_F(RangesFile, WhatIsWrongIsNamedWithItsPlace) {
  EXPECT_EQ(refusal("friction: [0.4, 1.2]\n"), "taken");
  EXPECT_THAT(refusal("friction: [1.2, 0.4]\n"), HasSubstr("friction"));
  EXPECT_THAT(refusal("friction: [0.4]\n"), HasSubstr("friction"));
  EXPECT_THAT(refusal("friction: [-0.4, 1.2]\n"), HasSubstr("friction"));
  EXPECT_THAT(refusal("payload_share: 1.5\n"), HasSubstr("payload_share"));
  EXPECT_THAT(refusal("delay_s: [0, 5]\n"), HasSubstr("delay_s"));
  EXPECT_THAT(refusal("noise: {q_rads: 0.1}\n"), HasSubstr("q_rads"));
  EXPECT_THAT(refusal("frcition: [0.4, 1.2]\n"), HasSubstr("frcition"));
  EXPECT_THAT(refusal("frcition: [0.4, 1.2]\n"), HasSubstr(":1:"));
}

TEST(Variation, WhatARobotDoesntHaveIsRefused) {
  sim::WorldOptions options;
  options.variation.link_mass_factor["third_leg"] = 1.1;
  EXPECT_THROW(sim::World(z1(), options), std::invalid_argument);
  options = {};
  options.variation.kp_factor = JointVector::Ones(3);
  EXPECT_THROW(sim::World(z1(), options), std::invalid_argument);
  options = {};
  options.variation.torso_mass_kg = -1000.0;
  EXPECT_THROW(sim::World(z1(), options), std::invalid_argument);
}

}  // namespace
}  // namespace pmg
