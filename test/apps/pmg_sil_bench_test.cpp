// From an excitation over a simulated robot's recording to its motor: the executables as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/running_program.hpp"
#include "folders.hpp"
#include "sim/motors_in_force.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RobotBench : public testing::Test {
 protected:
  RobotBench() { fs::create_directories(folder_); }

  int run(const std::string& program, const std::vector<std::string>& arguments) {
    test::RunningProgram running(program, arguments, folder_);
    const int code = running.wait();
    out_ = running.out();
    err_ = running.err();
    return code;
  }
  std::string at(const char* name) const { return (folder_ / name).string(); }
  void excitation(const char* joint, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--make-excitation", "--robot", "z1",    "--joint",       joint,
                                          "--seconds",         "5",       "--out", at("excitation")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(run("pmg_calibrate_motor", arguments), 0) << err_;
  }

  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("a bench");
  std::string out_, err_;
};

/// A joint, and its motor in the simulation: a motor.yaml's, or robot.yaml's alone.
struct Known {
  const char* joint;
  model::ActuatorParameters of_motor_yaml;  // neutral: no motor.yaml
  std::vector<std::string> excitation;      // options of --make-excitation
};
std::ostream& operator<<(std::ostream& out, const Known& known) { return out << known.joint; }

model::ActuatorParameters motor(double kp_scale, double kd_scale, double armature_kg_m2, double viscous,
                                double coulomb) {
  model::ActuatorParameters p;
  p.drive.kp_scale = kp_scale, p.drive.kd_scale = kd_scale;
  p.transmission.armature_kg_m2 = armature_kg_m2;
  p.friction.viscous_Nm_s_per_rad = viscous, p.friction.coulomb_Nm = coulomb;
  return p;
}

class KnownMotor : public RobotBench, public testing::WithParamInterface<Known> {};

// Base and other joints are clamped, so a joint in the middle of a leg is as observable as one at the end of the trunk.
// One percent, because the fit's simulation is also the recorded one: they differ only by sensor noise.
TEST_P(KnownMotor, ComesBackWithinOnePercent) {
  const Known known = GetParam();
  const model::RobotModel robot = model::load_robot(pmg::test::project_folder() + "/config/robots/z1");
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(robot.joint_index.at(known.joint))];
  const model::ActuatorParameters truth = sim::actuator_in_force(joint, {{known.joint, known.of_motor_yaml}});
  excitation(known.joint, known.excitation);
  std::vector<std::string> arguments = {"--robot",        "z1",    "--bench",     known.joint, "--excitation",
                                        at("excitation"), "--out", at("recorded")};
  if (known.of_motor_yaml != model::ActuatorParameters{}) {
    std::ofstream(at("motor.yaml")) << sim::motor_yaml({{known.joint, truth}});
    arguments.insert(arguments.end(), {"--motor", at("motor.yaml")});
  }
  ASSERT_EQ(run("pmg_sil", arguments), 0) << err_;
  ASSERT_EQ(run("pmg_calibrate_motor", {at("recorded"), "--also", "coulomb", "viscous", "--starts", "3", "--threads",
                                        "2", "--out", at("fit")}),
            0)
      << err_;
  const sim::ActuatorsByJoint motors = sim::read_motor_file(at("fit/motor.yaml"));
  ASSERT_TRUE(motors.contains(known.joint)) << "as bench.yaml says";
  const model::ActuatorParameters& found = motors.at(known.joint);
  EXPECT_NEAR(found.drive.kp_scale / truth.drive.kp_scale, 1.0, 0.01);
  EXPECT_NEAR(found.drive.kd_scale / truth.drive.kd_scale, 1.0, 0.01);
  EXPECT_NEAR(found.transmission.armature_kg_m2 / truth.transmission.armature_kg_m2, 1.0, 0.01);
  EXPECT_NEAR(found.friction.coulomb_Nm / truth.friction.coulomb_Nm, 1.0, 0.01);
  EXPECT_NEAR(found.friction.viscous_Nm_s_per_rad / truth.friction.viscous_Nm_s_per_rad, 1.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(
    OfALimb, KnownMotor,
    testing::Values(Known{"head_pitch", motor(0.85, 1.2, 0.012, 0.15, 0.15), {"--repeats", "1"}},
                    Known{"left_knee", motor(0.85, 1.2, 0.055, 1.0, 2.0), {"--repeats", "1", "--angle", "0.1:1.3"}},
                    Known{"left_knee", {}, {"--angle", "0.1:1.3"}}),
    [](const auto& known) {
      return std::string(known.param.joint) +
             (known.param.of_motor_yaml == model::ActuatorParameters{} ? "_of_robot_yaml" : "");
    });

// README.md's example: a knee is recorded and calibrated; a knee with wear (play, and friction under load) is recorded
// and diagnosed against it.
TEST_F(RobotBench, ShowsWhatIsWornInTheExamplesKnee) {
  const fs::path hidden_file = pmg::test::project_folder() + "/config/examples/worn_knee.yaml";
  const model::ActuatorParameters hidden = sim::read_motor_file(hidden_file).at("left_knee");
  ASSERT_EQ(run("pmg_calibrate_motor", {"--make-excitation", "--robot", "z1", "--joint", "left_knee", "--angle",
                                        "0.1:1.3", "--seconds", "5", "--out", at("excitation")}),
            0)
      << err_;
  ASSERT_EQ(
      run("pmg_sil", {"--robot", "z1", "--bench", "left_knee", "--excitation", at("excitation"), "--out", at("knee")}),
      0)
      << err_;
  ASSERT_EQ(run("pmg_calibrate_motor",
                {at("knee"), "--also", "coulomb", "viscous", "--threads", "2", "--out", at("calibrated")}),
            0)
      << err_;
  const auto healthy = nlohmann::json::parse(std::ifstream(at("calibrated/fit.json")))["parameters"];
  for (const auto& [name, truth] : {std::pair{"drive.kp_scale", 1.0},
                                    {"drive.kd_scale", 1.0},
                                    {"transmission.armature_kg_m2", 0.04},
                                    {"friction.coulomb_Nm", 0.6},
                                    {"friction.viscous_Nm_s_per_rad", 0.3}}) {  // robot.yaml's
    const double deviation = healthy[name]["deviation"];
    EXPECT_LT(std::abs(healthy[name]["value"].get<double>() - truth), 3.0 * deviation) << name;
    EXPECT_LT(deviation, 0.02 * truth) << name << ": a deviation that says nothing covers everything";
  }
  ASSERT_EQ(run("pmg_sil", {"--robot", "z1", "--bench", "left_knee", "--excitation", at("excitation"), "--motor",
                            hidden_file.string(), "--out", at("worn")}),
            0)
      << err_;
  ASSERT_EQ(run("pmg_diagnose", {at("worn"), "--model", at("calibrated/motor.yaml"), "--fit", "repeat == 0", "--score",
                                 "repeat == 1", "--threads", "2", "--out", at("why")}),
            0)
      << err_;
  const auto diagnosis = nlohmann::json::parse(std::ifstream(at("why/diagnosis.json")));
  EXPECT_EQ(diagnosis["verdict"], "found");
  std::set<std::string> names;
  for (const auto& cause : diagnosis["causes"]) {
    names.insert(cause["effect"]);
    for (const auto& [name, estimate] : cause["parameters"].items()) {
      const double truth = model::actuator_parameter(name).value(hidden);
      EXPECT_LE(estimate["low"].get<double>(), truth) << name;
      EXPECT_GE(estimate["high"].get<double>(), truth) << name;
      EXPECT_LT(estimate["high"].get<double>() - estimate["low"].get<double>(), truth) << name << ": says nothing";
    }
  }
  EXPECT_EQ(names, (std::set<std::string>{"backlash", "load_friction"}));
  const double floor = diagnosis["noise_floor"];
  EXPECT_GT(diagnosis["held_out_error_before"].get<double>(), 8.0 * floor) << "something was wrong";
  EXPECT_LT(diagnosis["held_out_error_after"].get<double>(), 1.5 * floor) << "and little of it is left";
  // The command at the summary's end, typed as it is printed, simulates the robot with the found motor.
  const std::string before = "simulate with what was found: ";
  const std::size_t line = out_.find(before);
  ASSERT_NE(line, std::string::npos) << out_;
  const std::string command = out_.substr(line + before.size(), out_.find('\n', line) - line - before.size());
  EXPECT_EQ(std::system((command + " >/dev/null").c_str()), 0) << command;
  EXPECT_EQ(nlohmann::json::parse(std::ifstream(at("why/stand/summary.json")))["fell"], false);
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
  EXPECT_EQ(run("pmg_calibrate_motor", {"--make-excitation", "--robot", "z1", "--joint", "left_elbow", "--angle",
                                        "5:80", "--out", at("recorded")}),
            2);
  EXPECT_THAT(err_, AllOf(HasSubstr("left_elbow moves from"), HasSubstr("are these degrees?")));
  EXPECT_FALSE(fs::exists(at("recorded")));
}

}  // namespace
}  // namespace pmg
