// pmg_emulated_drives: a simulated robot behind CAN sockets, in real time, for pmg_controller --hal can and pmg_bus. It
// hangs in a hoist, which sets it down when its drives have held it for long enough.
#include <poll.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <iostream>
#include <memory>
#include <vector>

#include "../apps/program.hpp"
#include "can/emulated_drives.hpp"
#include "can/socket_link.hpp"
#include "io/clock.hpp"
#include "sil/crane.hpp"
#include "sil/simulated_robot.hpp"

namespace {

using namespace pmg;

constexpr std::int64_t kPeriod_ns = 2'000'000;
constexpr double kPeriod_s = 0.002;
constexpr double kStands_s = 6.0;  // the longest ramp into Stand lasts 5 s

int run(const std::string& name, bool gantry) {
  const model::RobotModel robot = model::load_robot(model::find_robot(name));
  const drives::DriveSetup setup = drives::load_drives(robot);
  std::vector<std::unique_ptr<can::Link>> links;
  std::vector<pollfd> polled;
  for (const drives::BusSetup& bus : setup.buses) {
    links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
    polled.push_back({.fd = links.back()->descriptor(), .events = POLLIN, .revents = 0});
  }
  sim::World world(robot, sil::world_with_noise(1, true));
  test::EmulatedDrives drives(setup, std::move(links));
  model::JointCommand acting;
  acting.q = acting.dq = acting.kp = acting.kd = acting.tau_ff = JointVector::Zero(robot.joint_index.size());
  model::RobotState sensed;
  sil::Crane crane;
  const double weight_N = world.mj_model()->body_subtreemass[0] * std::abs(world.mj_model()->opt.gravity[2]);
  double held_s = 0.0;

  apps::notice({SIGINT, SIGTERM}, nullptr);
  const io::WallClock clock;
  std::int64_t next_ns = clock.now_ns();
  std::cout << "drives of " << robot.name << " answer\n" << std::flush;
  while (apps::interrupt_requested == 0) {
    world.read(sensed);
    drives.feel(sensed);
    drives.speak();
    for (std::int64_t left_ns = 0; (left_ns = next_ns - clock.now_ns()) > 0;) {
      const timespec timeout{.tv_sec = 0, .tv_nsec = left_ns};
      if (ppoll(polled.data(), polled.size(), &timeout, nullptr) > 0) drives.answer();
    }
    next_ns = std::max(next_ns + kPeriod_ns, clock.now_ns() - 10 * kPeriod_ns);
    drives.tick(acting);
    held_s = acting.kp.maxCoeff() > 0.0 ? held_s + kPeriod_s : 0.0;
    if (!gantry) {
      const auto& feet_N = world.foot_force_N();
      crane.step({.stands = held_s > kStands_s,
                  .stays_up = false,
                  .carried_share = (feet_N[0] + feet_N[1]) / weight_N,
                  .torso_height_m = world.torso_height_m()},
                 kPeriod_s);
      world.set_hoist(crane.lift_m(), crane.engaged());
    }
    world.step(acting);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A simulated robot's drives and IMU on this computer's CAN interfaces, in real time.",
               "pmg_emulated_drives");
  std::string robot = "z1";
  bool gantry = false;
  app.add_option("--robot", robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_flag("--gantry", gantry, "the robot stays in its gantry");
  return apps::run_program(app, argc, argv, [&]() -> int { return run(robot, gantry); });
}
