// The server, over this computer's own sockets: what it gives out, and whom it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "web/server_fixture.hpp"

namespace pmg::web {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not, testing::StartsWith;

TEST_F(ServerTest, GivesOutItsAssetsAndNothingElse) {
  EXPECT_THAT(get("/"), AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("text/html"), HasSubstr("<title>live</title>"),
                              HasSubstr("default-src 'none'"), HasSubstr("connect-src 'self' wss://localhost")));
  EXPECT_THAT(get("/page.js"), AllOf(HasSubstr("text/javascript"), HasSubstr("go();"), HasSubstr("nosniff")));
  const std::vector<std::string> none = {"/../../etc/passwd", "/%2e%2e/server.pem", "//", "/page.js/../server.pem",
                                         "/server.pem",       "/page.js?x",         "*",  "/page.js%00"};
  for (const std::string& path : none) EXPECT_EQ(status_of(get(path)), 404) << path;
  EXPECT_EQ(server_.counts().path, none.size());
  for (const char* method : {"POST", "PUT", "HEAD", "OPTIONS"})
    EXPECT_EQ(status_of(get("/", "localhost", method)), 405) << method;
}

TEST_F(ServerTest, GivesOutWhatItIsGivenLater) {
  EXPECT_EQ(status_of(get("/robot.json")), 404);
  for (const char* text : {"[1]", "[2]"}) {
    server_.give_out({"/robot.json", "application/json", text});
    EXPECT_THAT(get("/robot.json"), HasSubstr(text));
  }
  server_.give_out({"/camera.jpg", "image/jpeg", std::string("\xff\xd8\0\xff", 4)});
  EXPECT_THAT(get("/camera.jpg"),
              AllOf(HasSubstr("Content-Type: image/jpeg\r\n"), HasSubstr(std::string("\xff\xd8\0\xff", 4))));
}

TEST_F(ServerTest, OneConnectionAsksForSeveralAssets) {
  Browser browser(server_.port());
  for (int k = 0; k < 3; ++k)
    EXPECT_THAT(browser.ask("GET /page.js HTTP/1.1\r\nHost: localhost\r\n\r\n"), HasSubstr("go();"));
}

TEST_F(ServerTest, ItsCertificateIsTheOneWhoseFingerprintIsShown) {
  EXPECT_EQ(Browser(server_.port()).fingerprint(), certificate_.fingerprint);
}

TEST_F(ServerTest, ANameThatIsNotOursIsRefused) {
  EXPECT_EQ(status_of(get("/", "evil.com")), 421);
  EXPECT_EQ(status_of(Browser(server_.port()).ask("GET / HTTP/1.1\r\n\r\n")), 421);
  EXPECT_EQ(Browser(server_.port()).open(kToken, "evil.com", "https://evil.com"), 421);
  EXPECT_EQ(server_.counts().host, 3U);
}

TEST_F(ServerTest, APageOfAnotherSiteGetsNoSocket) {
  for (const char* origin : {"https://evil.com", "http://localhost", "null", ""})
    EXPECT_EQ(Browser(server_.port()).open(kToken, "localhost", origin), 403) << origin;
  EXPECT_EQ(server_.counts().origin, 4U);
  EXPECT_TRUE(server_.pages().empty());
}

TEST_F(ServerTest, AWrongTokenIsRefusedAndWithoutOneAPageOnlyLooks) {
  for (const char* token : {"letmeIn", "letmei", "letmeinn", "throw"})
    EXPECT_EQ(Browser(server_.port()).open(token), 403) << token;
  EXPECT_EQ(server_.counts().token, 4U);
  const auto reader = page("");
  reader->say("stop");
  reader->say("something");
  until([&] { return server_.counts().not_paired == 2; });
  EXPECT_TRUE(server_.take().empty());
  ASSERT_EQ(server_.pages().size(), 1U);
  EXPECT_EQ(server_.pages().front().paired_as, "");
  server_.show(server_.pages().front().id, "look");
  EXPECT_EQ(reader->hear(), "look");
}

TEST_F(ServerTest, WhatAPairedPageSaysIsHeardInItsOrder) {
  const auto paired = page();
  for (int k = 0; k < 5; ++k) paired->say(fmt::format("message {}", k));
  EXPECT_THAT(said(5), testing::ElementsAre("message 0", "message 1", "message 2", "message 3", "message 4"));
  EXPECT_EQ(server_.pages().front().paired_as, "phone");
}

TEST_F(ServerTest, APageWhosePairingIsRevokedIsClosed) {
  const auto paired = page();
  server_.close(server_.pages().front().id);
  EXPECT_EQ(paired->hear(), std::nullopt);
  EXPECT_EQ(paired->close_code(), 1008);
  EXPECT_TRUE(server_.pages().empty());
}

TEST_F(ServerTest, AMessageBeyondFourKilobytesEndsItsPageAlone) {
  const auto other = page();
  for (const bool in_parts : {false, true}) {
    const auto paired = page();
    paired->say(std::string(Server::kMostMessage_bytes, 'x'));
    EXPECT_EQ(said(1).front().size(), Server::kMostMessage_bytes);
    if (in_parts) {
      paired->send(Browser::frame(std::string(3000, 'x'), 1, false));
      paired->send(Browser::frame(std::string(3000, 'x'), 0, true));
    } else {
      paired->say(std::string(Server::kMostMessage_bytes + 1, 'x'));
    }
    EXPECT_EQ(paired->hear(), std::nullopt);
    EXPECT_EQ(paired->close_code(), 1009);
  }
  until([&] { return server_.counts().oversize == 2; });
  EXPECT_TRUE(server_.take().empty());
  expect_answers(*other);
}

TEST_F(ServerTest, AStopCountsThoughItsPageIsGone) {
  {
    const auto paired = page();
    paired->say(std::string(Server::kStop));
  }
  until([&] { return server_.pages().empty(); });
  EXPECT_THAT(said(1), testing::ElementsAre("stop"));
}

TEST_F(ServerTest, WhatCannotBeListenedOnIsSaidInOneLine) {
  const auto error = [&](std::string address, std::uint16_t port, const std::string& pem) {
    ServerSettings changed = settings();
    changed.address = std::move(address);
    changed.port = port;
    if (!pem.empty()) changed.certificate.pem = pem;
    try {
      const Server server(std::move(changed));
      return std::string();
    } catch (const std::exception& exception) {
      return std::string(exception.what());
    }
  };
  EXPECT_THAT(error("127.0.0.1", server_.port(), ""), AllOf(HasSubstr("in use"), Not(HasSubstr("\n"))));
  EXPECT_THAT(error("everywhere", 0, ""), HasSubstr("expected an IP address"));
  EXPECT_THAT(error("127.0.0.1", 0, "none"), HasSubstr("certificate can't be used"));
}

}  // namespace
}  // namespace pmg::web
