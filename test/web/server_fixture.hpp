// A server of its own for each test, and browsers that talk to it.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "temporary_folder.hpp"
#include "web/browser.hpp"
#include "web/server.hpp"

namespace pmg::web {

using test::Browser;
using test::status_of;

inline constexpr const char* kToken = "letmein";

class ServerTest : public testing::Test {
 protected:
  ServerSettings settings() const {
    return {.port = 0,
            .certificate = certificate_,
            .names = {"localhost"},
            .assets = {{"/", "text/html", "<title>live</title>"}, {"/page.js", "text/javascript", "go();"}},
            .paired = [](std::string_view token) -> std::optional<std::string> {
              if (token == "throw") throw std::runtime_error("no such folder");
              return token == kToken ? std::optional("phone") : std::nullopt;
            }};
  }
  static void until(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition() && std::chrono::steady_clock::now() < end) sched_yield();
    EXPECT_TRUE(condition());
  }
  std::string get(const std::string& path, const std::string& host = "localhost", const std::string& method = "GET") {
    return Browser(server_.port()).ask(fmt::format("{} {} HTTP/1.1\r\nHost: {}\r\n\r\n", method, path, host));
  }
  std::unique_ptr<Browser> page(const std::string& token = kToken) {
    auto browser = std::make_unique<Browser>(server_.port());
    EXPECT_EQ(browser->open(token), 101);
    return browser;
  }
  /// What pages said, when this many messages have come.
  std::vector<std::string> said(std::size_t count) {
    std::vector<std::string> texts;
    until([&] {
      for (const Said& one : server_.take()) texts.push_back(one.text);
      return texts.size() >= count;
    });
    return texts;
  }
  void expect_answers(Browser& page) {
    page.say("are you there");
    EXPECT_THAT(said(1), testing::Contains("are you there"));
    const std::vector<Page> pages = server_.pages();
    server_.show(pages.back().id, "yes");
    for (const Page& one : pages) server_.show(one.id, "yes");
    EXPECT_EQ(page.hear(), "yes");
  }

  const test::TemporaryFolder folder_;
  const std::vector<std::string> names_{"localhost", "127.0.0.1"};
  const Certificate certificate_ = load_certificate(folder_.path(), names_, std::time(nullptr));
  Server server_{settings()};
};

}  // namespace pmg::web
