// pmg_sil --viewer without a display. test/sim/viewer_test.cpp tests the window itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "apps/running_program.hpp"

namespace pmg {
namespace {

namespace fs = std::filesystem;

void expect_refusal_in_one_line() {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("pmg_sil viewer " + std::to_string(getpid()));  // tests run in parallel
  fs::create_directories(folder);
  unsetenv("WAYLAND_DISPLAY");
  unsetenv("XDG_RUNTIME_DIR");
  const fs::path out = folder / "out";
  test::RunningProgram program(
      "pmg_sil", {"--scenario", "config/scenarios/stand.yaml", "--viewer", "--out", out.string()}, folder);
  EXPECT_EQ(program.wait(), 2);
  EXPECT_THAT(program.err(), testing::HasSubstr("no window can be opened"));
  EXPECT_EQ(std::ranges::count(program.err(), '\n'), 1) << program.err();
  EXPECT_FALSE(fs::exists(out));
  fs::remove_all(folder);
}

TEST(PmgSilViewer, WithoutADisplayIsRefusedInOneLineBeforeAnythingIsWritten) {
  unsetenv("DISPLAY");
  expect_refusal_in_one_line();
}

TEST(PmgSilViewer, ADisplayThatIsNotThereIsRefusedInOneLineBeforeAnythingIsWritten) {
  setenv("DISPLAY", ":987654", 1);
  expect_refusal_in_one_line();
}

}  // namespace
}  // namespace pmg
