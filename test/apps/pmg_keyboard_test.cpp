// pmg_keyboard in a terminal, and the keys of pmg_controller's window, against a real pmg_controller and its simulated
// robot. They run by the wall clock on a shared computer, so the tests require events, not times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/pseudo_terminal.hpp"
#include "apps/running_program.hpp"
#include "folders.hpp"
#include "io/private_network.hpp"
#include "sim/display.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;
using io::Multicast;
using test::PseudoTerminal;
using test::RunningProgram;
using testing::HasSubstr;

class PmgKeyboard : public testing::Test {
 protected:
  PmgKeyboard() { fs::create_directories(folder_); }
  ~PmgKeyboard() override { fs::remove_all(folder_); }

  RunningProgram controller(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--hal", "sil", "--robot", "z1", "--no-realtime", "--log", (folder_ / "log").string()});
    return RunningProgram("pmg_controller", std::move(more), folder_);
  }
  /// A whole controller with its window; false if a fault disturbed it.
  bool window_keys_walk_and_stand() {
    RunningProgram robot = controller({"--viewer"});
    const auto place = [&](const char* words, std::size_t from = 0) { return robot.err().find(words, from); };
    bool disturbed = false;
    const auto comes = [&](const char* words, std::size_t from = 0) {
      const bool came = robot.until(
          [&] {
            disturbed = place("FAULT") != std::string::npos;
            return disturbed || place(words, from) != std::string::npos;
          },
          test::kDeadline_s);
      EXPECT_TRUE(came) << words << " doesn't come: " << robot.err();
      return came && !disturbed;
    };
    const auto window = [](const std::string& keys) {
      const std::string find = "xdotool search --sync --onlyvisible --name 'PMG: z1' windowfocus --sync ";
      EXPECT_EQ(std::system((find + keys + " >/dev/null 2>&1").c_str()), 0) << keys;
    };
    if (!comes("mode: passive")) return false;
    window("keydown w");
    const bool walked = comes("mode: walk");
    window("keyup w");
    if (!walked) return false;
    const std::size_t walk = place("mode: walk");
    if (!comes("mode: stand", walk)) return false;
    EXPECT_EQ(place("mode: damping", walk), std::string::npos) << "it never damps: " << robot.err();
    window("key Escape");
    if (!comes("mode: damping", walk)) return false;
    robot.send(SIGINT);
    EXPECT_EQ(robot.wait(), 0) << robot.err();
    return true;
  }
  nlohmann::json watch() {
    const std::string out = (folder_ / "watch").string();
    const std::string command = pmg::test::program_folder() + "/pmg_watch --once --json --timeout 20 >" + out + " 2>&1";
    if (std::system(command.c_str()) != 0) return {{"mode", "unheard"}};
    return nlohmann::json::parse(test::text_of(out));
  }
  fs::path folder_ = fs::temp_directory_path() / ("pmg_keyboard_test_" + std::to_string(getpid()));
};

TEST_F(PmgKeyboard, WithoutATerminalIsRefusedInOneLine) {
  RunningProgram program("pmg_keyboard", {"--lcm-url", "memq://"}, folder_);
  EXPECT_EQ(program.wait(), 2);
  EXPECT_THAT(program.err(), HasSubstr("needs a terminal"));
  EXPECT_EQ(std::ranges::count(program.err(), '\n'), 1) << program.err();
}

TEST_F(PmgKeyboard, HelpHasAnExampleAndTheExitCodes) {
  RunningProgram program("pmg_keyboard", {"--help"}, folder_);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_THAT(program.out(), testing::AllOf(HasSubstr("Example:"), HasSubstr("Exit codes: 0"), HasSubstr("tmux")));
}

TEST_F(PmgKeyboard, TheTerminalIsAsBeforeHoweverItEnds) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGABRT, SIGSEGV}) {
    PseudoTerminal terminal("pmg_keyboard", {"--lcm-url", "memq://"});
    ASSERT_TRUE(terminal.shows("no controller is heard on memq://", test::kDeadline_s)) << terminal.text();
    EXPECT_FALSE(terminal.as_before());
    terminal.send(signal);
    const bool crash = signal == SIGABRT || signal == SIGSEGV;
    EXPECT_EQ(terminal.wait(), crash ? -signal : 1) << signal;
    EXPECT_TRUE(terminal.as_before()) << signal;
    EXPECT_GT(terminal.text().rfind("\x1b[?1049l") + 1, terminal.text().rfind("\x1b[?1049h") + 1) << signal;
  }
}

TEST_F(PmgKeyboard, OutOfTheForegroundTheTerminalIsAsBeforeAndKeysComeBackWithIt) {
  PseudoTerminal terminal("pmg_keyboard", {"--lcm-url", "memq://"});
  ASSERT_TRUE(terminal.shows("no controller", test::kDeadline_s));
  terminal.send(SIGTSTP);
  while (!terminal.stopped()) usleep(1000);
  EXPECT_TRUE(terminal.as_before());
  terminal.send(SIGCONT);
  while (terminal.as_before()) usleep(1000);
  terminal.type("\x03");
  EXPECT_EQ(terminal.wait(), 1);
  EXPECT_TRUE(terminal.as_before());
}

TEST_F(PmgKeyboard, ByKeysALimpRobotStandsUpIsSetDownWalksRestsAndIsDamped) {
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    RunningProgram robot = controller();
    ASSERT_TRUE(robot.until([&] { return robot.err().find("mode: passive") != std::string::npos; }, test::kDeadline_s));
    PseudoTerminal terminal("pmg_keyboard", {});
    ASSERT_TRUE(terminal.shows("z1 PASSIVE", test::kDeadline_s)) << terminal.text();
    // A computer that pauses these processes for a second may bring the robot down. Then the test makes it stand up
    // again, as an operator would.
    bool walked = false;
    for (int attempt = 0; attempt < 5 && !walked; ++attempt) {
      if (attempt > 0) {
        terminal.type("h");
        terminal.shows("holds", 20.0);
        terminal.type("r");
        terminal.shows("DAMPING", 5.0);
        terminal.type("\r");
        terminal.shows("z1 STAND", 20.0);
      }
      walked = terminal.shows("z1 WALK", test::kDeadline_s / 3, [&] { terminal.type("w"); }) &&
               terminal.shows("+0.40     +0.00", 10.0, [&] { terminal.type("w"); });
    }
    ASSERT_TRUE(walked) << terminal.picture();
    EXPECT_EQ(watch()["driving_source"].get<std::string>().substr(0, 9), "keyboard.");
    EXPECT_TRUE(terminal.shows("velocity is zero", 10.0)) << "a second without a key\n" << terminal.picture();
    terminal.type("\x1b");
    EXPECT_TRUE(terminal.shows("z1 DAMPING", 10.0)) << terminal.picture();
    terminal.type("www");
    EXPECT_FALSE(terminal.shows("z1 STAND", 1.0)) << "only Enter raises it";
    terminal.type("\x03");
    EXPECT_EQ(terminal.wait(), 0);
    EXPECT_TRUE(terminal.as_before());
    EXPECT_THAT(terminal.text(), HasSubstr("z1: damping"));
    robot.send(SIGINT);
    EXPECT_EQ(robot.wait(), 0) << robot.err();
  });
}

TEST_F(PmgKeyboard, InTheWindowAHeldKeyWalksAndWhenItIsLetGoTheRobotStands) {
  const test::Display display;
  if (!test::Display::there()) GTEST_SKIP() << "NOT TESTED: no display, and no Xvfb (package xvfb) to make one";
  if (std::system("command -v xdotool >/dev/null") != 0) GTEST_SKIP() << "NOT TESTED: no xdotool to press keys";
  PMG_IN_PRIVATE_NETWORK(Multicast::kOnLoopback, [&] {
    // Mesa's driver keeps a few bytes and is unloaded with the window, so LeakSanitizer can't name it any more.
    setenv("LSAN_OPTIONS", "detect_leaks=0", 1);
    // A computer that pauses these processes for 50 ms brings the robot down; such an attempt doesn't count.
    bool undisturbed = false;
    for (int attempt = 0; attempt < 5 && !undisturbed; ++attempt) undisturbed = window_keys_walk_and_stand();
    EXPECT_TRUE(undisturbed) << test::text_of(folder_ / "pmg_controller.err");
  });
}

}  // namespace
}  // namespace pmg
