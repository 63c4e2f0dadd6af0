// robot.yaml's `arms`: what is wrong is said with its place.
#include <fstream>
#include <string>

#include "arms/arm_world.hpp"
#include "files/config_error.hpp"
#include "model/temporary_copy.hpp"
#include "model/urdf_tree.hpp"

namespace pmg::test {
namespace {

struct Spoilt {
  const char *name, *old_text, *new_text, *said;
};

void PrintTo(const Spoilt& spoilt, std::ostream* out) { *out << spoilt.name; }

class ArmSetups : public testing::TestWithParam<Spoilt> {};

TEST_P(ArmSetups, ThatAreWrongAreRefusedWithTheirPlace) {
  const model::TemporaryCopy copy(kZ1Folder);
  const int line = copy.replace("robot.yaml", GetParam().old_text, GetParam().new_text);
  const model::RobotModel robot = model::load_robot(copy.directory());
  try {
    arms::read_arm_setup(robot);
    FAIL() << "it was taken";
  } catch (const files::ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("robot.yaml:" + std::to_string(line) + ":"), std::string::npos) << text;
    EXPECT_NE(text.find(GetParam().said), std::string::npos) << text;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Arms, ArmSetups,
    testing::Values(
        Spoilt{"Link", "right: {palm_link: right_wrist_pitch_link", "right: {palm_link: right_palm", "right_palm"},
        Spoilt{"Shared", "right: {palm_link: right_wrist_pitch_link", "right: {palm_link: left_elbow_link", "shares"},
        Spoilt{"Leg", "right: {palm_link: right_wrist_pitch_link", "right: {palm_link: right_knee_link", "policy"},
        Spoilt{"NoJoint", "left: {palm_link: left_wrist_pitch_link", "left: {palm_link: torso", "0 joints"},
        Spoilt{"Speed", "speed_rad_s: 3.0", "speed_rad_s: 0.0", "speed_rad_s"},
        Spoilt{"Unknown", "speed_rad_s: 3.0", "sped: 1\n  speed_rad_s: 3.0", "sped"}),
    [](const auto& spoilt) { return std::string(spoilt.param.name); });

/// A torso, a bracket (fixed, 5 cm to the side), a shoulder (15 cm further to the side, 30 cm above), an elbow (30 cm
/// below it), a wrist (fixed, 24 cm below and 7 cm ahead of that); the right arm likewise to the other side.
std::string small_urdf() {
  const auto link = [](const std::string& name) {
    return "<link name=\"" + name + "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.01\" ixy=\"0\" ixz=\"0\" " +
           "iyy=\"0.01\" iyz=\"0\" izz=\"0.01\"/></inertial></link>\n";
  };
  const auto joint = [](const std::string& parent, const std::string& child, const char* type, const char* xyz) {
    return "<joint name=\"" + child + "_joint\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" +
           child + "\"/><origin xyz=\"" + xyz + "\"/><axis xyz=\"0 1 0\"/>" +
           "<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>\n";
  };
  std::string text = "<robot name=\"small\">\n" + link("torso");
  for (const bool left : {true, false}) {
    const std::string side = left ? "left_" : "right_";
    for (const char* name : {"bracket", "upper", "lower", "wrist"}) text += link(side + name);
    text += joint("torso", side + "bracket", "fixed", left ? "0.02 0.05 0" : "0.02 -0.05 0");
    text += joint(side + "bracket", side + "upper", "revolute", left ? "0 0.15 0.3" : "0 -0.15 0.3");
    text += joint(side + "upper", side + "lower", "revolute", "0 0 -0.3");
    text += joint(side + "lower", side + "wrist", "fixed", "0.07 0 -0.24");
  }
  return text + "</robot>\n";
}

TEST(ArmSetup, TheSpanIsTheShouldersWidthAndBothArmsLengths) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("small.urdf")) << small_urdf();
  const model::UrdfTree tree = model::read_urdf(folder.file("small.urdf"));
  arms::ArmSetup setup;
  ASSERT_TRUE(tree.tree.getChain("torso", "left_wrist", setup.palm[kLeft].chain));
  ASSERT_TRUE(tree.tree.getChain("torso", "right_wrist", setup.palm[kRight].chain));
  setup.palm[kLeft].T_LP.translation() = Eigen::Vector3d(0.0, 0.0, -0.10);
  setup.palm[kRight].T_LP.translation() = Eigen::Vector3d(0.03, 0.0, -0.04);
  EXPECT_NEAR(arms::span_m(setup), 2.0 * (0.05 + 0.15 + 0.30 + 0.25) + 0.10 + 0.05, 1e-12);
}

TEST(ArmSetup, OfARobotWithoutArmsAreNone) { EXPECT_FALSE(arms::read_arm_setup(biped()).has_value()); }

}  // namespace
}  // namespace pmg::test
