// pmg_watch's display shows the selected robot's news, whatever other senders use the address.
#include "operator/robot_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "networked_robot.hpp"
#include "operator/robot_text.hpp"
#include "pmg_msgs/mode_t.hpp"

namespace pmg::ops {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST(RecentValues, PercentilesAreOfTheLastThousand) {
  RecentValues values;
  EXPECT_EQ(values.percentile(99), 0.0);
  for (int k = 0; k < 500; ++k) values.add(1e6);
  for (int k = 1; k <= 1000; ++k) values.add(k);
  EXPECT_EQ(values.percentile(50), 500.0);
  EXPECT_EQ(values.percentile(99), 990.0);
  EXPECT_EQ(values.percentile(100), 1000.0);
}

class RobotBoardTest : public testing::Test {
 protected:
  RobotBoardTest() {
    for (int k = 0; k < 10; ++k) network_.advance();
  }
  const RobotNews& news(const std::string& robot) { return board_.robots().at(robot); }

  test::Network network_;
  RobotBoard board_{network_.link, network_.clock};
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
};

TEST_F(RobotBoardTest, OneRobotFillsAScreen) {
  const std::vector<std::string> lines = screen(news("biped"), 0.0);
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("biped"), HasSubstr("model biped"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("mode"), HasSubstr("passive"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("hottest"), HasSubstr("35 degC"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("state"), HasSubstr(" ms old"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("driven by"), HasSubstr("nobody   no command yet"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("real-time"), HasSubstr("NOT granted"))));
  for (const std::string& line : lines) {
    EXPECT_THAT(line, Not(HasSubstr("\n")));
    EXPECT_LE(line.size(), 80u) << line;
  }
  const auto json = news_json(news("biped"), 0.0);
  EXPECT_EQ(json["mode"], "passive");
  EXPECT_EQ(json["hottest"]["temperature_degC"], 35.0);
  EXPECT_EQ(json["messages"]["accepted"], 0);
}

TEST_F(RobotBoardTest, ABaselineIsAnnounced) {
  EXPECT_THAT(screen(news("biped"), 0.0), Not(Contains(HasSubstr("BASELINE"))));
  EXPECT_EQ(news_json(news("biped"), 0.0)["info"]["variant"], "pmg");
  RobotNews baseline = news("biped");
  baseline.info->options = R"({"policy": "other", "variant": "single_gait"})";
  EXPECT_THAT(screen(baseline, 0.0), Contains(AllOf(HasSubstr("BASELINE"), HasSubstr("single_gait"))));
  EXPECT_EQ(news_json(baseline, 0.0)["info"]["variant"], "single_gait");
  for (const char* broken : {"", "{", R"({"variant": 3})", "[]", R"({"variant": "velocity"})"}) {
    baseline.info->options = broken;
    EXPECT_THAT(screen(baseline, 0.0), Not(Contains(HasSubstr("BASELINE")))) << broken;
  }
}

TEST_F(RobotBoardTest, NewsOfTwoRobotsAreNotMixed) {
  test::NetworkedRobot& second = network_.add_robot("second");
  pmg_msgs::status_t status{};
  pmg_msgs::reference_t reference{};
  for (const auto& [name, vx_m_s] : {std::pair{"biped", 0.1}, {"second", 0.2}}) {
    status.robot = reference.robot = name;
    status.mode = pmg_msgs::mode_t::WALK;
    reference.command[kVx] = vx_m_s;
    network_.link.publish("STATUS", status);
    network_.link.publish("REFERENCE", reference);
  }
  network_.link.receive(0);
  EXPECT_EQ(second.result().mode, control::Mode::kPassive);
  EXPECT_EQ(news("biped").reference->command[kVx], 0.1);
  EXPECT_EQ(news("second").reference->command[kVx], 0.2);
  EXPECT_THAT(one_line(news("second"), 0.0), AllOf(HasSubstr("second"), HasSubstr("vx +0.20")));
}

TEST_F(RobotBoardTest, ASilentControllerAndAFaultAreSaid) {
  pmg_msgs::status_t status{};
  status.robot = "biped";
  status.mode = pmg_msgs::mode_t::FAULT;
  status.fault = "tilt: 1.20 rad, limit 1.00 rad";
  network_.link.publish("STATUS", status);
  network_.link.receive(0);
  EXPECT_EQ(news("biped").status.fault, "") << "of another start, while this one speaks";
  network_.control_alive = false;
  for (int k = 0; k < 31; ++k) network_.advance();
  network_.link.publish("STATUS", status);
  network_.link.receive(0);
  EXPECT_THAT(one_line(news("biped"), 5.0), AllOf(HasSubstr("FAULT tilt: 1.20 rad"), HasSubstr("NOT HEARD for 5 s")));
  EXPECT_THAT(screen(news("biped"), 5.0), Contains(AllOf(HasSubstr("mode"), HasSubstr("NOT HEARD for 5 s"))));
}

TEST_F(RobotBoardTest, StrangersTextDoesNotMoveTheCursor) {
  pmg_msgs::status_t status{};
  status.robot = "evil\x1b[2J";
  status.driving_source = status.fault = "\x1b[1;1Hx\n";
  network_.link.publish("STATUS", status);
  network_.link.receive(0);
  for (const auto& [name, robot] : board_.robots()) {
    EXPECT_THAT(one_line(robot, 0.0), AllOf(Not(HasSubstr("\x1b")), Not(HasSubstr("\n"))));
    for (const std::string& line : screen(robot, 0.0)) EXPECT_THAT(line, Not(HasSubstr("\x1b")));
  }
}

TEST_F(RobotBoardTest, InventedNamesEndSomewhere) {
  pmg_msgs::status_t status{};
  for (int k = 0; k < 1000; ++k) {
    status.robot = "robot " + std::to_string(k);
    network_.link.publish("STATUS", status);
    network_.link.receive(0);
  }
  EXPECT_EQ(board_.robots().size(), RobotBoard::kMostRobots);
}

}  // namespace
}  // namespace pmg::ops
