// pmg_emulated_slaves: a simulated robot behind emulated EtherCAT slaves that bridge CAN, in real time, on one network
// interface, for pmg_controller --hal ethercat. One slave a bus of robot.yaml, in its order.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <iostream>

#include "../apps/program.hpp"
#include "can/hoisted_robot.hpp"
#include "ethercat/cabled_drives.hpp"
#include "ethercat/packet_wire.hpp"
#include "io/clock.hpp"
#include "runtime/realtime.hpp"

namespace {

using namespace pmg;

constexpr std::int64_t kPeriod_ns = test::HoistedRobot::kPeriod_ns;

int run(const std::string& name, const std::string& interface, bool gantry) {
  const model::RobotModel robot = model::load_robot(model::find_robot(name));
  ethercat::PacketWire wire(interface);
  test::CabledDrives bridged(robot);
  test::HoistedRobot hoisted(robot, *bridged.drives, gantry);

  apps::notice({SIGINT, SIGTERM}, nullptr);
  runtime::schedule_this_thread({.name = "slaves", .priority = 40});  // below the controller's bus thread; if it may
  const io::WallClock clock;
  std::int64_t next_ns = clock.now_ns();
  std::cout << bridged.wire.slaves.size() << " slaves of " << robot.name << " answer on " << interface << "\n"
            << std::flush;
  std::array<std::uint8_t, ethercat::kMostFrame> frame{};
  while (apps::interrupt_requested == 0) {
    hoisted.speak();
    for (std::int64_t left_ns = 0; (left_ns = next_ns - clock.now_ns()) > 0;) {
      const std::size_t bytes = wire.receive(frame, left_ns);
      if (bytes == 0) continue;
      test::pass(std::span(frame).first(bytes), bridged.wire.slaves);
      wire.send(std::span(frame).first(bytes));
      bridged.drives->answer();
    }
    next_ns = std::max(next_ns + kPeriod_ns, clock.now_ns() - 10 * kPeriod_ns);
    bridged.tick_slaves();
    hoisted.step();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A simulated robot behind emulated EtherCAT slaves on a network interface, in real time.",
               "pmg_emulated_slaves");
  std::string robot = "z1", interface;
  bool gantry = false;
  app.add_option("--robot", robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_option("--interface", interface, "the network interface of the slaves' end")->required();
  app.add_flag("--gantry", gantry, "the robot stays in its gantry");
  return apps::run_program(app, argc, argv, [&]() -> int { return run(robot, interface, gantry); });
}
