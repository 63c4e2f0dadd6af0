// What is hidden in a simulated robot is found from its logs alone.
#include "robot_diagnosis/robot_diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "excitation/robot_excitation.hpp"
#include "model/clip_library_file.hpp"
#include "robot_diagnosis/hidden_robot.hpp"
#include "robot_diagnosis/robot_report.hpp"
#include "sim/robots.hpp"
#include "temporary_folder.hpp"

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
  const std::vector<model::JointCommand> hold(300, excitation::hanging_excitation(z1()).front());
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
  for (const auto& commands : {excitation::hanging_excitation(z1()), excitation::standing_excitation(z1(), clips)}) {
    for (const model::JointCommand& command : commands) {
      ASSERT_TRUE(((command.q - z1().q_lower()).array() >= 0.0).all());
      ASSERT_TRUE(((z1().q_upper() - command.q).array() >= 0.0).all());
    }
  }
}

TEST(RobotDiagnosis, DrivesWithTheirOwnGainsAreExcitedWithTheseAlone) {
  const int elbow = z1().joint_index.at("left_elbow"), knee = z1().joint_index.at("left_knee");
  const std::vector<std::string> own = {"left_elbow"};
  const std::vector<model::JointCommand> told = excitation::hanging_excitation(z1(), own),
                                         others = excitation::hanging_excitation(z1());
  bool knee_changes = false;
  for (std::size_t k = 0; k < told.size(); ++k) {
    ASSERT_EQ(told[k].kp[elbow], told.front().kp[elbow]);
    ASSERT_EQ(told[k].kd[elbow], told.front().kd[elbow]);
    ASSERT_EQ(told[k].dq[elbow], 0.0);
    ASSERT_EQ(told[k].q, others[k].q);
    knee_changes = knee_changes || told[k].kp[knee] != told.front().kp[knee];
  }
  EXPECT_TRUE(knee_changes);
}

TEST(RobotDiagnosis, ALogReadsBackAsItWasRecorded) {
  sim::World world(z1(), {});
  const std::vector<model::JointCommand> hold(150, standing_command(z1()));
  RobotRecording recording = play(world, hold, "stand");
  EXPECT_EQ(recording.drive.step_s, 0.002) << "of the simulated drives";
  recording.drive.step_s = 0.001;  // of another robot's drives
  recording.drive.command_delay_s = 0.002;
  recording.drive.older_joints = {3, 5};
  recording.drive.older_imu = true;
  recording.drive.older_by_s = 0.004;
  recording.drive.closed_by_bus = {7};
  recording.drive.bus_loop_age_s = 0.003;
  const test::TemporaryFolder folder;
  const auto file = folder.file("stand.lcm");
  write_robot_log(recording, z1(), file);
  const std::vector<RobotRecording> read = read_robot_logs({file}, z1());
  ASSERT_EQ(read.size(), 1U);
  ASSERT_EQ(read.front().ticks.size(), recording.ticks.size());
  const DriveSampling& drive = read.front().drive;
  EXPECT_EQ(drive.step_s, 0.001);
  EXPECT_EQ(drive.command_delay_s, 0.002);
  EXPECT_EQ(drive.older_joints, recording.drive.older_joints);
  EXPECT_TRUE(drive.older_imu);
  EXPECT_EQ(drive.older_by_s, 0.004);
  EXPECT_EQ(drive.closed_by_bus, recording.drive.closed_by_bus);
  EXPECT_EQ(drive.bus_loop_age_s, 0.003);
  for (std::size_t k = 0; k < recording.ticks.size(); ++k) {
    EXPECT_EQ(read.front().ticks[k].state.q, recording.ticks[k].state.q);
    EXPECT_EQ(read.front().ticks[k].command.kp, recording.ticks[k].command.kp);
  }
}

TEST(RobotDiagnosis, SaysOfEachLogWhetherASimulationMadeItAndWhatWasSetThere) {
  EXPECT_NE(source_text(recording_source("can", R"({"drive_sampling_s": 0})")).find("hardware (backend can): nothing"),
            std::string::npos);
  EXPECT_NE(source_text(recording_source("sil", "{}")).find("doesn't say what was set"), std::string::npos);
  EXPECT_NE(source_text(recording_source("sil", R"({"set_on_simulator": []})")).find("nothing was set"),
            std::string::npos);
  EXPECT_NE(source_text(recording_source("", "not JSON")).find("unknown"), std::string::npos);
  RobotDiagnosis found;
  found.recordings = {"hanging: hardware (backend can)"};
  EXPECT_NE(robot_diagnosis_page("z1", found).html().find("hanging: hardware (backend can)"), std::string::npos);
}

TEST(RobotDiagnosis, WhatWasSetOnTheSimulatorIsInTheLog) {
  HiddenRobot hidden = healthy();
  hidden.options.motors["left_knee"].friction.coulomb_Nm = 2.5;
  hidden.options.variation.hand_payload_kg[kLeft] = 1.5;
  sim::World world(hidden.robot, hidden.options);
  const std::vector<model::JointCommand> hold(150, excitation::hanging_excitation(z1()).front());
  const test::TemporaryFolder folder;
  const auto file = folder.file("set.lcm");
  write_robot_log(play(world, hold, "stand"), z1(), file);
  const std::string text = source_text(read_robot_logs({file}, z1()).front().source);
  EXPECT_NE(text.find("left_knee: friction.coulomb_Nm = 2.5 Nm, without it 0.6"), std::string::npos) << text;
  EXPECT_NE(text.find("payload of the left hand = 1.5 kg"), std::string::npos) << text;
  EXPECT_EQ(text.find("right_knee"), std::string::npos) << text;
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
  const test::TemporaryFolder folder;
  const auto file = folder.file("biped.lcm");
  write_robot_log(play(world, hold, "stand"), biped(), file);
  EXPECT_THROW(read_robot_logs({file}, z1()), std::runtime_error);
}

}  // namespace
}  // namespace pmg::robot_diagnosis
