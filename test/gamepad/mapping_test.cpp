// What a mapping file may say, and what it may not.
#include "gamepad/mapping.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "files/config_error.hpp"
#include "folders.hpp"
#include "temporary_folder.hpp"

namespace pmg::gamepad {
namespace {

const std::string kStandard = find_mapping("standard");

TEST(Mapping, EachMistakeIsRefusedWithItsFileAndLine) {
  const test::TemporaryFolder folder;
  std::stringstream text;
  text << std::ifstream(kStandard).rdbuf();
  const std::string standard = text.str(), file = folder.file("mistaken_gamepad.yaml");
  for (const auto& [from, to, expected] :
       std::vector<std::array<std::string, 3>>{{"stop: b ", "stop: bb ", ":2:.*no button is named 'bb'"},
                                               {"deadman: leftshoulder", "deadman: b", ":3:.*another meaning"},
                                               {"upright: y", "uprigt: y", "upright"},
                                               {"still_s: 3.0", "still_s: 100", ":6:"},
                                               {"left: {dead_zone: 0.15", "left: {dead_zone: 0.0", ":8:"},
                                               {"full_at: 0.95", "full_at: 0.1", ":8:"},
                                               {"expo: 0.3}", "expo: 2}", ":8:"},
                                               {"axis: lefty", "axis: lefttrigger", ":11:.*no stick's axis"},
                                               {"axis: leftx", "axis: lefty", ":12:.*vx_m_s has this axis"},
                                               {"full_in_s: 0.5", "full_in_s: 0", ":11:"},
                                               {"[rightshoulder, a]", "[a]", ":18:.*two or more"},
                                               {"[rightshoulder, a]", "[b, a]", ":18:.*the stop or the deadman"},
                                               {"[rightshoulder, x]", "[a, rightshoulder]", ":19:.*same buttons"},
                                               {"hold_s: 1.0", "hold_s: 0.1", ":18:"},
                                               {"posture_while: rightshoulder", "posture_while: b", ":4:.*another"},
                                               {"upright: y", "upright: rightshoulder", ":5:.*another meaning"},
                                               {"still_s: 3.0", "still_s: 0.4", ":6:"},
                                               {"still_s: 3.0", "still_s: 10.1", ":6:"},
                                               {"left: {dead_zone: 0.15", "left: {dead_zone: 0.04", ":8:"},
                                               {"left: {dead_zone: 0.15", "left: {dead_zone: 0.51", ":8:"},
                                               {"right: {dead_zone: 0.15", "right: {dead_zone: 0.04", ":9:"},
                                               {"full_at: 0.95", "full_at: 0.69", ":8:"},
                                               {"full_at: 0.95", "full_at: 1.01", ":8:"},
                                               {"expo: 0.3}", "expo: 1.01}", ":8:"},
                                               {"expo: 0.3}", "expo: -0.01}", ":8:"},
                                               {"expo: 0.3}", "expo: 0.3, colour: 1}", "colour"},
                                               {"sticks:", "sticks:\n  middle: 1", "middle"},
                                               {"invert: true", "invert: 7", ":11:"},
                                               {"full_in_s: 0.5", "full_in_s: 0.04", ":11:"},
                                               {"full_in_s: 0.5", "full_in_s: 10.1", ":11:"},
                                               {"full_in_s: 0.5", "full_in_s: 0.5, colour: 1", "colour"},
                                               {"roll_rad: {axis: rightx", "roll_rad: {axis: righty", "pitch_rad has"},
                                               {"roll_rad:", "yaw_rad:", "roll_rad"},
                                               {"  vx_m_s:", "  vz_m_s: 1\n  vx_m_s:", "vz_m_s"},
                                               {"[rightshoulder, a]", "[a, a]", ":18:.*two different"},
                                               {"[rightshoulder, a]", "[a, aa]", ":18:.*no button"},
                                               {"[rightshoulder, a]", "[leftshoulder, a]", ":18:.*the deadman"},
                                               {"hold_s: 1.0", "hold_s: 0.49", ":18:"},
                                               {"hold_s: 1.0", "hold_s: 5.1", ":18:"},
                                               {"hold_s: 1.0", "hold_s: 1.0, colour: 1", "colour"},
                                               {"chords:", "chords:\n  jump: 1", "jump"},
                                               {"chords:", "colour: red\nchords:", "colour"}}) {
    std::string wrong = standard;
    ASSERT_NE(wrong.find(from), std::string::npos) << from;
    std::ofstream(file) << wrong.replace(wrong.find(from), from.size(), to);
    try {
      read_mapping(file);
      ADD_FAILURE() << to;
    } catch (const files::ConfigError& error) {
      EXPECT_THAT(error.what(), testing::ContainsRegex(expected)) << to;
      EXPECT_THAT(error.what(), testing::HasSubstr(file + ":")) << to;
    }
  }
}

TEST(Mapping, IsFoundByItsNameOrIsAFile) {
  EXPECT_TRUE(std::filesystem::exists(find_mapping("standard")));
  EXPECT_EQ(find_mapping("folder/mine"), "folder/mine");
  EXPECT_EQ(find_mapping("mine.yaml"), "mine.yaml");
  EXPECT_THAT([] { find_mapping("standart"); },
              testing::ThrowsMessage<files::ConfigError>(
                  "mapping 'standart' is neither known nor a file; did you mean standard?"));
}

TEST(Mapping, TheDeadZoneIsRoundAndTheEndIsReachedInEveryDirection) {
  const StickShape shape{.dead_zone = 0.2, .full_at = 0.9, .expo = 0.5};
  for (double angle = 0.0; angle < 6.2; angle += 0.1) {
    const auto at = [&](double r) {
      const auto [x, y] = ops::shaped(shape, r * std::cos(angle), r * std::sin(angle));
      return std::hypot(x, y);
    };
    EXPECT_EQ(at(0.199), 0.0);
    EXPECT_NEAR(at(0.9), 1.0, 1e-12);
    EXPECT_NEAR(at(1.2), 1.0, 1e-12) << "a square stick's corner";
    EXPECT_NEAR(at(0.55), 0.5 * 0.5 + 0.5 * 0.125, 1e-12) << "halfway, the formula by hand";
  }
}

TEST(Mapping, ThePageHasTheTableOfTheStandardMapping) {
  std::stringstream page;
  page << std::ifstream(pmg::test::project_folder() + "/docs/how-to/operation.md").rdbuf();
  for (const auto& [hold, meaning] : mapping_rows(read_mapping(kStandard)))
    EXPECT_THAT(page.str(), testing::HasSubstr(fmt::format("| {} | {} |\n", hold, meaning)));
}

}  // namespace
}  // namespace pmg::gamepad
