// What is hidden in a simulated robot is found from its logs alone.
#include "robot_diagnosis/robot_diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/clip_library_file.hpp"
#include "robot_diagnosis/hidden_robot.hpp"
#include "robot_diagnosis/robot_excitation.hpp"
#include "robot_diagnosis/robot_report.hpp"
#include "sim/robots.hpp"

namespace pmg::robot_diagnosis {
namespace {

HiddenRobot healthy() {
  HiddenRobot robot{.hidden = {}, .robot = z1(), .options = {}};
  robot.options.seed = 3;
  robot.options.gyro_noise_rad_s = 0.01;
  robot.options.encoder_noise_rad = 0.0004;
  robot.options.orientation_noise_rad = 0.002;
  return robot;
}

RobotDiagnosis diagnosed(const HiddenRobot& hidden) {
  const std::vector<RobotRecording> recordings = record_hidden(hidden);
  return diagnose_robot(z1(), recordings);
}

/// Robots with noise and everything a little off, one thing wrong or nothing; the nightly campaign has a hundred.
class HiddenRobots : public testing::TestWithParam<unsigned> {};

TEST_P(HiddenRobots, TheOneThingThatIsWrongIsNamedAndNothingElse) {
  const HiddenRobot hidden = hide(z1(), GetParam());
  const RobotDiagnosis d = diagnosed(hidden);
  EXPECT_TRUE(named_right(hidden.hidden, d)) << hidden.hidden.effect << " of " << hidden.hidden.place << "\n"
                                             << robot_diagnosis_text(d);
  EXPECT_GT(d.coverage.hanging_s, 25.0);
  EXPECT_GT(d.coverage.standing_s, 30.0);
}

// nothing, a payload on the torso, one in a hand, an IMU askew, a joint's armature
INSTANTIATE_TEST_SUITE_P(OfEveryKind, HiddenRobots, testing::Values(0U, 2U, 3U, 5U, 8U));

TEST(RobotDiagnosis, FindsTheJointWhoseGearHoldsTooFirmly) {
  HiddenRobot hidden = healthy();
  hidden.options.variation.joint_friction_factor = JointVector::Ones(z1().joint_index.size());
  hidden.options.variation.joint_friction_factor[z1().joint_index.at("left_elbow")] = 3.0;
  const RobotDiagnosis d = diagnosed(hidden);
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes.front().effect, "coulomb") << robot_diagnosis_text(d);
  EXPECT_EQ(d.causes.front().place, "left_elbow");
  EXPECT_NEAR(d.causes.front().parameters.front().estimate.value, 0.4, 0.1);  // Nm; 0.2 Nm is the joint's own
}

TEST(RobotDiagnosis, GravityTorquesOfAHangingRobotAreThoseThatMuJoCoHolds) {
  // At rest the equations hold with nothing but gravity: no residual beyond dry friction.
  RobotParameterList none;
  RobotEquations equations(z1(), none);
  HiddenRobot hidden{.hidden = {}, .robot = z1(), .options = {}};
  hidden.options.gantry = true;
  sim::World world(hidden.robot, hidden.options);
  const std::vector<model::JointCommand> hold(300, hanging_excitation(z1()).front());
  const std::vector<RobotSample> samples = robot_samples(play(world, hold, "hold"));
  const RobotSample& last = samples.back();
  ASSERT_EQ(equations.support(last), Support::kHanging);
  for (const RobotRow& row : equations.rows(last, Support::kHanging)) {
    EXPECT_LE(std::abs(row.residual), z1().joints[static_cast<std::size_t>(row.kind)].friction_Nm + 0.05)
        << equations.kind_name(row.kind);
  }
}

TEST(RobotDiagnosis, ExcitationsStayInsideJointLimits) {
  const ClipLibrary clips = model::load_clip_library(z1().directory / "clips", z1());
  for (const auto& commands : {hanging_excitation(z1()), standing_excitation(z1(), clips)}) {
    for (const model::JointCommand& command : commands) {
      ASSERT_TRUE(((command.q - z1().q_lower()).array() >= 0.0).all());
      ASSERT_TRUE(((z1().q_upper() - command.q).array() >= 0.0).all());
    }
  }
}

TEST(RobotDiagnosis, ALogReadsBackAsItWasRecorded) {
  sim::World world(z1(), {});
  const std::vector<model::JointCommand> hold(150, standing_command(z1()));
  RobotRecording recording = play(world, hold, "stand");
  EXPECT_EQ(recording.drive.step_s, 0.002) << "of the simulated drives";
  recording.drive.step_s = 0.001;  // of another robot's drives
  const auto file = std::filesystem::path(testing::TempDir()) / "robot_diagnosis_stand.lcm";
  write_robot_log(recording, z1(), file);
  const std::vector<RobotRecording> read = read_robot_logs({file}, z1());
  ASSERT_EQ(read.size(), 1U);
  ASSERT_EQ(read.front().ticks.size(), recording.ticks.size());
  EXPECT_EQ(read.front().drive.step_s, 0.001);
  for (std::size_t k = 0; k < recording.ticks.size(); ++k) {
    EXPECT_EQ(read.front().ticks[k].state.q, recording.ticks[k].state.q);
    EXPECT_EQ(read.front().ticks[k].command.kp, recording.ticks[k].command.kp);
  }
  std::filesystem::remove(file);
}

TEST(RobotDiagnosis, AnInterruptedRecordingOrDiagnosisEndsAsInterrupted) {
  sim::World world(z1(), {});
  const std::vector<model::JointCommand> hold(150, standing_command(z1()));
  const work::Progress stop{.interrupted = [] { return true; }};
  EXPECT_THROW(play(world, hold, "stand", stop), work::Interrupted);
  const std::vector<RobotRecording> recordings{play(world, hold, "stand")};
  EXPECT_THROW(diagnose_robot(z1(), recordings, {}, stop), work::Interrupted);
}

TEST(RobotDiagnosis, ALogOfAnotherRobotIsRefused) {
  sim::World world(biped(), {});
  const std::vector<model::JointCommand> hold(150, standing_command(biped()));
  const auto file = std::filesystem::path(testing::TempDir()) / "robot_diagnosis_biped.lcm";
  write_robot_log(play(world, hold, "stand"), biped(), file);
  EXPECT_THROW(read_robot_logs({file}, z1()), std::runtime_error);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace pmg::robot_diagnosis
