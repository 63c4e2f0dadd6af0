// pmg_emulated_drives: a simulated robot behind CAN sockets, in real time, for pmg_controller --hal can and pmg_bus.
#include <poll.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <memory>
#include <vector>

#include "../apps/program.hpp"
#include "can/hoisted_robot.hpp"
#include "can/socket_link.hpp"
#include "io/clock.hpp"

namespace {

using namespace pmg;

constexpr std::int64_t kPeriod_ns = test::HoistedRobot::kPeriod_ns;

int run(const std::string& name, bool gantry, int patience) {
  const model::RobotModel robot = model::load_robot(model::find_robot(name));
  const can::DriveSetup setup = can::load_drives(robot);
  std::vector<std::unique_ptr<can::Link>> links;
  std::vector<pollfd> polled;
  for (const can::BusSetup& bus : setup.buses) {
    links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
    polled.push_back({.fd = links.back()->descriptor(), .events = POLLIN, .revents = 0});
  }
  test::EmulatedDrives drives(setup, std::move(links));
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    for (std::size_t m = 0; m < setup.buses[b].motors.size(); ++m) drives.drive(b, m).patience = patience;
  }
  test::HoistedRobot hoisted(robot, drives, gantry);

  apps::notice({SIGINT, SIGTERM}, nullptr);
  const io::WallClock clock;
  std::int64_t next_ns = clock.now_ns();
  std::cout << "drives of " << robot.name << " answer\n" << std::flush;
  while (apps::interrupt_requested == 0) {
    hoisted.speak();
    drives.answer();  // also where the next tick is due already
    for (std::int64_t left_ns = 0; (left_ns = next_ns - clock.now_ns()) > 0;) {
      const timespec timeout{.tv_sec = 0, .tv_nsec = left_ns};
      if (ppoll(polled.data(), polled.size(), &timeout, nullptr) > 0) drives.answer();
    }
    next_ns = std::max(next_ns + kPeriod_ns, clock.now_ns() - 5 * kPeriod_ns);  // less than a watchdog
    hoisted.step();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A simulated robot's drives and IMU on this computer's CAN interfaces, in real time.",
               "pmg_emulated_drives");
  std::string robot = "z1";
  bool gantry = false;
  int patience = 1;
  app.add_option("--robot", robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_flag("--gantry", gantry, "the robot stays in its gantry");
  app.add_option("--patience", patience, "the drives' watchdogs take so many times their time (for a loaded computer)")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  return apps::run_program(app, argc, argv, [&]() -> int { return run(robot, gantry, patience); });
}
