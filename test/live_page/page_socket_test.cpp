// From a page's socket to the drives: the server's own thread and sockets, and a robot with a virtual clock.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "live_page/assets.hpp"
#include "live_page/page_state.hpp"
#include "operator/networked_robot.hpp"
#include "temporary_folder.hpp"
#include "web/browser.hpp"

namespace pmg::live_page {
namespace {

using control::Mode;

class PageSocket : public testing::Test {
 protected:
  PageSocket() {
    nlohmann::json options;
    const CommandLimits& limits = robot_.robot.command_limits;
    for (std::size_t i = 0; i < kChannels; ++i) {
      options["command"]["lower"][kChannelNames[i]] = limits.lower[i];
      options["command"]["upper"][kChannelNames[i]] = limits.upper[i];
    }
    robot_.run.options = options.dump();
    run(1.5);
  }
  /// What pmg_web does in each turn, and 10 ms of the robot.
  void step() {
    network_.advance();
    turn();
  }
  void turn() {
    devices_.look(server_.pages(), network_.clock.now_ns());
    for (const web::Said& said : server_.take()) devices_.take(said, network_.clock.now_ns());
    station_.step(0);
  }
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) step();
  }
  /// The sockets have a clock of their own: until the server's thread has heard, the robot's stands still.
  void wait_until(const std::function<bool()>& condition) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition() && std::chrono::steady_clock::now() < end) sched_yield();
    ASSERT_TRUE(condition());
  }
  void say(const test::Browser& page, const std::string& text) {
    const std::uint64_t before = server_.counts().messages;
    page.say(text);
    wait_until([&] { return server_.counts().messages > before; });
  }
  void hand(const test::Browser& page, bool held, int presses, double forwards) {
    say(page, fmt::format(R"({{"n":{},"t":{},"held":{},"press":{},"forwards":{},"turn":0,"left":0}})", ++number_,
                          static_cast<double>(network_.clock.now_ns()) * 1e-6, held, presses, forwards));
  }
  std::unique_ptr<test::Browser> page() {
    auto page = std::make_unique<test::Browser>(server_.port());
    EXPECT_EQ(page->open("letmein"), 101);
    turn();
    return page;
  }
  void walk(const test::Browser& page) {
    say(page, R"({"request":"stand"})");
    run(4.0);
    ASSERT_EQ(mode(), Mode::kStand) << station_.driver()->text();
    hand(page, false, 0, 0.0);
    step();
    hand(page, true, 1, 0.0);
    step();
    for (int k = 0; k < 40; ++k) {
      hand(page, true, 1, 1.0);
      run(0.05);
    }
    ASSERT_EQ(mode(), Mode::kWalk) << station_.driver()->text();
    ASSERT_GT(robot_.result().reference.command[kVx], 0.0);
  }
  Mode mode() const { return robot_.result().mode; }

  const test::TemporaryFolder folder_;
  const std::vector<std::string> names_{"localhost"};
  web::Server server_{{.port = 0,
                       .certificate = web::load_certificate(folder_.path(), names_, std::time(nullptr)),
                       .names = names_,
                       .assets = assets(),
                       .paired = [](std::string_view token) {
                         return token == "letmein" ? std::optional<std::string>("phone") : std::nullopt;
                       }}};
  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  PageDevices devices_;
  ops::DrivingStation station_{network_.link, devices_.device(), "biped", 1, network_.clock};
  ops::ArmsBoard arms_{network_.link, network_.clock};
  std::int64_t number_ = 0;
};

TEST_F(PageSocket, AFingerOnAPageWalksTheRobotAndItsLossEndsIt) {
  auto driver = page();
  walk(*driver);
  driver.reset();
  wait_until([&] { return server_.pages().empty(); });
  run(0.6);
  EXPECT_EQ(robot_.result().reference.command[kVx], 0.0);
  run(1.5);
  EXPECT_EQ(mode(), Mode::kStand);
}

TEST_F(PageSocket, AStopDampsWithinFiftyMillisecondsAlsoWhileEverythingElseFloods) {
  const auto driver = page(), flooder = page(), stopper = page();
  walk(*driver);
  std::string flood;
  for (int k = 0; k < 300; ++k) flood += test::Browser::frame("{\"request\":\"stand\"}", 1);
  const std::uint64_t before = server_.counts().flooded;
  flooder->send(flood);
  say(*stopper, "stop");
  wait_until([&] { return server_.counts().flooded > before; });
  const std::int64_t since_ns = network_.clock.now_ns();
  turn();
  while (robot_.bus.last_command.kp.sum() != 0.0 && network_.clock.now_ns() - since_ns < 1'000'000'000) step();
  EXPECT_LE(network_.clock.now_ns() - since_ns, 50'000'000);
  run(0.02);
  EXPECT_EQ(mode(), Mode::kDamping);
}

TEST_F(PageSocket, APageSeesWhatTheRobotDoes) {
  const auto viewer = page();
  run(0.5);
  const std::string shared = shared_state(station_, devices_, arms_, nullptr, nullptr, network_.clock.now_ns());
  for (const web::Page& one : server_.pages()) server_.show(one.id, page_state(shared, one, devices_));
  const auto heard = viewer->hear();
  ASSERT_TRUE(heard);
  const nlohmann::json json = nlohmann::json::parse(*heard);
  EXPECT_EQ(json["news"]["mode"], "passive");
  EXPECT_EQ(json["you"]["paired"], "phone");
}

}  // namespace
}  // namespace pmg::live_page
