// Foxglove's protocol over real sockets: who is let in, what a client gets, and that a slow one holds nobody up.
#include "web/foxglove_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "web/foxglove_client.hpp"

namespace pmg::web {
namespace {

using test::FoxgloveClient;
using Json = nlohmann::json;

class FoxgloveServerTest : public testing::Test {
 protected:
  static void until(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    bool holds = condition();
    while (!holds && std::chrono::steady_clock::now() < end) {
      sched_yield();
      holds = condition();
    }
    EXPECT_TRUE(holds);
  }
  void subscribe(const FoxgloveClient& client, std::uint32_t id, std::uint32_t channel) {
    client.subscribe(id, channel);
    until([&] { return server_.wants(channel); });
  }
  static FoxgloveChannel topic(const std::string& name, std::size_t waiting = 1, bool latched = false) {
    return {.topic = name,
            .encoding = "json",
            .schema_name = "pmg." + name,
            .schema_encoding = "jsonschema",
            .schema = R"({"type":"object"})",
            .waiting = waiting,
            .latched = latched};
  }
  FoxgloveServer server_{{.port = 0, .name = "robot", .session = "7", .origins = {"https://plots.example"}}};
};

TEST_F(FoxgloveServerTest, AClientIsToldTheTopicsAndGetsTheMessagesOfThoseItSubscribesTo) {
  const std::uint32_t state = server_.add(topic("STATE")), status = server_.add(topic("STATUS"));
  FoxgloveClient client(server_.port());
  ASSERT_EQ(client.open("localhost", "", "foxglove.websocket.v1, foxglove.sdk.v1"), 101);
  EXPECT_THAT(client.answer, testing::HasSubstr("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"));
  const Json info = client.line();
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["name"], "robot");
  EXPECT_EQ(info["sessionId"], "7");
  EXPECT_TRUE(info["capabilities"].empty()) << "it takes nothing";
  EXPECT_EQ(client.line()["op"], "advertise");
  ASSERT_EQ(client.channels.size(), 2U);
  EXPECT_EQ(client.channels[0], Json({{"id", state},
                                      {"topic", "STATE"},
                                      {"encoding", "json"},
                                      {"schemaName", "pmg.STATE"},
                                      {"schema", R"({"type":"object"})"},
                                      {"schemaEncoding", "jsonschema"}}));
  EXPECT_FALSE(server_.wants(state));
  subscribe(client, 40, status);
  EXPECT_FALSE(server_.wants(state)) << "nobody subscribed to it";
  server_.send(state, 1, "{}");
  server_.send(status, 1'700'000'000'123'456'789, R"({"mode":3})");
  const auto data = client.data();
  ASSERT_TRUE(data);
  EXPECT_EQ(data->subscription, 40U);
  EXPECT_EQ(data->time_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(data->text, R"({"mode":3})");
  client.say({{"op", "unsubscribe"}, {"subscriptionIds", {40}}});
  until([&] { return !server_.wants(status); });
}

TEST_F(FoxgloveServerTest, ATopicThatComesLaterIsAdvertisedOnceAndALatchedOneTellsItsNewest) {
  FoxgloveClient client(server_.port());
  ASSERT_EQ(client.open(), 101);
  client.line();
  until([&] { return server_.watched(); });
  const std::uint32_t urdf = server_.add(topic("URDF", 1, true)), other = server_.add(topic("OTHER"));
  EXPECT_TRUE(server_.wants(urdf)) << "for those who come later";
  server_.send(urdf, 1, "old");
  server_.send(urdf, 2, "new");
  while (client.channel("OTHER") == 0) ASSERT_TRUE(client.line().is_object());
  EXPECT_EQ(client.channels.size(), 2U);
  client.subscribe(1, urdf);
  subscribe(client, 2, other);
  server_.send(other, 3, "now");
  EXPECT_EQ(client.data()->text, "new");
  EXPECT_EQ(client.data()->text, "now");
}

TEST_F(FoxgloveServerTest, AnotherSitesPageAndAnotherNameAreRefused) {
  struct Case {
    const char *host, *origin, *protocols;
    int status;
  };
  for (const Case& one : {Case{"localhost:8765", "", "foxglove.sdk.v1", 101},
                          {"127.0.0.1", "http://localhost:8080", "foxglove.websocket.v1", 101},
                          {"[::1]", "https://app.foxglove.dev", "foxglove.sdk.v1", 101},
                          {"localhost", "file://", "foxglove.sdk.v1", 101},
                          {"localhost", "https://plots.example", "foxglove.sdk.v1", 101},
                          {"localhost", "https://evil.example", "foxglove.sdk.v1", 403},
                          {"localhost", "https://app.foxglove.dev.evil.example", "foxglove.sdk.v1", 403},
                          {"localhost", "http://localhost.evil.example", "foxglove.sdk.v1", 403},
                          {"localhost", "null", "foxglove.sdk.v1", 403},
                          {"evil.example", "", "foxglove.sdk.v1", 421},
                          {"localhost", "", "pmg", 400}}) {
    FoxgloveClient client(server_.port());
    EXPECT_EQ(client.open(one.host, one.origin, one.protocols), one.status) << one.host << ' ' << one.origin;
  }
  const FoxgloveCounts counts = server_.counts();
  EXPECT_EQ(counts.origin, 4U);
  EXPECT_EQ(counts.host, 1U);
  EXPECT_EQ(counts.protocol, 1U);
}

TEST_F(FoxgloveServerTest, WhatIsNoSubscriptionIsRefusedAndToldAndALotOfItEndsTheClient) {
  const std::uint32_t state = server_.add(topic("STATE"));
  FoxgloveClient client(server_.port());
  ASSERT_EQ(client.open(), 101);
  client.line();
  client.line();
  client.say({{"op", "advertise"}, {"channels", {{{"id", 1}, {"topic", "COMMAND"}, {"encoding", "json"}}}}});
  const Json refused = client.line();
  EXPECT_EQ(refused["op"], "status");
  EXPECT_EQ(refused["level"], 2);
  for (const char* text :
       {"", "[]", "{", R"({"op":7})", R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":[7]})",
        R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":99}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1e30,"channelId":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":[3]})", R"({"op":"setParameters"})"})
    client.browser.say(text);
  client.browser.say(std::string(1, '\x01') + "COMMAND", 2);
  until([&] { return server_.counts().not_understood == 13; });
  subscribe(client, 1, state);
  server_.send(state, 1, "still there");
  EXPECT_EQ(client.data()->text, "still there");
  for (std::uint64_t k = 0; k < FoxgloveServer::kMostDropped; ++k) client.browser.say("{}");
  EXPECT_FALSE(client.data());
  until([&] { return !server_.watched() && !server_.wants(state); });

  FoxgloveClient large(server_.port());
  ASSERT_EQ(large.open(), 101);
  large.browser.say(std::string(FoxgloveServer::kMostMessage_bytes + 1, ' '));
  until([&] { return server_.counts().oversize == 1; });
}

TEST_F(FoxgloveServerTest, ASlowClientSkipsStatesKeepsEventsAndHoldsNobodyUp) {
  constexpr std::size_t kEvents = 16;
  const std::uint32_t state = server_.add(topic("STATE")), events = server_.add(topic("EVENTS", kEvents));
  FoxgloveClient slow(server_.port(), 4096), quick(server_.port());
  for (FoxgloveClient* client : {&slow, &quick}) {
    ASSERT_EQ(client->open(), 101);
    client->subscribe(1, state);
    client->subscribe(2, events);
    subscribe(*client, 3, server_.add(topic("LAST")));  // nobody else's: when it has come, so have the others
  }
  until([&] { return server_.counts().clients == 2; });
  const std::string padding(20'000, ' ');
  for (int k = 1; k <= 2000; ++k) {
    server_.send(state, k, padding);
    const auto data = quick.data();
    ASSERT_TRUE(data);
    ASSERT_EQ(data->time_ns, k) << "the quick one gets each";
  }
  for (int k = 1; k <= 2 * static_cast<int>(kEvents); ++k) server_.send(events, k, "event");
  server_.send(state, 2001, padding);
  std::vector<std::int64_t> seen, happened;
  while (seen.empty() || seen.back() != 2001) {
    const auto data = slow.data();
    ASSERT_TRUE(data);
    (data->subscription == 1 ? seen : happened).push_back(data->time_ns);
  }
  EXPECT_TRUE(std::ranges::is_sorted(seen)) << "never an old one behind a newer one";
  EXPECT_LT(seen.size(), 1000U) << "what waits doesn't grow";
  EXPECT_EQ(happened.size(), kEvents);
  EXPECT_EQ(happened.back(), 2 * static_cast<std::int64_t>(kEvents)) << "the newest";
  EXPECT_GT(server_.counts().skipped, 1000U);
}

TEST_F(FoxgloveServerTest, OneClientTooManyIsRefusedAndAGoneOneMakesRoom) {
  std::vector<std::unique_ptr<FoxgloveClient>> clients;
  for (std::size_t k = 0; k < FoxgloveServer::kMostClients; ++k)
    EXPECT_EQ(clients.emplace_back(std::make_unique<FoxgloveClient>(server_.port()))->open(), 101);
  EXPECT_EQ(FoxgloveClient(server_.port()).open(), 503);
  EXPECT_EQ(server_.counts().full, 1U);
  clients.pop_back();
  until([&] { return FoxgloveClient(server_.port()).open() == 101; });
}

}  // namespace
}  // namespace pmg::web
