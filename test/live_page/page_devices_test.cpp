// Pages and a headset of one server, over a network with a virtual clock.
#include "live_page/page_devices.hpp"

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

/// A headset's page, in WebXR's axes.
struct VrPage {
  web::Page page;
  bool held = false;
  int presses = 0;
  double forward_m = 0.0;
  std::int64_t number = 0;

  std::string text(std::int64_t now_ns) {
    constexpr const char* kHand = R"({"pose":null,"leads":false,"presses":0,"backs":0})";
    return fmt::format(
        R"({{"vr":{},"t":{},"shown":true,"head":[0,1.7,{},0,0,0,1],"left":{},"right":{},"held":{},"presses":{},"recentres":0,"spans":0,"uprights":0}})",
        ++number, static_cast<double>(now_ns) * 1e-6, -forward_m, kHand, kHand, held, presses);
  }
};

class PageDevicesTest : public testing::Test {
 protected:
  PageDevicesTest() {
    driver_.set_limits(robot_.robot.command_limits);
    run(0.3);
  }
  void step() {
    network_.advance();
    std::vector<web::Page> open{phone_};
    for (const VrPage* headset : {&first_, &second_})
      if (headset->page.id != 0) open.push_back(headset->page);
    devices_.look(open, now_ns());
    for (VrPage* headset : {&first_, &second_})
      if (headset->page.id != 0) devices_.take({headset->page.id, headset->text(now_ns())}, now_ns());
    driver_.step();
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  std::int64_t now_ns() const { return network_.clock.now_ns(); }
  Mode mode() const { return robot_.result().mode; }
  double vx() const { return robot_.result().reference.command[kVx]; }
  void ask(const web::Page& page, const std::string& request) {
    devices_.take({page.id, "{\"request\":\"" + request + "\"}"}, now_ns());
  }
  void walk(VrPage& headset) {
    ask(headset.page, "stand");
    run(4.0);
    ASSERT_EQ(mode(), Mode::kStand) << driver_.text();
    headset.held = true;
    ++headset.presses;
    run(0.1);
    for (int k = 0; k < 35; ++k) {
      headset.forward_m += 0.01;
      step();
    }
    run(2.0);
    ASSERT_EQ(mode(), Mode::kWalk) << driver_.text();
    ASSERT_GT(vx(), 0.0);
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  ops::OperatorSource source_{network_.link, "web.1", 1, network_.clock};
  PageDevices devices_;
  ops::RobotDriver driver_{source_, "biped", devices_.device()};
  const web::Page phone_{1, "phone"};
  VrPage first_{.page = {2, "quest"}}, second_{.page = {0, "other"}};
};

TEST_F(PageDevicesTest, AHeadsetsPageDrivesAndPhonesStopAndAreToldWhoDrives) {
  walk(first_);
  EXPECT_TRUE(devices_.drives(2));
  EXPECT_EQ(devices_.note(phone_), "quest drives the robot");
  ask(phone_, "limp");
  run(0.3);
  EXPECT_EQ(mode(), Mode::kWalk);
  EXPECT_THAT(devices_.note(phone_), HasSubstr("quest drives the robot: it must let go first"));
  devices_.take({1, "stop"}, now_ns());
  for (int k = 0; k < 3 && mode() != Mode::kDamping; ++k) step();
  EXPECT_EQ(mode(), Mode::kDamping);
}

TEST_F(PageDevicesTest, ASecondHeadsetIsNotHeardUntilTheFirstIsGone) {
  second_.page.id = 3;
  second_.number = 1'000'000;  // so that its messages don't seem old beside the other's
  run(0.1);
  second_.held = true;
  ++second_.presses;
  walk(first_);
  EXPECT_TRUE(devices_.drives(2));
  EXPECT_FALSE(devices_.drives(3));
  first_.page.id = 0;
  run(3.0);
  EXPECT_EQ(mode(), Mode::kStand) << "a grip that was squeezed meanwhile doesn't count";
  second_.held = false;
  run(0.1);
  walk(second_);
  EXPECT_TRUE(devices_.drives(3));
}

TEST_F(PageDevicesTest, AStickThatIsHeldAndDoesNotDriveIsToldSo) {
  const auto finger = [&](int number, bool held) {
    devices_.take({1, fmt::format(R"({{"n":{},"t":{},"held":{},"press":1,"forwards":0,"turn":0,"left":0}})", number,
                                  static_cast<double>(now_ns()) * 1e-6, held)},
                  now_ns());
    step();
  };
  finger(1, true);
  EXPECT_EQ(devices_.note(phone_), "let go of the stick and touch it anew") << "the page came with the finger down";
  finger(2, false);
  EXPECT_EQ(devices_.note(phone_), "");
}

TEST_F(PageDevicesTest, APageThatIsNotPairedHasNoHeadset) {
  first_ = {.page = {7, ""}};
  ask(phone_, "stand");
  run(4.0);
  first_.held = true;
  ++first_.presses;
  run(0.1);
  for (int k = 0; k < 35; ++k) {
    first_.forward_m += 0.01;
    step();
  }
  run(1.0);
  EXPECT_EQ(mode(), Mode::kStand);
}

}  // namespace
}  // namespace pmg::live_page
