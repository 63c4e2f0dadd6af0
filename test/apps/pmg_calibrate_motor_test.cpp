// pmg_calibrate_motor, used as by its users: results, exit codes, messages, and no half-written files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/running_program.hpp"
#include "calib/synthetic_bench.hpp"
#include "calib/unknown.hpp"
#include "effects/fit_words.hpp"
#include "recorded_benches.hpp"
#include "sim/motor_file.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class PmgCalibrateMotor : public testing::Test {
 protected:
  PmgCalibrateMotor() {
    truth_.actuator.drive.kp_scale = 0.8;
    truth_.actuator.drive.kd_scale = 1.3;
    truth_.actuator.transmission.armature_kg_m2 = 0.03;
    truth_.actuator.friction.coulomb_Nm = 0.3;
    test::write_bench(folder_ / "servo", test::record(test::pd_bench(true), truth_, 4, 1e-3));
  }

  test::Finished run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), (folder_ / "servo").string());
    arguments.insert(arguments.end(), {"--out", out_.string(), "--threads", "2"});
    test::RunningProgram program("pmg_calibrate_motor", arguments, folder_);
    return program.finish();
  }
  calib::JointModel truth_;
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("a calibration");
  const fs::path out_ = folder_ / "out";
};

TEST_F(PmgCalibrateMotor, WritesAMotorThatTheSimulationReads) {
  const test::Finished done = run({"--also", "coulomb", "--fit", "kp_Nm_per_rad > 0 and file != run3.csv", "--score",
                                   "file == run3.csv", "--json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out);
  EXPECT_EQ(json, nlohmann::json::parse(test::text_of(out_ / "fit.json")));
  EXPECT_EQ(json["fit"]["runs"], 3);
  EXPECT_EQ(json["score"]["runs"], 1);
  EXPECT_LT(json["score"]["error_after"]["mean_absolute"], 0.002) << "the noise alone makes 0.8 mrad";
  const sim::ActuatorsByJoint motors = sim::read_motor_file(out_ / "motor.yaml");
  const model::ActuatorParameters& found = motors.at("servo");
  EXPECT_NEAR(found.drive.kp_scale, 0.8, 0.03);
  EXPECT_NEAR(found.friction.coulomb_Nm, 0.3, 0.02);
  EXPECT_EQ(found.friction.coulomb_Nm, json["parameters"]["friction.coulomb_Nm"]["value"]);
  EXPECT_THAT(test::text_of(out_ / "report.html"),
              AllOf(testing::StartsWith("<!doctype html>"), HasSubstr("the usual run")));
}

TEST_F(PmgCalibrateMotor, RefusesBadInputInOneLineAndWritesNothing) {
  const std::vector<std::pair<std::vector<std::string>, const char*>> bad = {
      {{"--fit", "repeat == 9"}, "no run matches"},
      {{"--fit", "kp ~ 3"}, "isn't a relation"},
      {{"--score", "repeat == 0"}, "both in --fit and in --score"},
      {{"--also", "magic"}, "isn't an effect"},
      {{"--set", "friction.coulomb_Nm=some"}, "isn't a number"},
      {{"--set", "friction.colour=1"}, "no actuator parameter"},
      {{"--range", "friction.coulomb_Nm=0:1"}, "that is fitted"},
      {{"--range", "drive.kp_scale=2:1"}, "expected LOWER below UPPER"},
      {{"--set", "armature=1"}, "did you mean transmission.armature_kg_m2?"},
      {{"--only"}, "nothing to fit"},
  };
  for (const auto& [arguments, message] : bad) {
    const test::Finished done = run(arguments);
    EXPECT_EQ(done.exit_code, 2) << message;
    EXPECT_THAT(done.err, HasSubstr(message));
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
    EXPECT_FALSE(fs::exists(out_));
  }
  fs::remove(folder_ / "servo" / "runs" / "run2.csv");
  const test::Finished done = run({});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, AllOf(HasSubstr("run2.csv"), HasSubstr("there is no such file")));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(PmgCalibrateMotor, KeepsWhatItHasWhenInterrupted) {
  test::RunningProgram program("pmg_calibrate_motor",
                               {(folder_ / "servo").string(), "--also", "coulomb", "delay", "--starts", "1000", "--out",
                                out_.string(), "--threads", "1"},
                               folder_);
  // Its handler is installed before it reads; earlier, SIGINT would end it like any program.
  const fs::path signals = fs::path("/proc") / std::to_string(program.id()) / "status";
  ASSERT_TRUE(program.until([&] {
    const std::string status = test::text_of(signals);
    const std::size_t at = status.find("SigCgt:");
    return at != std::string::npos && (std::stoull(status.substr(at + 8), nullptr, 16) & (1ULL << (SIGINT - 1))) != 0;
  }));
  program.send(SIGINT);
  const int exit_code = program.wait();
  if (!fs::exists(out_)) {  // it was still reading
    EXPECT_EQ(exit_code, 130);
    return;
  }
  EXPECT_EQ(exit_code, 130);
  EXPECT_EQ(nlohmann::json::parse(test::text_of(out_ / "fit.json"))["interrupted"], true);
  EXPECT_NO_THROW(sim::read_motor_file(out_ / "motor.yaml"));
}

TEST_F(PmgCalibrateMotor, RefusesDegreesByNameAndKeptTheyAreOffTheirData) {
  std::vector<calib::SingleJoint> degrees;
  const bench::Bench bench = test::pd_bench(true);
  for (const calib::SingleJoint& joint : test::record(bench, truth_, 4, 1e-3)) {
    bench::BenchRun run = joint.run();
    for (double& q : run.recording.q_rad) q *= 57.29578;
    for (double& q : run.recording.q_cmd_rad) q *= 57.29578;
    degrees.emplace_back(bench, run, joint.step_s());
  }
  fs::remove_all(folder_ / "servo");
  test::write_bench(folder_ / "servo", degrees);
  const test::Finished refused = run({"--also", "coulomb"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("unit: column q_rad"), HasSubstr("degrees"), HasSubstr("--data-faults correct")));
  EXPECT_FALSE(fs::exists(out_)) << "nothing is fitted";
  const test::Finished kept = run({"--also", "coulomb", "--starts", "2", "--data-faults", "keep"});
  EXPECT_EQ(kept.exit_code, 1);
  EXPECT_THAT(kept.out, testing::StartsWith("OFF ITS DATA: fault of the data, unit"));
  EXPECT_THAT(test::text_of(out_ / "motor.yaml"), testing::StartsWith("# OFF ITS DATA: "));
  EXPECT_THAT(test::text_of(out_ / "report.html"), testing::Not(HasSubstr("class=\"verdict good\"")));
  const test::Finished corrected =
      run({"--also", "coulomb", "--starts", "2", "--data-faults", "correct", "--overwrite"});
  EXPECT_EQ(corrected.exit_code, 0) << corrected.out;
  EXPECT_NEAR(sim::read_motor_file(out_ / "motor.yaml").at("servo").friction.coulomb_Nm, 0.3, 0.03);
}

TEST_F(PmgCalibrateMotor, FitsTheLoadThatBenchYamlCallsUnknown) {
  std::string yaml = test::text_of(folder_ / "servo" / "bench.yaml");
  for (const std::string key : {"inertia_kg_m2: ", "gravity_Nm: "}) {
    for (std::size_t at = yaml.find(key); at != std::string::npos; at = yaml.find(key, at + 1))
      yaml.replace(at + key.size(), yaml.find_first_of(",}", at) - at - key.size(), "unknown");
  }
  std::ofstream(folder_ / "servo" / "bench.yaml") << yaml;
  run({"--also", "coulomb", "--starts", "2"});
  const auto json = nlohmann::json::parse(test::text_of(out_ / "fit.json"));
  for (const char* name : {"load.inertia_scale", "load.gravity_scale"}) {
    ASSERT_TRUE(json["parameters"].contains(name)) << name;
    EXPECT_TRUE(json["parameters"][name]["deviation"].is_null()) << "all torques may be larger by one factor";
  }
  EXPECT_THAT(test::text_of(out_ / "motor.yaml"), HasSubstr("these runs don't determine"));
}

TEST_F(PmgCalibrateMotor, SaysTodaysWordForAnEarlierOne) {
  const test::Finished done = run({"--also", "friction", "--starts", "2"});
  EXPECT_EQ(done.exit_code, 0) << done.out;
  EXPECT_THAT(done.err, HasSubstr("--also friction: the word is coulomb now"));
  EXPECT_NEAR(sim::read_motor_file(out_ / "motor.yaml").at("servo").friction.coulomb_Nm, 0.3, 0.03);
}

TEST_F(PmgCalibrateMotor, ExplainsItself) {
  test::RunningProgram program("pmg_calibrate_motor", {"--help"}, folder_);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.out(), AllOf(HasSubstr("Example:"), HasSubstr("Exit codes:")));
  for (const std::string& word : effects::fit_words()) EXPECT_THAT(program.out(), HasSubstr(word));
}

// Janot, Gautier, Brunot 2019 publish M 95.1 kg, Fv 203.5 N s/m, Fc 20.4 N. Rollouts of the closed loop alone are 8 %
// off in the inertia, because they can't separate it from a lag of the drive's velocity.
TEST_F(PmgCalibrateMotor, AnswersWithThePublishedParametersWhereTheDriveWasRecorded) {
  PMG_NEEDS_BENCH("emps");
  test::RunningProgram program(
      "pmg_calibrate_motor",
      {test::recorded_bench("emps").string(), "--joint", "axis", "--out", out_.string(), "--threads", "2"}, folder_);
  ASSERT_EQ(program.wait(), 0) << program.err();
  const model::ActuatorParameters found = sim::read_motor_file(out_ / "motor.yaml").at("axis");
  EXPECT_NEAR(found.transmission.armature_kg_m2 / 95.1, 1.0, 0.03);
  EXPECT_NEAR(found.friction.viscous_Nm_s_per_rad / 203.5, 1.0, 0.03);
  EXPECT_NEAR(found.friction.coulomb_Nm / 20.4, 1.0, 0.03);
  const auto json = nlohmann::json::parse(test::text_of(out_ / "fit.json"));
  EXPECT_TRUE(json["inverse_dynamics"]["taken"]);
  EXPECT_GT(json["inverse_dynamics"]["coulomb_backward_Nm"],
            1.3 * json["inverse_dynamics"]["coulomb_forward_Nm"].get<double>());
  EXPECT_LT(json["fit"]["error_after"]["mean_absolute"], 2e-6) << "and the closed loop moves as it did, to micrometres";
}

}  // namespace
}  // namespace pmg
