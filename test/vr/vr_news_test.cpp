#include "vr/vr_news.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <string>

namespace pmg::vr {
namespace {

const std::string kNews =
    R"({"vr":7,"t":12.5,"shown":true,"head":[0.1,1.7,-0.2,0,0,0,1],)"
    R"("left":{"pose":null,"leads":false,"presses":0,"backs":0},)"
    R"("right":{"pose":[0.4,1.2,-0.6,0,0.70710678,0,0.70710678],"leads":true,"presses":3,"backs":1},)"
    R"("held":true,"presses":2,"recentres":1,"spans":4,"uprights":5})";

TEST(VrNewsTest, IsReadWholeAndInOurAxes) {
  const auto news = read_news(kNews);
  ASSERT_TRUE(news && news->head && news->hands[kRight].pose);
  EXPECT_EQ(news->number, 7);
  EXPECT_EQ(news->stamp_ns, 12'500'000);
  EXPECT_TRUE(news->shown && news->held);
  EXPECT_TRUE(news->head->p_m.isApprox(Eigen::Vector3d(0.2, -0.1, 1.7))) << "WebXR looks along -z, with x to the right";
  EXPECT_FALSE(news->hands[kLeft].pose);
  EXPECT_TRUE(news->hands[kRight].leads);
  EXPECT_EQ(news->hands[kRight].lead_presses, 3);
  EXPECT_EQ(news->hands[kRight].hand_backs, 1);
  EXPECT_EQ(news->presses, 2);
  EXPECT_EQ(news->recentres, 1);
  EXPECT_EQ(news->spans_shown, 4);
  EXPECT_EQ(news->uprights, 5);
  EXPECT_NEAR(*yaw_of(news->hands[kRight].pose->R), std::numbers::pi / 2, 1e-6) << "a turn about up is to the left";
}

TEST(VrNewsTest, WhatIsNotWholeAndInItsRangeIsNone) {
  const auto with = [](const std::string& part, const std::string& other) {
    std::string text = kNews;
    const std::size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return text.replace(at, part.size(), other);
  };
  for (const std::string& text :
       {std::string(),
        std::string("stop"),
        std::string("{}"),
        std::string("[]"),
        std::string(R"({"vr":7})"),
        with("0.1,1.7,-0.2,0,0,0,1", "0.1,1.7,-0.2,0,0,0"),
        with("0.1,1.7", "20.1,1.7"),
        with("0.1,1.7", "null,1.7"),
        with("0.1,1.7", "1e999,1.7"),
        with("0,0,0,1]", "0,0,0,0.9]"),
        with("0,0,0,1]", "0,0,0,0]"),
        with("\"vr\":7", "\"vr\":-1"),
        with("\"vr\":7", "\"vr\":\"7\""),
        with("\"held\":true", "\"held\":1"),
        with("\"leads\":true", "\"leads\":null"),
        with(",\"uprights\":5", ""),
        with("\"uprights\":5", "\"uprights\":5,\"x\":0"),
        with("\"backs\":1", "\"backs\":1,\"x\":0"),
        with("{\"pose\":null", "{\"pose\":[]"),
        with("\"left\":{\"pose\":null,\"leads\":false,\"presses\":0,\"backs\":0}", "\"left\":null"),
        std::string(4000, '[')})
    EXPECT_FALSE(read_news(text)) << text;
}

TEST(VrNewsTest, ChangedBytesAreReadOrRefusedAndPosesStayFinite) {
  std::mt19937 random(18);
  const auto number = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  const std::string alphabet = "{}[]\",:.0123456789eE+-nulltruefalse\\u\xff ";
  int taken = 0;
  for (int k = 0; k < 10000; ++k) {
    std::string text = kNews;
    for (std::size_t n = 1 + number(3); n > 0; --n) text[number(text.size())] = alphabet[number(alphabet.size())];
    const auto news = read_news(text);
    if (!news) continue;
    ++taken;
    if (!news->head) continue;
    EXPECT_LE(news->head->p_m.cwiseAbs().maxCoeff(), 20.0) << text;
    EXPECT_NEAR(news->head->R.norm(), 1.0, 1e-9) << text;
  }
  EXPECT_GT(taken, 100) << "some changes leave a message whole";
}

TEST(VrNewsTest, WhatLooksStraightUpHasNoYaw) {
  EXPECT_FALSE(yaw_of(Eigen::Quaterniond(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitY()))));
}

}  // namespace
}  // namespace pmg::vr
