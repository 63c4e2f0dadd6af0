// From an excitation over a simulated robot's recording to the motor that was in it: the executables as a user runs
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/running_program.hpp"
#include "sim/motor_file.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RobotBench : public testing::Test {
 protected:
  RobotBench() { fs::create_directories(folder_); }
  ~RobotBench() override { fs::remove_all(folder_); }

  int run(const std::string& program, const std::vector<std::string>& arguments) {
    test::RunningProgram running(program, arguments, folder_);
    const int code = running.wait();
    err_ = running.err();
    return code;
  }
  std::string at(const char* name) const { return (folder_ / name).string(); }
  void excitation(const char* joint) {
    ASSERT_EQ(run("pmg_calibrate_motor", {"--make-excitation", "--robot", "z1", "--joint", joint, "--seconds", "5",
                                          "--repeats", "1", "--out", at("excitation")}),
              0)
        << err_;
  }

  const fs::path folder_ = fs::path(testing::TempDir()) /
                           ("bench " + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  std::string err_;
};

/// A joint, and what is hidden in its motor.
struct Hidden {
  const char* joint;
  double kp_scale, kd_scale, armature_kg_m2, viscous_Nm_s_per_rad, coulomb_Nm;
};

class KnownMotor : public RobotBench, public testing::WithParamInterface<Hidden> {};

// Neighbours and base are clamped, so that a joint in the middle of a leg is told as well as one at the end of the
// trunk. Tolerances are those of a calibration that is worth its name, 5 %, and 2 % for gains.
TEST_P(KnownMotor, IsFoundAgainFromItsRecording) {
  const Hidden hidden = GetParam();
  excitation(hidden.joint);
  sim::ActuatorParameters truth;
  truth.drive.kp_scale = hidden.kp_scale, truth.drive.kd_scale = hidden.kd_scale;
  truth.transmission.armature_kg_m2 = hidden.armature_kg_m2;
  truth.friction.viscous_Nm_s_per_rad = hidden.viscous_Nm_s_per_rad;
  truth.friction.coulomb_Nm = hidden.coulomb_Nm;
  std::ofstream(at("motor.yaml")) << sim::motor_yaml({{hidden.joint, truth}});
  ASSERT_EQ(run("pmg_sil", {"--robot", "z1", "--bench", hidden.joint, "--excitation", at("excitation"), "--motor",
                            at("motor.yaml"), "--out", at("recorded")}),
            0)
      << err_;
  ASSERT_EQ(run("pmg_calibrate_motor", {at("recorded"), "--also", "friction", "damping", "--starts", "3", "--threads",
                                        "2", "--out", at("fit")}),
            0)
      << err_;
  const sim::ActuatorsByJoint motors = sim::read_motor_file(at("fit/motor.yaml"));
  ASSERT_TRUE(motors.contains(hidden.joint)) << "as bench.yaml says";
  const sim::ActuatorParameters& found = motors.at(hidden.joint);
  EXPECT_NEAR(found.drive.kp_scale / hidden.kp_scale, 1.0, 0.02);
  EXPECT_NEAR(found.drive.kd_scale / hidden.kd_scale, 1.0, 0.02);
  EXPECT_NEAR(found.transmission.armature_kg_m2 / hidden.armature_kg_m2, 1.0, 0.05);
  EXPECT_NEAR(found.friction.coulomb_Nm / hidden.coulomb_Nm, 1.0, 0.05);
  EXPECT_NEAR(found.friction.viscous_Nm_s_per_rad / hidden.viscous_Nm_s_per_rad, 1.0, 0.05);
}

INSTANTIATE_TEST_SUITE_P(OfALimb, KnownMotor,
                         testing::Values(Hidden{"head_pitch", 0.85, 1.2, 0.012, 0.15, 0.15},
                                         Hidden{"left_knee", 0.85, 1.2, 0.055, 1.0, 2.0}),
                         [](const auto& hidden) { return hidden.param.joint; });

TEST_F(RobotBench, WritesNothingForBadInput) {
  excitation("left_elbow");
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--robot", "z1", "--out", at("recorded")});
    EXPECT_EQ(run("pmg_sil", arguments), 2);
    EXPECT_FALSE(fs::exists(at("recorded")));
    return err_;
  };
  EXPECT_THAT(refused({"--bench", "tail", "--excitation", at("excitation")}), HasSubstr("tail"));
  EXPECT_THAT(refused({"--bench", "left_elbow", "--excitation", at("nowhere")}), HasSubstr("nowhere"));
  EXPECT_THAT(refused({"--bench", "left_elbow"}), HasSubstr("--excitation"));
  EXPECT_THAT(refused({"--bench", "left_knee", "--excitation", at("excitation")}), HasSubstr("left_knee"))
      << "the elbow's angles";
  EXPECT_EQ(run("pmg_calibrate_motor",
                {"--make-excitation", "--angle", "1:0", "--speed", "1", "--gains", "20,1", "--out", at("recorded")}),
            2);
  EXPECT_FALSE(fs::exists(at("recorded")));
}

}  // namespace
}  // namespace pmg
