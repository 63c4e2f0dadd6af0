// pmg_gamepad in a terminal, without any game controller: its pads are tested in test/gamepad.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "apps/pseudo_terminal.hpp"
#include "apps/running_program.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using test::PseudoTerminal;
using test::RunningProgram;
using testing::HasSubstr;

class PmgGamepad : public testing::Test {
 protected:
  PmgGamepad() { fs::create_directories(folder_); }
  ~PmgGamepad() override { fs::remove_all(folder_); }

  void expect_refusal(std::vector<std::string> arguments, const std::string& words) const {
    RunningProgram program("pmg_gamepad", std::move(arguments), folder_);
    EXPECT_EQ(program.wait(), 2) << words;
    EXPECT_THAT(program.err(), HasSubstr(words));
    EXPECT_EQ(std::ranges::count(program.err(), '\n'), 1) << program.err();
    EXPECT_EQ(program.out(), "");
  }
  const fs::path folder_ = fs::temp_directory_path() / ("pmg_gamepad_test_" + std::to_string(getpid()));
};

TEST_F(PmgGamepad, WithoutATerminalIsRefusedInOneLine) { expect_refusal({"--lcm-url", "memq://"}, "needs a terminal"); }

TEST_F(PmgGamepad, ABadMappingIsRefusedInOneLine) {
  expect_refusal({"--lcm-url", "memq://", "--mapping", "standart"},
                 "mapping 'standart' is neither known nor a file; did you mean standard?");
  expect_refusal({"--lcm-url", "memq://", "--mapping", (folder_ / "none.yaml").string()}, "none.yaml: cannot be read");
  std::ofstream(folder_ / "bad.yaml") << "stop: bb\n";
  expect_refusal({"--lcm-url", "memq://", "--mapping", (folder_ / "bad.yaml").string()},
                 "bad.yaml:1:7: stop: no button is named 'bb'");
}

TEST_F(PmgGamepad, HelpSaysHowARobotIsStoppedAndWhatAWiredPadIs) {
  RunningProgram program("pmg_gamepad", {"--help"}, folder_);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.out(), testing::AllOf(HasSubstr("damps the robot at once"), HasSubstr("--wired"),
                                            HasSubstr("not safety-rated")));
}

TEST_F(PmgGamepad, WithoutAPadItSaysSoAndWhatTheButtonsMean) {
  PseudoTerminal terminal("pmg_gamepad", {"--lcm-url", "memq://"});
  ASSERT_TRUE(terminal.shows("no game controller: plug one in", test::kDeadline_s)) << terminal.text();
  EXPECT_THAT(terminal.picture(),
              testing::AllOf(HasSubstr("no controller is heard on memq://"), HasSubstr("DAMPS AT ONCE")));
  terminal.type("\x03");
  EXPECT_EQ(terminal.wait(), 1);
}

TEST_F(PmgGamepad, TheTerminalIsAsBeforeHoweverItEnds) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV}) {
    PseudoTerminal terminal("pmg_gamepad", {"--lcm-url", "memq://"});
    ASSERT_TRUE(terminal.shows("no game controller", test::kDeadline_s)) << terminal.text();
    EXPECT_FALSE(terminal.as_before());
    terminal.send(signal);
    EXPECT_EQ(terminal.wait(), signal == SIGSEGV ? -signal : 1) << signal;
    EXPECT_TRUE(terminal.as_before()) << signal;
  }
}

}  // namespace
}  // namespace pmg
