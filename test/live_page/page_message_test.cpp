#include "live_page/page_message.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace pmg::live_page {
namespace {

const std::string kHand = R"({"n":7,"t":1234.5,"held":true,"press":2,"forwards":0.5,"turn":-1,"left":0})";

TEST(PageMessageTest, AHandIsReadWhole) {
  const auto message = read_message(kHand);
  ASSERT_TRUE(message && message->hand && !message->request);
  EXPECT_EQ(message->hand->number, 7);
  EXPECT_EQ(message->hand->stamp_ns, 1'234'500'000);
  EXPECT_TRUE(message->hand->held);
  EXPECT_EQ(message->hand->presses, 2);
  EXPECT_EQ(message->hand->forwards, 0.5);
  EXPECT_EQ(message->hand->turn, -1.0);
  EXPECT_EQ(message->hand->left, 0.0);
}

TEST(PageMessageTest, ARequestIsReadByItsName) {
  for (const auto& [name, request] : {std::pair{"stand", ops::Request::kStand},
                                      {"reset", ops::Request::kReset},
                                      {"limp", ops::Request::kLimp},
                                      {"lift", ops::Request::kLift},
                                      {"set_down", ops::Request::kSetDown}})
    EXPECT_EQ(read_message("{\"request\":\"" + std::string(name) + "\"}")->request, request) << name;
}

TEST(PageMessageTest, WhatIsNotWholeAndInItsRangeIsNone) {
  const auto with = [](const std::string& part, const std::string& other) {
    std::string text = kHand;
    return text.replace(text.find(part), part.size(), other);
  };
  for (const std::string& text : {std::string(),
                                  std::string("stop"),
                                  std::string("[]"),
                                  std::string("null"),
                                  std::string("{}"),
                                  std::string("{"),
                                  std::string(R"({"request":"walk"})"),
                                  std::string(R"({"request":1})"),
                                  std::string(R"({"request":"stand","n":1})"),
                                  with("0.5", "1.01"),
                                  with("0.5", "1e999"),
                                  with("0.5", "\"0.5\""),
                                  with("0.5", "null"),
                                  with("\"n\":7", "\"n\":-7"),
                                  with("\"n\":7", "\"n\":7.5"),
                                  with("\"n\":7", "\"n\":1e30"),
                                  with("1234.5", "1e300"),
                                  with("true", "1"),
                                  with(",\"left\":0", ""),
                                  with("}", ",\"more\":0}"),
                                  kHand + kHand,
                                  std::string(2000, '['),
                                  std::string(4000, '{')})
    EXPECT_FALSE(read_message(text)) << text.substr(0, 100);
}

TEST(PageMessageTest, ChangedBytesAreReadOrRefusedAndNothingElse) {
  std::mt19937 random(18);
  const auto number = [&](std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(random);
  };
  const std::string alphabet = "{}[]\",:.0123456789eE+-nulltruefalse\\u\xff\xc3 ";
  int taken = 0;
  for (int k = 0; k < 20000; ++k) {
    std::string text = number(4) == 0 ? R"({"request":"set_down"})" : kHand;
    for (std::size_t n = 1 + number(4); n > 0; --n) {
      const std::size_t at = number(text.size());
      if (number(3) == 0) text.erase(at, 1 + number(3));
      if (!text.empty()) text.insert(std::min(at, text.size()), 1, alphabet[number(alphabet.size())]);
    }
    const auto message = read_message(text);
    if (!message) continue;
    ++taken;
    EXPECT_NE(message->hand.has_value(), message->request.has_value());
    if (!message->hand) continue;
    for (const double share : {message->hand->forwards, message->hand->turn, message->hand->left})
      EXPECT_LE(std::abs(share), 1.0) << text;
    EXPECT_GE(message->hand->number, 0);
  }
  EXPECT_GT(taken, 100) << "some changes leave a message whole";
}

}  // namespace
}  // namespace pmg::live_page
