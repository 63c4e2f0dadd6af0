// pmg_calibrate_zero, used as by its users: stances, a robot with hidden zero points in these stances, and the result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>

#include "apps/running_program.hpp"
#include "sim/motor_file.hpp"
#include "temporary_folder.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class PmgCalibrateZero : public testing::Test {
 protected:
  PmgCalibrateZero() { fs::create_directories(folder_); }

  test::Finished run(const std::string& program_name, const std::vector<std::string>& arguments) const {
    test::RunningProgram program(program_name, arguments, folder_);
    return program.finish();
  }
  void make_stances() const {
    const test::Finished done = run("pmg_calibrate_zero", {"--robot", "z1", "--make-stances", stances_.string()});
    ASSERT_EQ(done.exit_code, 0) << done.err;
  }
  const test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.file("a zero");
  const fs::path stances_ = folder_ / "stances", out_ = folder_ / "out";
};

/// 0.02 to 0.1 rad on every leg joint, and some offsets that no pose can show.
constexpr const char* kHidden = R"(joints:
  left_hip_pitch: {sensor: {zero_offset_rad: -0.0655}}
  left_hip_roll: {sensor: {zero_offset_rad: 0.0404}}
  left_hip_yaw: {sensor: {zero_offset_rad: 0.0809}}
  left_knee: {sensor: {zero_offset_rad: 0.0721}}
  left_ankle_pitch: {sensor: {zero_offset_rad: -0.02}}
  left_ankle_roll: {sensor: {zero_offset_rad: -0.05}}
  right_hip_pitch: {sensor: {zero_offset_rad: 0.0546}}
  right_hip_roll: {sensor: {zero_offset_rad: -0.03}}
  right_hip_yaw: {sensor: {zero_offset_rad: -0.1}}
  right_knee: {sensor: {zero_offset_rad: -0.0673}}
  right_ankle_pitch: {sensor: {zero_offset_rad: 0.0921}}
  right_ankle_roll: {sensor: {zero_offset_rad: 0.0218}}
  waist_yaw: {sensor: {zero_offset_rad: 0.06}}
  left_elbow: {sensor: {zero_offset_rad: -0.09}}
)";

// A whole calibration: stances, a simulated robot with hidden zero points, encoder and IMU noise and an IMU that is
// misaligned by 0.8 mrad, and its log.
TEST_F(PmgCalibrateZero, FindsHiddenZeroPointsOfASimulatedRobot) {
  make_stances();
  std::ofstream(folder_ / "hidden.yaml") << kHidden;
  const fs::path plant = folder_ / "plant";  // the simulated robot
  fs::copy(stances_, plant, fs::copy_options::recursive);
  YAML::Node yaml = YAML::LoadFile((stances_ / "robot.yaml").string());
  yaml["imu"]["rpy_rad"] = std::vector<double>{0.0006, -0.0005, 0.0};
  std::ofstream(plant / "robot.yaml") << YAML::Dump(yaml);
  const test::Finished played =
      run("pmg_sil", {"--robot", plant.string(), "--scenario", (stances_ / "scenario.yaml").string(), "--motor",
                      (folder_ / "hidden.yaml").string(), "--seed", "3", "--out", (folder_ / "run").string()});
  ASSERT_EQ(played.exit_code, 0) << played.err;

  const test::Finished done =
      run("pmg_calibrate_zero", {(folder_ / "run").string(), "--robot", "z1", "--out", out_.string(), "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err << done.out;
  const auto json = nlohmann::json::parse(done.out);
  const sim::ActuatorsByJoint hidden = sim::read_motor_file(folder_ / "hidden.yaml"),
                              found = sim::read_motor_file(out_ / "zero.yaml");
  EXPECT_EQ(found.size(), 12U) << "the legs', no other joint's";
  for (const auto& [joint, actuator] : found)
    EXPECT_NEAR(actuator.sensor.zero_offset_rad, hidden.at(joint).sensor.zero_offset_rad, 0.003) << joint;
  EXPECT_EQ(json["not_observable"].size(), 19U);
  EXPECT_THAT(json["not_observable"]["left_elbow"].get<std::string>(), HasSubstr("not between"));
  EXPECT_TRUE(fs::exists(out_ / "report.html"));
}

TEST_F(PmgCalibrateZero, AMotorFileOfOtherJointsIsRefused) {
  std::ofstream(folder_ / "motor.yaml") << "joints:\n  left_elbw: {friction: {coulomb_Nm: 1}}\n";
  const test::Finished done = run("pmg_calibrate_zero", {"test/data/logs/walk_fault_reset.lcm", "--out", out_.string(),
                                                         "--motor", (folder_ / "motor.yaml").string()});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("left_elbw"));
}

TEST_F(PmgCalibrateZero, BadInputIsOneLineAndNothingIsWritten) {
  const auto refused = [this](std::vector<std::string> arguments, const std::string& says) {
    arguments.insert(arguments.end(), {"--out", out_.string()});
    const test::Finished done = run("pmg_calibrate_zero", arguments);
    EXPECT_EQ(done.exit_code, 2) << says;
    EXPECT_THAT(done.err, HasSubstr(says));
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
    EXPECT_FALSE(fs::exists(out_));
  };
  refused({}, "LOG is missing");
  refused({(folder_ / "nothing").string()}, "no such file");
  refused({"README.md"}, "no state of a robot");
  refused({"test/data/logs/walk_fault_reset.lcm"}, "expected the same robot");
}

}  // namespace
}  // namespace pmg
