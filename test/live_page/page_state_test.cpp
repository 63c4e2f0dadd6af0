#include "live_page/page_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "live_page/assets.hpp"
#include "operator/networked_robot.hpp"

namespace pmg::live_page {
namespace {

using testing::HasSubstr;

class PageStateTest : public testing::Test {
 protected:
  void run(double seconds) {
    for (; seconds > 1e-9; seconds -= 0.01) {
      network_.advance();
      station_.step(0);
    }
  }
  nlohmann::json state(const web::Page& page) {
    const std::string shared = shared_state(station_, devices_, arms_, nullptr, nullptr, network_.clock.now_ns());
    return nlohmann::json::parse(page_state(shared, page, devices_));
  }
  const web::Page phone_{1, "phone"}, reader_{2, ""};
  test::Network network_;
  PageDevices devices_;
  ops::DrivingStation station_{network_.link, devices_.device(), "", 1, network_.clock};
  ops::ArmsBoard arms_{network_.link, network_.clock};
};

TEST_F(PageStateTest, BeforeARobotIsHeardItSaysSo) {
  run(0.1);
  const nlohmann::json json = state(phone_);
  EXPECT_TRUE(json["robot"].is_null());
  EXPECT_THAT(json["text"].get<std::string>(), HasSubstr("no controller is heard"));
  EXPECT_FALSE(json["heard"].get<bool>());
}

TEST_F(PageStateTest, HasWhatThePageReadsAndTellsEachPageWhoItIs) {
  network_.add_robot("biped");
  devices_.look(std::array{phone_, reader_}, network_.clock.now_ns());
  run(1.5);
  const nlohmann::json json = state(phone_), other = state(reader_);
  EXPECT_EQ(json["robot"], "biped");
  EXPECT_TRUE(json["heard"].get<bool>());
  EXPECT_EQ(json["news"]["mode"], "passive");
  EXPECT_EQ(json["asked"].size(), kChannels);
  for (const char* key : {"driving_source", "command_age_s", "realtime", "messages", "info"})
    EXPECT_TRUE(json["news"].contains(key)) << key;
  EXPECT_EQ(json["you"]["paired"], "phone");
  EXPECT_EQ(other["you"]["paired"], "");
  EXPECT_FALSE(json["you"]["drives"].get<bool>());
}

TEST_F(PageStateTest, ACommandIsTakenWhileTheRobotStandsAndNoneAfterAStop) {
  network_.add_robot("biped");
  devices_.look(std::array{phone_}, network_.clock.now_ns());
  run(1.5);
  devices_.take({.page = phone_.id, .text = R"({"request":"stand"})"}, network_.clock.now_ns());
  run(3.0);
  ASSERT_EQ(state(phone_)["news"]["mode"], "stand");
  for (const char* key : {"command", "optimised"}) EXPECT_TRUE(state(phone_)["news"].contains(key)) << key;
  devices_.take({.page = phone_.id, .text = std::string(web::Server::kStop)}, network_.clock.now_ns());
  run(0.2);
  ASSERT_EQ(state(phone_)["news"]["mode"], "damping");
  for (const char* key : {"command", "optimised"}) EXPECT_FALSE(state(phone_)["news"].contains(key)) << key;
}

TEST_F(PageStateTest, SaysWhenItWasMadeByTheServersClock) {
  run(1.25);
  EXPECT_DOUBLE_EQ(state(phone_)["at_s"], static_cast<double>(network_.clock.now_ns()) * 1e-9);
}

TEST_F(PageStateTest, TellsOfACameraOnlyWhereItIsShown) {
  run(0.1);
  EXPECT_FALSE(state(phone_).contains("camera"));
  const HeardCamera camera(network_.link, network_.clock);
  const std::string shared = shared_state(station_, devices_, arms_, nullptr, &camera, network_.clock.now_ns());
  EXPECT_EQ(nlohmann::json::parse(shared + "}")["camera"], nlohmann::json::object()) << "no picture has come";
}

TEST_F(PageStateTest, ForeignTextIsNoMarkupAndBreaksNothing) {
  network_.add_robot("<img src=x>\xff\x1b[2J");
  run(1.5);
  const std::string shared = shared_state(station_, devices_, arms_, nullptr, nullptr, network_.clock.now_ns());
  for (const char c : shared) EXPECT_TRUE(c >= ' ' && c < 127) << static_cast<int>(c);
  EXPECT_FALSE(state(phone_).is_discarded());
}

TEST_F(PageStateTest, BothPagesHaveTheOneConnectionAndNoneOfTheirOwn) {
  for (const web::Asset& asset : assets()) {
    if (asset.type == "text/html") {
      EXPECT_THAT(asset.text, HasSubstr("<script src=\"/connection.js\"></script>"));
    }
    const bool has = asset.text.find("new WebSocket") != std::string::npos;
    EXPECT_EQ(has, asset.path == "/connection.js") << asset.path;
  }
}

TEST_F(PageStateTest, ThePageNeedsNothingFromOutsideAndWritesNoMarkup) {
  for (const web::Asset& asset : assets()) {
    for (const char* outside : {"http://", "//cdn", "@import", "eval(", "innerHTML", "insertAdjacentHTML",
                                "document.write", " style=", "onclick="})
      EXPECT_EQ(asset.text.find(outside), std::string::npos) << asset.path << " has " << outside;
    EXPECT_FALSE(asset.text.empty());
  }
}

}  // namespace
}  // namespace pmg::live_page
