// robot.yaml's `arms`: what is wrong is said with its place.
#include "arms/arm_world.hpp"
#include "files/config_error.hpp"
#include "model/temporary_copy.hpp"

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

TEST(ArmSetup, OfARobotWithoutArmsAreNone) { EXPECT_FALSE(arms::read_arm_setup(biped()).has_value()); }

}  // namespace
}  // namespace pmg::test
