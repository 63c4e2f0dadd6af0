#include "can/bus_claim.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <optional>
#include <string>
#include <utility>

namespace pmg::can {
namespace {

/// Of this process and test alone.
std::string interface() { return "can-test-" + std::to_string(getpid()); }

std::string refusal(const std::string& interface) {
  try {
    const BusClaim claim(interface);
  } catch (const BusIsDriven& error) {
    return error.what();
  }
  return "claimed";
}

TEST(BusClaim, OneProgramHasABusUntilItLetsGo) {
  std::optional<BusClaim> claim(std::in_place, interface());
  for (int k = 0; k < 100; ++k) {
    ASSERT_THAT(refusal(interface()), testing::HasSubstr(" drives it; expected nobody else")) << k;
  }
  EXPECT_EQ(refusal(interface() + "b"), "claimed");
  const BusClaim moved(std::move(*claim));
  claim.reset();
  EXPECT_NE(refusal(interface()), "claimed");
}

TEST(BusClaim, AKilledProgramsBusIsFreeAndALivingOneIsNamed) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const std::string bus = interface();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const BusClaim claim(bus);
    const char ready = 'r';
    if (write(ends[1], &ready, 1) != 1) _exit(1);
    for (;;) pause();
  }
  char ready = 0;
  ASSERT_EQ(read(ends[0], &ready, 1), 1);
  EXPECT_THAT(refusal(bus), testing::StartsWith(bus + ": "));
  EXPECT_THAT(refusal(bus), testing::HasSubstr("(process " + std::to_string(child) + ") drives it"));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(refusal(bus), "claimed");
  close(ends[0]);
  close(ends[1]);
}

}  // namespace
}  // namespace pmg::can
