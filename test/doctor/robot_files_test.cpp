#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "doctor/checks.hpp"
#include "model/robots.hpp"
#include "said.hpp"

namespace pmg::doctor {
namespace {

namespace fs = std::filesystem;
using test::said;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// A copy of Z1 whose files can be spoiled.
class DoctorOfRobotFiles : public testing::Test {
 protected:
  DoctorOfRobotFiles() { fs::copy(test::kZ1Folder, folder_, fs::copy_options::recursive); }
  ~DoctorOfRobotFiles() override { fs::remove_all(folder_); }

  void replace(const std::string& name, const std::string& what, const std::string& by) {
    std::ifstream in(folder_ / name);
    std::string text(std::istreambuf_iterator<char>(in), {});
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    std::ofstream(folder_ / name) << text.replace(at, what.size(), by);
  }
  Findings examine(const std::string& bundle = "", const std::string& policy = "") const {
    return check_robot_files({.robot = folder_.string(), .clips = {}, .policy = policy}, bundle, true);
  }
  std::string line(const std::string& check) const { return said(examine(), check); }

  fs::path folder_ = fs::temp_directory_path() / ("pmg_doctor_files_" + std::to_string(getpid()));
};

TEST_F(DoctorOfRobotFiles, WhatIsWholeIsOkAndHasOneBundle) {
  const Findings findings = examine();
  ASSERT_EQ(findings.size(), 5u);
  for (const Finding& finding : findings)
    EXPECT_EQ(finding.verdict, Verdict::kOk) << finding.check << ": " << finding.found;
  const std::string digits = findings.back().found.substr(0, 12);
  EXPECT_EQ(said(examine(digits), "bundle"), "ok: " + digits + ", as expected");
  EXPECT_THAT(said(examine("0123456789ab"), "bundle"),
              AllOf(StartsWith("fail: " + digits + "; expected 0123456789ab"), HasSubstr("pmg_log info")));
  EXPECT_THAT(said(examine("", "none"), "policy"), StartsWith("warn: none: nothing balances"));
}

TEST_F(DoctorOfRobotFiles, AMissingUrdfFails) {
  fs::remove(folder_ / "z1.urdf");
  EXPECT_THAT(line("robot.yaml and URDF"), AllOf(StartsWith("fail: "), HasSubstr("z1.urdf")));
  EXPECT_EQ(line("policy"), "no line");
}

TEST_F(DoctorOfRobotFiles, ADriveThatDoesNotCoverItsJointFails) {
  replace("robot.yaml", "node: 4, drive: leg", "node: 4, drive: arm");
  EXPECT_THAT(line("drives"), AllOf(StartsWith("fail: "), HasSubstr("joints.left_knee.bus: the drive 'arm' covers")));
}

TEST_F(DoctorOfRobotFiles, AClipThatIsBrokenFails) {
  replace("clips/forward.yaml", "period_s", "period");
  EXPECT_THAT(line("clips"), AllOf(StartsWith("fail: "), HasSubstr("forward.yaml")));
}

TEST_F(DoctorOfRobotFiles, APolicyOfOtherClipsFails) {
  std::ofstream(folder_ / "clips/forward.yaml", std::ios::app) << "# one byte more\n";
  EXPECT_THAT(line("clips"), StartsWith("ok"));
  EXPECT_THAT(line("policy"), AllOf(StartsWith("fail: "), HasSubstr("clip"), HasSubstr("training/README.md")));
}

TEST_F(DoctorOfRobotFiles, APolicyThatIsNotThereFails) {
  EXPECT_THAT(said(examine("", "pmgg"), "policy"), AllOf(StartsWith("fail: "), HasSubstr("did you mean pmg")));
}

TEST(DoctorOfFirmware, DrivesOfOneKindHaveOneVersion) {
  const auto line = [](const std::optional<std::vector<DriveAnswer>>& answers) {
    return said(check_firmware(answers), "drives' firmware");
  };
  EXPECT_THAT(line(std::nullopt), AllOf(StartsWith("warn: not asked"), HasSubstr("--ask-drives")));
  std::vector<DriveAnswer> answers = {{"left_knee (can0, node 4)", "leg", 0x10002, ""},
                                      {"right_knee (can1, node 4)", "leg", 0x10002, ""}};
  EXPECT_EQ(line(answers), "ok: leg: 0x00010002 in every drive");
  answers[1].revision = 0x10003;
  EXPECT_THAT(
      line(answers),
      StartsWith(
          "fail: leg: drives of one kind differ: 0x00010002 in 1 (first: left_knee (can0, node 4)), 0x00010003 in 1"));
  answers[1].kind = "arm";
  EXPECT_THAT(line(answers), StartsWith("ok")) << "another kind has a version of its own";
  answers[0] = {"left_knee (can0, node 4)", "leg", std::nullopt, "does not answer"};
  EXPECT_THAT(line(answers),
              AllOf(StartsWith("fail: left_knee (can0, node 4): does not answer"), HasSubstr("pmg_bus scan")));
  EXPECT_THAT(line(std::vector<DriveAnswer>{{"left_knee (can0, node 4)", "leg", std::nullopt, ""}}),
              StartsWith("warn: leg: their protocol (mit) has no such question"));
}

}  // namespace
}  // namespace pmg::doctor
