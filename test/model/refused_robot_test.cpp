// Each kind of mistake in robot.yaml and the URDF is refused with file, line and key.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/config_error.hpp"
#include "folders.hpp"
#include "model/robot_model.hpp"
#include "refusal.hpp"
#include "temporary_copy.hpp"

namespace pmg::model {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class RefusedRobot : public ::testing::Test {
 protected:
  std::string refusal() const {
    return test::refusal_by<files::ConfigError>([&] { load_robot(copy_.directory()); });
  }
  void expect(const std::string& file, int line, const std::string& key, const std::string& what) const {
    const std::string text = refusal();
    EXPECT_THAT(text, StartsWith(fmt::format("{}:{}:", copy_.file(file).string(), line)));
    EXPECT_THAT(text, HasSubstr(": " + key));
    EXPECT_THAT(text, HasSubstr(what));
    EXPECT_THAT(text, AnyOf(HasSubstr("; expected "), HasSubstr("; did you mean ")));
  }
  /// Expects the error on the changed line.
  void expect_yaml(const std::string& old_text, const std::string& new_text, const std::string& key,
                   const std::string& what) const {
    const int line = copy_.replace("robot.yaml", old_text, new_text);
    expect("robot.yaml", line, key, what);
  }
  /// Expects the error at the element that begins with this text.
  void expect_urdf(const std::string& old_text, const std::string& new_text, const std::string& element,
                   const std::string& key, const std::string& what) const {
    copy_.replace("biped.urdf", old_text, new_text);
    expect("biped.urdf", copy_.line_of("biped.urdf", element), key, what);
  }

  TemporaryCopy copy_{pmg::test::project_folder() + "/test/data/robots/biped"};
};

TEST_F(RefusedRobot, TheUnspoiledOneIsNot) { EXPECT_EQ(refusal(), "taken"); }

TEST_F(RefusedRobot, UnknownKey) {
  expect_yaml("torso_link:", "torso_lnk: torso\ntorso_link:", "torso_lnk", "is unknown");
}
TEST_F(RefusedRobot, UnknownKeyOfAJoint) {
  expect_yaml("{stand_rad: 0, kp_Nm_per_rad: 120", "{ki: 1, stand_rad: 0, kp_Nm_per_rad: 120", "joints.waist_pitch.ki",
              "is unknown");
}
TEST_F(RefusedRobot, MissingKey) {
  const int first = copy_.line_of("robot.yaml", "name: biped");
  copy_.replace("robot.yaml", "torso_link: torso\n", "");
  expect("robot.yaml", first, "torso_link", "is missing");
}
TEST_F(RefusedRobot, MissingKeyOfAJoint) {
  expect_yaml("friction_Nm: 0.1, ", "", "joints.waist_pitch.friction_Nm", "is missing");
}
TEST_F(RefusedRobot, WrongType) {
  expect_yaml("kp_Nm_per_rad: 120", "kp_Nm_per_rad: stiff", "joints.waist_pitch.kp_Nm_per_rad", "'stiff'");
}
TEST_F(RefusedRobot, NotANumber) {
  expect_yaml("kd_Nm_s_per_rad: 4", "kd_Nm_s_per_rad: .nan", "joints.waist_pitch.kd_Nm_s_per_rad", "is '.nan'");
}
TEST_F(RefusedRobot, GainThatIsNotPositive) {
  expect_yaml("kp_Nm_per_rad: 120", "kp_Nm_per_rad: 0", "joints.waist_pitch.kp_Nm_per_rad",
              "expected a number above 0");
}
TEST_F(RefusedRobot, StandingPostureOutsideTheLimits) {
  expect_yaml("stand_rad: 0,", "stand_rad: 1.0,", "joints.waist_pitch.stand_rad", "expected a number from -0.4 to 0.9");
}
TEST_F(RefusedRobot, StandingPostureThatIsNotSymmetric) {
  copy_.replace("robot.yaml", "left_knee: {stand_rad: 0.4", "left_knee: {stand_rad: 0.5");
  EXPECT_THAT(refusal(), HasSubstr("robot.yaml: joints.right_knee.stand_rad: 0.4 isn't mirrored by left_knee: 0.5"));
}
TEST_F(RefusedRobot, MissingJoint) {
  const int joints = copy_.line_of("robot.yaml", "  waist_pitch:");
  copy_.replace("robot.yaml", "  waist_pitch: {", "  neck_pitch: {");
  expect("robot.yaml", joints, "joints.neck_pitch", "isn't a moving joint");
}
TEST_F(RefusedRobot, JointThatOnlyTheUrdfHas) {
  const std::string text = copy_.read("robot.yaml");
  const std::size_t start = text.find("  waist_pitch:"), end = text.find('\n', start);
  copy_.write("robot.yaml", text.substr(0, start) + text.substr(end + 1));
  expect("robot.yaml", copy_.line_of("robot.yaml", "  right_hip_yaw:"), "joints.waist_pitch", "is missing");
}
TEST_F(RefusedRobot, FixedJointInTheList) {
  expect_yaml("  waist_pitch: {", "  imu_mount: {", "joints.imu_mount", "isn't a moving joint");
}
TEST_F(RefusedRobot, RepeatedJoint) {
  expect_yaml("  right_hip_roll:", "  right_hip_yaw:", "joints.right_hip_yaw", "is there twice");
}
TEST_F(RefusedRobot, SharedBusAddress) {
  expect_yaml("node: 2}", "node: 1}", "joints.right_hip_yaw", "has the bus address of waist_pitch");
}
TEST_F(RefusedRobot, UnknownDrive) {
  expect_yaml("drive: position_pd", "drive: steam", "joints.waist_pitch.drive", "expected position_pd");
}
TEST_F(RefusedRobot, FootLinkThatIsNone) {
  expect_yaml("link: left_foot", "link: left_hoof", "feet.left.link", "'left_hoof' isn't a link");
}
TEST_F(RefusedRobot, FootWithoutSize) {
  expect_yaml("box_size_m: [0.2, 0.08", "box_size_m: [0.0, 0.08", "feet.left.box_size_m", "above 0");
}
TEST_F(RefusedRobot, ImuLinkThatIsNone) {
  expect_yaml("link: imu_plate", "link: nowhere", "imu.link", "'nowhere' isn't a link");
}
TEST_F(RefusedRobot, BaseThatIsNotTheRoot) {
  expect_yaml("base_link: base", "base_link: torso", "base_link", "isn't the root");
}
TEST_F(RefusedRobot, FootThatIsTheBase) {
  copy_.replace("robot.yaml", "link: left_foot", "link: base");
  expect("robot.yaml", copy_.line_of("robot.yaml", "  left: {link"), "feet", "base hangs on 0 joints");
}
TEST_F(RefusedRobot, CommandRangeReversed) {
  expect_yaml("range: [-0.3, 0.4]", "range: [0.4, -0.3]", "command.vx_m_s.range", "0 between");
}
TEST_F(RefusedRobot, CommandRateOfZero) {
  expect_yaml("rate_per_s: 0.6", "rate_per_s: 0", "command.vx_m_s.rate_per_s", "above 0");
}
TEST_F(RefusedRobot, VelocityScaleOfAPosture) {
  expect_yaml("pitch_rad: {", "pitch_rad: {velocity_scale: [1, 1], ", "command.pitch_rad.velocity_scale", "is unknown");
}
TEST_F(RefusedRobot, PolicyJointThatIsNone) {
  expect_yaml("policy_joints: [left_hip_yaw", "policy_joints: [tail", "policy_joints", "'tail' isn't a joint");
}
TEST_F(RefusedRobot, YamlThatIsNone) {
  const int line = copy_.replace("robot.yaml", "name: biped", "name: [biped");
  EXPECT_THAT(refusal(), StartsWith(fmt::format("{}:{}:", copy_.file("robot.yaml").string(), line + 1)));
}
TEST_F(RefusedRobot, MissingFile) {
  std::filesystem::remove(copy_.file("robot.yaml"));
  EXPECT_THAT(refusal(), StartsWith(copy_.file("robot.yaml").string() + ": cannot be read"));
}
TEST_F(RefusedRobot, MissingUrdf) {
  std::filesystem::remove(copy_.file("biped.urdf"));
  EXPECT_THAT(refusal(), StartsWith(copy_.file("biped.urdf").string() + ": cannot be read"));
}

TEST_F(RefusedRobot, UrdfLimitsReversed) {
  expect_urdf("lower=\"-0.4\" upper=\"0.9\"", "lower=\"0.9\" upper=\"-0.4\"", "<joint name=\"waist_pitch\"",
              "joint waist_pitch limit", "expected lower < upper");
}
TEST_F(RefusedRobot, UrdfLimitsThatAreNotSymmetric) {
  expect_urdf("lower=\"-1.8\"", "lower=\"-1.9\"", "<joint name=\"right_hip_pitch\"", "joint right_hip_pitch limit",
              "isn't mirrored");
}
TEST_F(RefusedRobot, UrdfJointWithoutAPartner) {
  copy_.replace("robot.yaml", "  left_knee:", "  leftish_knee:");
  copy_.replace("robot.yaml", "left_hip_pitch, left_knee, ", "left_hip_pitch, ");
  expect_urdf("<joint name=\"left_knee\"", "<joint name=\"leftish_knee\"", "<joint name=\"right_knee\"",
              "joint right_knee", "expected a joint left_knee");
}
TEST_F(RefusedRobot, UrdfJointAtAnotherPlaceThanItsPartner) {
  expect_urdf("xyz=\"0 0 -0.2\" rpy=\"0 0 1.57", "xyz=\"0 0 -0.21\" rpy=\"0 0 1.57", "<joint name=\"right_knee\"",
              "joint right_knee origin", "isn't mirrored by left_knee");
}
TEST_F(RefusedRobot, UrdfLinkWithoutMass) {
  expect_urdf("<mass value=\"0.4\"/>", "<mass value=\"0\"/>", "<link name=\"left_foot\"",
              "link left_foot inertial mass", "above 0 kg");
}
TEST_F(RefusedRobot, UrdfLinkWithoutInertial) {
  const std::string text = copy_.read("biped.urdf");
  const std::size_t link = text.find("<link name=\"torso\""), start = text.find("<inertial>", link);
  const std::string end = "</inertial>";
  copy_.write("biped.urdf", text.substr(0, start) + text.substr(text.find(end, start) + end.size()));
  expect("biped.urdf", copy_.line_of("biped.urdf", "<link name=\"torso\""), "link torso inertial", "is missing");
}
TEST_F(RefusedRobot, UrdfInertiaThatNoBodyHas) {
  expect_urdf("ixx=\"0.0004\"", "ixx=\"0.0001\"", "<link name=\"left_foot\"", "link left_foot inertia",
              "none above the sum");
}
TEST_F(RefusedRobot, UrdfNumberThatIsNone) {
  const int line = copy_.replace("biped.urdf", "<mass value=\"0.4\"/>", "<mass value=\"nan\"/>");
  expect("biped.urdf", line, "value", "is 'nan'; expected finite numbers");
}
TEST_F(RefusedRobot, UrdfNumberWithATail) {
  const int line = copy_.replace("biped.urdf", "xyz=\"0 0 -0.2\"", "xyz=\"0 0 -0.2m\"");
  expect("biped.urdf", line, "xyz", "is '0 0 -0.2m'");
}
TEST_F(RefusedRobot, UrdfAxisThatIsNotAUnitVector) {
  expect_urdf("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 2\"/>", "<joint name=\"left_hip_yaw\"",
              "joint left_hip_yaw axis", "a unit vector");
}
TEST_F(RefusedRobot, UrdfSlidingJoint) {
  expect_urdf("name=\"waist_pitch\" type=\"revolute\"", "name=\"waist_pitch\" type=\"prismatic\"",
              "<joint name=\"waist_pitch\"", "joint waist_pitch type", "revolute or fixed");
}
TEST_F(RefusedRobot, UrdfEffortOfZero) {
  expect_urdf("effort=\"40\"", "effort=\"0\"", "<joint name=\"left_hip_yaw\"", "joint left_hip_yaw limit effort",
              "above 0");
}
// The parser gives no line for these two.
TEST_F(RefusedRobot, UrdfThatIsNone) {
  copy_.replace("biped.urdf", "<robot name", "<roboter name");
  EXPECT_THAT(refusal(), StartsWith(copy_.file("biped.urdf").string() + ": "));
  EXPECT_THAT(refusal(), HasSubstr("expected a URDF robot"));
}
TEST_F(RefusedRobot, UrdfWithTwoRoots) {
  copy_.replace("biped.urdf", "</robot>", "  <link name=\"spare\"/>\n</robot>");
  EXPECT_THAT(refusal(), StartsWith(copy_.file("biped.urdf").string() + ": "));
  EXPECT_THAT(refusal(), HasSubstr("spare"));
}

}  // namespace
}  // namespace pmg::model
