// What a person reads while driving by keys, in a terminal of any size.
#include "operator/keyboard_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pmg::ops {
namespace {

using testing::HasSubstr;

std::vector<std::string> numbered(std::size_t count) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < count; ++i) lines.push_back("state " + std::to_string(i));
  return lines;
}

TEST(KeyboardText, WhatToDoAndHowToEndAreSeenInATerminalOf24Rows) {
  const std::vector<std::string> keys = key_lines();
  EXPECT_THAT(keys.back(), HasSubstr("Ctrl-C ends"));
  for (const std::string& line : keys) EXPECT_LE(line.size(), 80u) << line;
  for (const std::size_t state : {5u, 12u, 17u, 18u, 30u}) {
    const std::vector<std::string> picture = fitted(numbered(state), keys, 24);
    EXPECT_LE(picture.size(), 24u) << state;
    EXPECT_EQ(picture.front(), "state 0");
    EXPECT_EQ(picture.back(), keys.back()) << state;
    EXPECT_EQ(picture[picture.size() - keys.size()], keys.front()) << "all keys";
  }
}

TEST(KeyboardText, InASmallTerminalTheRobotsStateGoesBeforeTheKeys) {
  const std::vector<std::string> keys = key_lines();
  const std::vector<std::string> picture = fitted(numbered(12), keys, 10);
  ASSERT_EQ(picture.size(), 10u);
  EXPECT_EQ(picture[7], "state 7");
  EXPECT_EQ(picture.back(), keys.back());
}

TEST(KeyboardText, ARowIsFreeBetweenBothWhereThereIsRoom) {
  const std::vector<std::string> keys = key_lines();
  EXPECT_EQ(fitted(numbered(3), keys, 50)[3], "");
}

}  // namespace
}  // namespace pmg::ops
