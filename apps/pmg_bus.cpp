// pmg_bus: bring-up of a robot's drives: roll call, readings, and the motion of one motor at a time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "can/bus_load.hpp"
#include "can/can_hal.hpp"
#include "can/candump.hpp"
#include "can/first_light.hpp"
#include "can/roll_call.hpp"
#include "can/socket_link.hpp"
#include "files/nearest_name.hpp"
#include "option_checks.hpp"
#include "pmg/types.hpp"
#include "program.hpp"

namespace {

using namespace pmg;
using std::chrono::milliseconds;

enum ExitCode { kOk = 0, kProblems = 1 };

constexpr const char* kFooter = R"(
For a robot that hangs in its gantry, limp, with a hard-wired emergency stop at hand. scan and watch switch every drive off and
only listen. zero, enable and wiggle touch one motor. Nothing else may drive the robot meanwhile: pmg_controller must not run.

Example:
  pmg_bus scan --robot z1
  pmg_bus watch --robot z1
  pmg_bus wiggle left_knee --robot z1
  pmg_bus dump --robot z1 >first.log

Exit codes: 0 all is well, 1 a drive has a problem, 2 bad input, or a bus that can't be opened. docs/how-to/hal.md has the order of a
bring-up.)";

struct Arguments {
  std::string robot = "z1", joint;
  double by_deg = 3.0, for_s = 0.0, gain_share = 0.3;
  bool yes = false;
};

bool interrupted() { return apps::interrupt_requested != 0; }

struct Buses {
  explicit Buses(const Arguments& arguments)
      : robot(model::load_robot(model::find_robot(arguments.robot))), setup(drives::load_drives(robot)) {
    can::check_load(setup);
    for (const drives::BusSetup& bus : setup.buses) {
      links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
    }
  }
  model::RobotModel robot;
  drives::DriveSetup setup;
  std::vector<std::unique_ptr<can::Link>> links;
};

std::string row(const drives::MotorSetup& motor, const drives::BusSetup& bus, const can::Answer* answer) {
  const std::string who = fmt::format("{:22} {:6} {:4}  ", motor.joint, bus.name, motor.node);
  if (answer == nullptr) return who + "-";
  const drives::MotorReading joint = motor.transmission.to_joint(answer->reading);
  return who + fmt::format("{:8.2f} deg {:8.2f} Nm {:4.0f} degC  {}", joint.q_rad / kRadPerDegree, joint.torque_Nm,
                           joint.temperature_degC, drives::to_string(joint.fault));
}

/// Asks every bus once, and prints a row for each motor and all problems. Returns the number of problems.
std::size_t show(Buses& buses) {
  std::vector<std::string> all;
  for (std::size_t b = 0; b < buses.setup.buses.size(); ++b) {
    const drives::BusSetup& bus = buses.setup.buses[b];
    const std::vector<can::Answer> answers = can::ask_bus(bus, *buses.links[b], interrupted);
    for (const drives::MotorSetup& motor : bus.motors) {
      const auto answer = std::ranges::find(answers, motor.node, &can::Answer::node);
      std::cout << row(motor, bus, answer == answers.end() ? nullptr : &*answer) << '\n';
    }
    const std::vector<std::string> found = can::problems(bus, answers);
    all.insert(all.end(), found.begin(), found.end());
  }
  for (const std::string& problem : all) std::cout << problem << '\n';
  std::cout << std::flush;
  return all.size();
}

int scan(const Arguments& arguments) {
  Buses buses(arguments);
  for (const drives::BusSetup& bus : buses.setup.buses) {
    const can::BusLoad load = can::planned_load(bus);
    std::cout << fmt::format("{}: {} motors{}, {} frames a cycle, at most {:.0f} % of the bus\n", bus.name,
                             bus.motors.size(), bus.imu ? " and the IMU" : "", load.frames, 100.0 * load.share);
  }
  return show(buses) == 0 ? kOk : kProblems;
}

int watch(const Arguments& arguments) {
  Buses buses(arguments);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(arguments.for_s > 0.0 ? arguments.for_s : 1e9);
  std::size_t problems = 0;
  while (!interrupted() && std::chrono::steady_clock::now() < end) {
    std::cout << "\x1b[H\x1b[2J";
    problems = show(buses);
    std::this_thread::sleep_for(milliseconds(200));
  }
  return problems == 0 ? kOk : kProblems;
}

struct OneMotor {
  const drives::BusSetup& bus;
  const drives::MotorSetup& motor;
  can::Link& link;
};

OneMotor find(Buses& buses, const std::string& joint) {
  for (std::size_t b = 0; b < buses.setup.buses.size(); ++b) {
    for (const drives::MotorSetup& motor : buses.setup.buses[b].motors) {
      if (motor.joint == joint) return {buses.setup.buses[b], motor, *buses.links[b]};
    }
  }
  throw std::invalid_argument(
      fmt::format("'{}' isn't a joint; {}", joint, files::expected_name(joint, buses.robot.joint_index.names())));
}

/// Sends one frame to one motor and returns its answer within 0.1 s.
drives::MotorReading ask(const OneMotor& one, const drives::MitFrame& bytes) {
  const drives::MitProtocol protocol(one.motor.ranges);
  const can::Frame frame = can::Frame::of(static_cast<std::uint32_t>(one.motor.node), bytes, one.bus.data_bitrate != 0);
  one.link.send(std::span(&frame, 1));
  for (int wait = 0; wait < 50; ++wait) {
    std::this_thread::sleep_for(milliseconds(2));
    std::array<can::Frame, 64> frames;
    const std::size_t count = one.link.receive(frames);
    for (const can::Frame& got : std::span(frames).first(count)) {
      if (got.extended || got.id != can::kReplyId || got.length != 8 || got.data[0] != one.motor.node) continue;
      return one.motor.transmission.to_joint(protocol.reply(got.bytes())->reading);
    }
  }
  throw std::runtime_error(
      fmt::format("{} ({}, node {}) does not answer; expected a powered drive with this node number", one.motor.joint,
                  one.bus.name, one.motor.node));
}

int enable(const Arguments& arguments) {
  Buses buses(arguments);
  const OneMotor one = find(buses, arguments.joint);
  const drives::MotorReading on = ask(one, drives::kMitEnable);
  const drives::MotorReading off = ask(one, drives::kMitDisable);
  std::cout << fmt::format("{} was enabled without a command and disabled again: {:.2f} deg, {}\n", arguments.joint,
                           on.q_rad / kRadPerDegree, drives::to_string(off.fault));
  return off.fault == drives::DriveFault::kNone ? kOk : kProblems;
}

int zero(const Arguments& arguments) {
  if (!arguments.yes) {
    throw std::invalid_argument(
        "zero overwrites the drive's zero for good; expected --yes when the joint stands at its zero position");
  }
  Buses buses(arguments);
  const OneMotor one = find(buses, arguments.joint);
  const drives::MotorReading before = ask(one, drives::kMitDisable);
  ask(one, drives::kMitZero);
  const drives::MotorReading after = ask(one, drives::kMitDisable);
  std::cout << fmt::format("{}: was {:.2f} deg, is {:.2f} deg now\n", arguments.joint, before.q_rad / kRadPerDegree,
                           after.q_rad / kRadPerDegree);
  return std::abs(after.q_rad + buses.robot.joints[static_cast<std::size_t>(one.motor.index)].bus.zero_offset_rad) <
                 kRadPerDegree
             ? kOk
             : kProblems;
}

int wiggle(const Arguments& arguments) {
  Buses buses(arguments);
  const OneMotor one = find(buses, arguments.joint);
  const double by_rad = arguments.by_deg * kRadPerDegree;
  std::cout << fmt::format("{} moves by {:.1f} deg there and back. For + the model's limb goes: {}\n", arguments.joint,
                           arguments.by_deg, can::way_of(buses.robot, arguments.joint, by_rad))
            << std::flush;
  auto next = std::chrono::steady_clock::now();
  const auto tick = [&next] { std::this_thread::sleep_until(next += milliseconds(2)); };
  const can::Wiggle result = can::wiggle(buses.robot, one.bus, one.motor, one.link,
                                         {.by_rad = by_rad, .gain_share = arguments.gain_share}, tick, interrupted);
  const std::string verdict = can::verdict(result);
  std::cout << fmt::format("asked {:.2f} deg, moved {:.2f} deg; holds {:.2f} Nm, the model {:.2f} Nm: {}\n",
                           result.asked_rad / kRadPerDegree, result.moved_rad / kRadPerDegree, result.held_Nm,
                           result.model_Nm, verdict);
  return verdict.starts_with("direction and gear") || verdict.starts_with("its load") ? kOk : kProblems;
}

int dump(const Arguments& arguments) {
  Buses buses(arguments);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(arguments.for_s > 0.0 ? arguments.for_s : 1e9);
  while (!interrupted() && std::chrono::steady_clock::now() < end) {
    bool any = false;
    for (std::size_t b = 0; b < buses.links.size(); ++b) {
      std::array<can::Frame, 64> frames;
      const std::size_t count = buses.links[b]->receive(frames);
      const std::int64_t now_ns = std::chrono::system_clock::now().time_since_epoch().count();
      for (const can::Frame& frame : std::span(frames).first(count)) {
        std::cout << can::to_line({.stamp_ns = now_ns, .interface = buses.setup.buses[b].name, .frame = frame}) << '\n';
      }
      any = any || count > 0;
    }
    if (!any) std::this_thread::sleep_for(milliseconds(1));
    if (!std::cout) throw std::runtime_error("the recording can't be written");
  }
  std::cout << std::flush;
  return kOk;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("First light of a robot's drives on its CAN buses: who answers, what they say, one motor at a time.",
               "pmg_bus");
  Arguments arguments;
  int (*chosen)(const Arguments&) = nullptr;
  app.footer(kFooter);
  app.require_subcommand(1);
  const auto command = [&](const char* name, const char* help, int (*work)(const Arguments&)) {
    CLI::App* sub = app.add_subcommand(name, help);
    sub->add_option("--robot", arguments.robot, "robot's name below config/robots, or its folder")
        ->capture_default_str();
    sub->callback([&chosen, work] { chosen = work; });
    return sub;
  };
  const auto joint = [&](CLI::App* sub) {
    sub->add_option("joint", arguments.joint, "the joint whose motor it is")->required();
  };
  const auto duration = [&](CLI::App* sub) {
    sub->add_option("--for", arguments.for_s, "end after so many seconds")->check(apps::positive());
  };
  command("scan", "switch all drives off and ask each once", scan);
  duration(command("watch", "the same again and again: move the joints by hand and look", watch));
  joint(command("enable", "enable one drive without a command, and disable it", enable));
  CLI::App* zeroing = command("zero", "the joint's present position becomes its drive's zero", zero);
  joint(zeroing);
  zeroing->add_flag("--yes", arguments.yes, "the joint stands at its zero position");
  CLI::App* wiggling = command("wiggle", "move one joint by a few degrees and compare with the model", wiggle);
  joint(wiggling);
  wiggling->add_option("--by", arguments.by_deg, "degrees")->check(apps::in_range(0.5, 10.0))->capture_default_str();
  wiggling->add_option("--gains", arguments.gain_share, "share of robot.yaml's gains")
      ->check(apps::in_range(0.05, 1.0))
      ->capture_default_str();
  duration(command("dump", "record all buses in candump's format, on stdout", dump));
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, nullptr);
    return chosen(arguments);
  });
}
