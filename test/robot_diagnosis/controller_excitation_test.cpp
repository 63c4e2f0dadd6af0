// The controller's tick plays both excitations on a simulated robot, and its log, as pmg_controller writes it, is all
// that the diagnosis gets.
#include <gtest/gtest.h>

#include "robot_diagnosis/played_excitation.hpp"
#include "robot_diagnosis/robot_diagnosis.hpp"
#include "robot_diagnosis/robot_report.hpp"
#include "robot_diagnosis/rubbing_joint.hpp"
#include "sil/sil_hal.hpp"
#include "temporary_folder.hpp"

namespace pmg::robot_diagnosis {
namespace {

class ControllerExcitation : public testing::Test {
 protected:
  PlayedExcitation played(const std::string& name, const sim::ActuatorsByJoint& motors) {
    sim::World world(z1(), world_to_excite(name, motors));
    sil::SilHal bus(world);
    return play_excitation(name, {.bus = bus, .world = world}, folder_.path());
  }

 private:
  const test::TemporaryFolder folder_;
};

TEST_F(ControllerExcitation, BothLogsTogetherNameWhatWasHidden) {
  const sim::ActuatorsByJoint motors = rubbing_elbow();
  const PlayedExcitation hanging = played("hanging", motors), standing = played("standing", motors);
  EXPECT_TRUE(hanging.whole) << hanging.told;
  EXPECT_TRUE(standing.whole) << standing.told;
  const RobotDiagnosis found = diagnose_robot(z1(), read_robot_logs({hanging.log, standing.log}, z1()));
  EXPECT_EQ(found.verdict, evidence::Verdict::kFound);
  ASSERT_NO_FATAL_FAILURE(expect_only_friction(found, "left_elbow", 0.4, 0.1));
  EXPECT_GT(found.coverage.hanging_s, 25.0);
  EXPECT_GT(found.coverage.standing_s, 30.0);
  EXPECT_NE(found.drive_sampling.find("every 2 ms (the log says so)"), std::string::npos) << found.drive_sampling;
  const std::string html = robot_diagnosis_page("z1", found).html();
  EXPECT_NE(html.find("left_elbow: friction.coulomb_Nm = 0.6 Nm, without it 0.2"), std::string::npos);
}

TEST_F(ControllerExcitation, TellsPeopleWhatItWaitsForAndWhatItDoes) {
  const std::string told = played("hanging", {}).told;
  for (const char* text : {"plays for 42 s", "comes back to rest", "the hanging excitation is over"})
    EXPECT_NE(told.find(text), std::string::npos) << told;
}

}  // namespace
}  // namespace pmg::robot_diagnosis
