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

// The neck's joint moves 2 kg on a trunk that gives way by fractions of a milliradian; limbs on springy joints are told
// less well. Tolerances are twice what was found (0.2 %, 0.1 %, 7 %, 3 %, and 1 % of all damping).
TEST_F(RobotBench, RecordsAJointWhoseMotorCalibrationFindsAgain) {
  excitation("head_pitch");
  sim::ActuatorParameters truth;
  truth.drive.kp_scale = 0.85, truth.drive.kd_scale = 1.2;
  truth.transmission.armature_kg_m2 = 0.012;
  truth.friction.viscous_Nm_s_per_rad = 0.05, truth.friction.coulomb_Nm = 0.15;
  std::ofstream(at("motor.yaml")) << sim::motor_yaml({{"head_pitch", truth}});
  ASSERT_EQ(run("pmg_sil", {"--robot", "z1", "--bench", "head_pitch", "--excitation", at("excitation"), "--motor",
                            at("motor.yaml"), "--out", at("recorded")}),
            0)
      << err_;
  ASSERT_EQ(run("pmg_calibrate_motor", {at("recorded"), "--also", "friction", "damping", "--starts", "3", "--threads",
                                        "2", "--out", at("fit")}),
            0)
      << err_;
  const sim::ActuatorsByJoint motors = sim::read_motor_file(at("fit/motor.yaml"));
  ASSERT_TRUE(motors.contains("head_pitch")) << "as bench.yaml says";
  const sim::ActuatorParameters& found = motors.at("head_pitch");
  EXPECT_NEAR(found.drive.kp_scale, 0.85, 0.02 * 0.85);
  EXPECT_NEAR(found.drive.kd_scale, 1.2, 0.03 * 1.2);
  EXPECT_NEAR(found.transmission.armature_kg_m2, 0.012, 0.15 * 0.012);
  EXPECT_NEAR(found.friction.coulomb_Nm, 0.15, 0.08 * 0.15);
  constexpr double kKd = 0.8;  // of head_pitch: friction beside it
  EXPECT_NEAR(found.drive.kd_scale * kKd + found.friction.viscous_Nm_s_per_rad, 1.2 * kKd + 0.05, 0.03);
}

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
