// A robot's messages as topics for Foxglove: what a client of the protocol gets of a robot on a network.
#include "live_page/foxglove_feed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <set>
#include <stdexcept>

#include "operator/networked_robot.hpp"
#include "operator/robot_board.hpp"
#include "web/foxglove_client.hpp"

namespace pmg::live_page {
namespace {

class FoxgloveFeed : public testing::Test {
 protected:
  void step() {
    network_.advance();
    const auto robot = board_.robots().find("biped");
    if (robot != board_.robots().end())
      feed_.follow(robot->second.info ? &*robot->second.info : nullptr, &robot_.robot);
  }
  /// Until these topics are advertised. Frames that are waited for come in real time, the robot's own time is virtual.
  void see(test::FoxgloveClient& client, const std::set<std::string>& topics) {
    while (std::ranges::any_of(topics, [&](const auto& topic) { return client.channel(topic) == 0; })) {
      for (int k = 0; k < 150; ++k) step();
      if (!client.line().is_object()) throw std::runtime_error("the topics didn't come");
    }
  }
  void wait_for(const std::string& topic, const test::FoxgloveClient& client) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!server_.wants(client.channel(topic)) && std::chrono::steady_clock::now() < end) sched_yield();
    ASSERT_TRUE(server_.wants(client.channel(topic))) << topic;
  }
  nlohmann::json next(test::FoxgloveClient& client, const std::string& topic, std::uint32_t id) {
    client.subscribe(id, client.channel(topic));
    wait_for(topic, client);
    for (int k = 0; k < 10; ++k) step();
    while (const auto data = client.data())
      if (data->subscription == id) return nlohmann::json::parse(data->text);
    return {};
  }

  test::Network network_;
  test::NetworkedRobot& robot_ = network_.add_robot("biped");
  web::FoxgloveServer server_{{.port = 0}};
  ops::RobotBoard board_{network_.link, network_.clock};
  live_page::FoxgloveFeed feed_{network_.link, server_, [this] { return network_.clock.now_ns() + 5; }};
};

TEST_F(FoxgloveFeed, AClientGetsTheTopicsOfAnExportedLogFromALiveRobot) {
  test::FoxgloveClient client(server_.port());
  ASSERT_EQ(client.open(), 101);
  see(client, {"STATE", "STATUS", "REFERENCE", "ROBOT_INFO", "/tf", "/joint_states", "/log", "/robot_description"});
  const auto& names = robot_.robot.joint_index.names();
  const nlohmann::json state = next(client, "STATE", 1);
  EXPECT_EQ(state["robot"], "biped");
  EXPECT_EQ(state["q_rad"].size(), names.size());
  EXPECT_TRUE(state["q_rad"].contains(names.front()));
  const nlohmann::json joints = next(client, "/joint_states", 2);
  EXPECT_EQ(joints["joints"].size(), names.size());
  EXPECT_EQ(joints["joints"][0]["name"], names.front());
  const nlohmann::json tf = next(client, "/tf", 3);
  EXPECT_EQ(tf["transforms"][0]["parent_frame_id"], "world");
  EXPECT_THAT(next(client, "/robot_description", 4)["data"].get<std::string>(), testing::HasSubstr("<robot"));
  for (const auto& channel : client.channels)
    EXPECT_EQ(channel["topic"] == "/tf", channel["schemaName"] == "foxglove.FrameTransforms");
}

TEST_F(FoxgloveFeed, AnotherRobotsMessagesAreLeftOut) {
  network_.add_robot("other");
  test::FoxgloveClient client(server_.port());
  ASSERT_EQ(client.open(), 101);
  see(client, {"STATUS"});
  client.subscribe(1, client.channel("STATUS"));
  wait_for("STATUS", client);
  for (int k = 0; k < 20; ++k) {
    for (int tick = 0; tick < 10; ++tick) step();
    const auto data = client.data();
    ASSERT_TRUE(data);
    EXPECT_EQ(nlohmann::json::parse(data->text)["robot"], "biped");
  }
}

}  // namespace
}  // namespace pmg::live_page
