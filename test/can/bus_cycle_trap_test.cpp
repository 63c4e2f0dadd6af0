// The bus thread's work with drives on CAN, while a trap counts what would make it wait. Over memory; with
// PMG_CAN_SOCKETS=1 in the environment over the kernel's interfaces (test/can/canrun).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "can/can_backend.hpp"
#include "can/can_hal.hpp"
#include "can/emulated_drives.hpp"
#include "can/memory_link.hpp"
#include "can/socket_link.hpp"
#include "io/clock.hpp"
#include "model/robots.hpp"
#include "runtime/realtime_trap.hpp"
#include "sim/robots.hpp"

namespace pmg::can {
namespace {

using Links = std::vector<std::unique_ptr<Link>>;

/// Both ends of every bus.
std::pair<Links, Links> links(const can::DriveSetup& setup) {
  std::pair<Links, Links> ends;
  for (const can::BusSetup& bus : setup.buses) {
    if (std::getenv("PMG_CAN_SOCKETS") == nullptr) {
      auto [here, there] = test::MemoryLink::pair();
      ends.first.push_back(std::move(here));
      ends.second.push_back(std::move(there));
      continue;
    }
    for (Links* end : {&ends.first, &ends.second})
      end->push_back(std::make_unique<SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
  }
  return ends;
}

TEST(CanBusCycle, TakesNeitherHeapNorLock) {
  if (!test::trap_available()) GTEST_SKIP() << "a sanitizer replaces the same functions";
  const model::RobotModel& robot = test::z1();
  const can::DriveSetup setup = can::load_drives(robot);
  auto [host, far] = links(setup);
  const io::SimulationClock clock;
  CanHal hal(setup, robot, clock, std::move(host));
  test::EmulatedDrives drives(setup, std::move(far));
  model::RobotState truth, state;
  truth.q = robot.q_stand();
  truth.dq = truth.tau = JointVector::Zero(truth.q.size());
  drives.feel(truth);
  const model::JointCommand standing = standing_command(robot);
  model::JointCommand limp = standing, acting = standing;
  limp.kp.setZero();
  limp.kd.setZero();
  const auto cycle = [&](const model::JointCommand& command) {
    hal.send(command);
    drives.serve();
    const hal::BusStatus status = hal.receive(state);
    drives.tick(acting);
    return status;
  };
  for (int k = 0; k < 20; ++k) cycle(limp);
  int good = 0;
  const std::vector<pid_t> watched = {gettid()};
  test::arm_trap(watched);
  for (int k = 0; k < 200; ++k) good += cycle(standing) == hal::BusStatus::kOk ? 1 : 0;
  test::disarm_trap();
  const test::Trapped trapped = test::trapped();
  EXPECT_EQ(good, 200);
  EXPECT_EQ(trapped.heap, 0) << test::first_trapped();
  EXPECT_EQ(trapped.locks, 0) << test::first_trapped();
}

}  // namespace
}  // namespace pmg::can
