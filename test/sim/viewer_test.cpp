// The window, on the desktop's display or on Xvfb's. This is an executable of its own: MuJoCo keeps the first OpenGL of
// a process, and the off-screen renderer uses another one.
#include "sim/viewer.hpp"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <link.h>

#include <array>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "display.hpp"
#include "robots.hpp"
#include "sim/world.hpp"

namespace pmg {
namespace {

std::span<const double> positions(sim::World& world) {
  return {world.mj_data()->qpos, static_cast<std::size_t>(world.mj_model()->nq)};
}

std::size_t colours(const std::vector<std::uint8_t>& rgb) {
  std::set<std::array<std::uint8_t, 3>> found;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) found.insert({rgb[i], rgb[i + 1], rgb[i + 2]});
  return found.size();
}

/// Mesa's driver keeps some memory and is unloaded with the window. Only a library that stays loaded can be named in
/// test/lsan.supp.
void keep_loaded_libraries() {
  dl_iterate_phdr(
      [](dl_phdr_info* library, std::size_t, void*) {
        dlopen(library->dlpi_name, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
        return 0;
      },
      nullptr);
}

TEST(Viewer, ShowsTheRobotInAWindow) {
  const test::Display display;
  if (!test::Display::there()) GTEST_SKIP() << "NOT TESTED: no display, and no Xvfb (package xvfb) to make one";
  sim::World world(z1(), {});
  sim::Viewer viewer(world.mj_model(), {.width = 320, .height = 240, .title = "test"});
  keep_loaded_libraries();
  viewer.show(positions(world), "Walk");
  EXPECT_FALSE(viewer.closed());
  const auto standing = viewer.pixels();
  EXPECT_GE(standing.size(), 320U * 240U * 3U) << "more on a display of high density";
  EXPECT_GT(colours(standing), 200U) << "sky, floor and a shaded robot";
  // Another posture gives another picture, although the simulation itself does not change.
  std::vector<double> bent(positions(world).begin(), positions(world).end());
  const int knee = mj_name2id(world.mj_model(), mjOBJ_JOINT, "left_knee");
  ASSERT_GE(knee, 0);
  bent[static_cast<std::size_t>(world.mj_model()->jnt_qposadr[knee])] += 1.0;
  viewer.show(bent);
  EXPECT_NE(viewer.pixels(), standing);
}

TEST(Viewer, IsNoLargerThanItsScreenLessItsBars) {
  const sim::WindowSize laptop = sim::fitted({1280, 800}, {1366, 768});
  EXPECT_EQ(laptop.width, 1280);
  EXPECT_LE(laptop.height, 768 - 64) << "a title bar and a panel";
  const sim::WindowSize large = sim::fitted({1280, 800}, {1920, 1080});
  EXPECT_EQ(large.width, 1280);
  EXPECT_EQ(large.height, 800);
  EXPECT_EQ(sim::fitted({1280, 800}, {0, 0}).height, 800) << "a screen that nothing is known of";
}

TEST(Viewer, SaysInOneLineThatThereIsNoDisplay) {
  if (test::Display::there()) GTEST_SKIP() << "there is a display";
  unsetenv("WAYLAND_DISPLAY");
  sim::World world(z1(), {});
  std::string message;
  try {
    sim::Viewer viewer(world.mj_model());
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  EXPECT_THAT(message, testing::HasSubstr("no window can be opened"));
  EXPECT_THAT(message, testing::Not(testing::HasSubstr("\n")));
}

}  // namespace
}  // namespace pmg
