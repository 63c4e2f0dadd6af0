// A robot driven by pages over a network with a virtual clock. The rules that every device obeys:
// device_rules_test.cpp.
#include "live_page/page_hands.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "operator/networked_robot.hpp"
#include "operator/robot_driver.hpp"

namespace pmg::live_page {
namespace {

using control::Mode;
using testing::HasSubstr;

/// One page's side: what its finger does, told 30 times a second.
struct Finger {
  std::int32_t page = 0;
  std::string name = "phone";
  bool held = false;
  int presses = 0;
  double forwards = 0.0, turn = 0.0, left = 0.0;
  std::int64_t number = 0, clock_offset_ns = 77'000'000'000;

  std::string text(std::int64_t now_ns) {
    return fmt::format(R"({{"n":{},"t":{:.3f},"held":{},"press":{},"forwards":{},"turn":{},"left":{}}})", ++number,
                       static_cast<double>(now_ns + clock_offset_ns) * 1e-6, held, presses, forwards, turn, left);
  }
  void touch() {
    held = true;
    ++presses;
  }
  void lift() {
    held = false;
    forwards = turn = left = 0.0;
  }
};

class PageHandsTest : public testing::Test {
 protected:
  PageHandsTest() {
    driver_.set_limits(robot_.robot.command_limits);
    run(0.3);
  }
  void say(Finger& finger) {
    hands_.take({finger.page, finger.text(network_.clock.now_ns())}, network_.clock.now_ns());
  }
  void step() {
    network_.advance();
    std::vector<web::Page> open;
    for (const Finger* finger : {&phone_, &laptop_})
      if (finger->page != 0) open.push_back({finger->page, finger->name});
    hands_.look(open);
    for (Finger* finger : {&phone_, &laptop_})
      if (finger->page != 0 && talks_) say(*finger);
    driver_.step();
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  Mode mode() const { return robot_.result().mode; }
  double u(Channel channel) const { return robot_.result().reference.command[channel]; }
  void ask(const Finger& finger, const std::string& request) {
    hands_.take({finger.page, "{\"request\":\"" + request + "\"}"}, network_.clock.now_ns());
  }
  void stand() {
    ask(phone_, "stand");
    run(4.0);
    ASSERT_EQ(mode(), Mode::kStand) << driver_.text();
  }
  void drive(Finger& finger) {
    finger.touch();
    run(0.1);
    finger.forwards = 1.0;
    run(2.0);
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  ops::OperatorSource source_{network_.link, "web.1", 1, network_.clock};
  PageHands hands_;
  ops::RobotDriver driver_{source_, "biped", hands_};
  Finger phone_{.page = 1}, laptop_{.page = 2, .name = "laptop"};
  bool talks_ = true;
};

TEST_F(PageHandsTest, AFingerDrivesToTheEndsOfTheRangesInItsDirections) {
  stand();
  drive(phone_);
  EXPECT_EQ(mode(), Mode::kWalk) << driver_.text();
  EXPECT_DOUBLE_EQ(u(kVx), robot_.robot.command_limits.upper[kVx]);
  EXPECT_EQ(hands_.driving(), 1);
  phone_.forwards = 0.0;
  phone_.turn = -1.0;
  run(2.0);
  EXPECT_LT(u(kOmega), 0.0) << "turn is positive to the left";
  phone_.turn = 0.0;
  phone_.left = 0.5;
  run(2.0);
  EXPECT_GT(u(kVy), 0.0);
  EXPECT_EQ(u(kOmega), 0.0);
  phone_.left = 0.1;
  run(2.0);
  EXPECT_EQ(u(kVy), 0.0) << "within the dead zone";
  phone_.lift();
  run(0.6);
  EXPECT_EQ(hands_.driving(), std::nullopt);
}

TEST_F(PageHandsTest, OnePageDrivesAndTheOthersAreToldAndNeedAFreshTouch) {
  stand();
  drive(phone_);
  laptop_.touch();
  run(0.1);
  laptop_.forwards = -1.0;
  run(1.0);
  EXPECT_GT(u(kVx), 0.0) << "the first one's";
  EXPECT_EQ(hands_.driving(), 1);
  ask(laptop_, "limp");
  run(0.3);
  EXPECT_EQ(mode(), Mode::kWalk);
  EXPECT_THAT(hands_.hand(2)->note(), HasSubstr("phone drives the robot"));
  phone_.lift();
  run(3.0);
  EXPECT_EQ(mode(), Mode::kStand) << "a touch while another drove doesn't count afterwards";
  laptop_.lift();
  run(0.1);
  drive(laptop_);
  EXPECT_EQ(hands_.driving(), 2);
  EXPECT_EQ(hands_.hand(2)->note(), "");
}

TEST_F(PageHandsTest, AnyPagesStopDampsWhileAnotherDrives) {
  stand();
  drive(phone_);
  hands_.take({laptop_.page, "stop"}, network_.clock.now_ns());
  for (int k = 0; k < 3 && mode() != Mode::kDamping; ++k) step();
  EXPECT_EQ(mode(), Mode::kDamping);
  phone_.forwards = 0.5;
  run(1.0);
  EXPECT_EQ(mode(), Mode::kDamping) << "the driving finger is still on its stick";
}

TEST_F(PageHandsTest, AStopCountsThoughItsPageIsGone) {
  stand();
  const std::int32_t gone = laptop_.page;
  laptop_.page = 0;
  step();
  hands_.take({gone, "stop"}, network_.clock.now_ns());
  run(0.05);
  EXPECT_EQ(mode(), Mode::kDamping);
}

TEST_F(PageHandsTest, APageThatIsClosedOrReloadedUnderTheFingerStopsAndNeedsAFreshTouch) {
  stand();
  drive(phone_);
  phone_.page = 0;
  run(0.55);
  EXPECT_EQ(u(kVx), 0.0);
  phone_.page = 3;
  phone_.number = 0;
  run(2.0);
  EXPECT_EQ(mode(), Mode::kStand) << "it came with the finger down";
  phone_.page = 4;
  phone_.number = 0;
  phone_.forwards = 0.0;
  run(0.1);
  phone_.forwards = 1.0;
  run(2.0);
  EXPECT_EQ(mode(), Mode::kStand) << "nor at the stick's centre";
  phone_.lift();
  run(0.1);
  drive(phone_);
  EXPECT_GT(u(kVx), 0.0);
}

TEST_F(PageHandsTest, MessagesThatComeLateDriveNothingAndAnOldTouchDoesNotCount) {
  stand();
  drive(phone_);
  phone_.clock_offset_ns -= ops::Device::kLate_ns + 50'000'000;  // each is on its way for so much longer
  run(0.3 + 0.55);
  EXPECT_EQ(u(kVx), 0.0);
  EXPECT_TRUE(hands_.hand(1)->late());
  phone_.lift();
  run(0.1);
  phone_.touch();
  run(0.2);
  phone_.clock_offset_ns += ops::Device::kLate_ns + 50'000'000;
  phone_.forwards = 1.0;
  run(2.0);
  EXPECT_EQ(mode(), Mode::kStand) << "the touch came late";
  EXPECT_FALSE(hands_.hand(1)->late());
}

TEST_F(PageHandsTest, LettingGoCountsHoweverLateItComes) {
  stand();
  drive(phone_);
  phone_.clock_offset_ns -= ops::Device::kLate_ns + 50'000'000;
  phone_.lift();
  step();
  EXPECT_EQ(hands_.driving(), std::nullopt);
}

TEST_F(PageHandsTest, RepeatedAndOlderMessagesChangeNothing) {
  stand();
  drive(phone_);
  const std::string driving = phone_.text(network_.clock.now_ns());
  phone_.forwards = 0.0;
  run(1.0);
  ASSERT_EQ(u(kVx), 0.0);
  for (int k = 0; k < 20; ++k) {
    hands_.take({phone_.page, driving}, network_.clock.now_ns());
    Finger overtaken = phone_;
    overtaken.number -= 5;
    overtaken.forwards = 1.0;
    hands_.take({phone_.page, overtaken.text(network_.clock.now_ns())}, network_.clock.now_ns());
    driver_.step();
    EXPECT_EQ(driver_.asked()[kVx], 0.0);
    step();
  }
  phone_.lift();
  run(3.0);
  talks_ = false;
  for (int k = 0; k < 100; ++k) {
    hands_.take({phone_.page, driving}, network_.clock.now_ns());
    step();
  }
  EXPECT_EQ(mode(), Mode::kStand);
  EXPECT_EQ(hands_.driving(), std::nullopt);
}

TEST_F(PageHandsTest, APageThatIsNotPairedOrSaysNonsenseChangesNothing) {
  laptop_.name.clear();
  laptop_.page = 5;
  stand();
  laptop_.touch();
  run(0.1);
  laptop_.forwards = 1.0;
  ask(laptop_, "limp");
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand);
  EXPECT_EQ(hands_.hand(5), nullptr);
  hands_.take({phone_.page, "{\"request\":\"explode\"}"}, network_.clock.now_ns());
  EXPECT_EQ(hands_.malformed(), 1U);
}

}  // namespace
}  // namespace pmg::live_page
