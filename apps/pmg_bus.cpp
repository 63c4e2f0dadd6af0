// pmg_bus: bring-up of a robot's drives: roll call, readings, and the motion of one motor at a time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bus_recording.hpp"
#include "buses.hpp"
#include "can/bus_load.hpp"
#include "can/few_motors.hpp"
#include "can/first_light.hpp"
#include "can/level_sole.hpp"
#include "can/linked_wiggle.hpp"
#include "files/nearest_name.hpp"
#include "option_checks.hpp"
#include "pmg/types.hpp"
#include "program.hpp"

namespace {

using namespace pmg;
using apps::Buses;
using std::chrono::milliseconds;

enum ExitCode { kOk = 0, kProblems = 1, kNotTold = 3 };

constexpr int kOffCycles = 5;  // until the drive's answer shows what it is told

constexpr const char* kFooter = R"(
For a robot that hangs in its gantry, limp, with a hard-wired emergency stop at hand. scan, watch and level switch every drive off and
only listen. zero, enable and wiggle touch one motor, or those of one linkage. One program drives a bus: while pmg_controller runs, they refuse, and watch
listens without asking, as dump always does. replay needs no bus.

Example:
  pmg_bus scan --robot z1
  pmg_bus watch --robot z1
  pmg_bus wiggle left_knee --robot z1
  pmg_bus level left_ankle_pitch --robot z1
  pmg_bus dump --robot z1 >first.log
  pmg_bus replay first.log --robot z1

Exit codes: 0 all is well, 1 a drive has a problem, 2 bad input, or a bus that can't be opened, 3 wiggle or level could
not tell direction or gear.
docs/how-to/hal.md has the order of a bring-up.)";

struct Arguments {
  std::string robot = "z1", joint, recording, held;
  double by_deg = 0.0, for_s = 0.0, gain_share = 0.3;
  bool yes = false;
};

bool interrupted() { return apps::interrupt_requested != 0; }

int scan(const Arguments& arguments) {
  Buses buses(arguments.robot);
  for (const can::BusSetup& bus : buses.setup.buses) {
    const can::BusLoad load = can::planned_load(bus);
    std::cout << fmt::format("{}: {} motors{}, {} frames a cycle, at most {:.0f} % of the bus\n", bus.name,
                             bus.motors.size(), bus.imu ? " and the IMU" : "", load.frames, 100.0 * load.share);
  }
  return apps::show(buses, apps::Whom::kAll) == 0 ? kOk : kProblems;
}

/// Asks; where another program drives the buses, it listens to what that program's drives say.
int watch(const Arguments& arguments) {
  std::optional<Buses> buses;
  std::optional<apps::Overhearing> overhearing;
  std::string driven;
  try {
    buses.emplace(arguments.robot);
  } catch (const can::BusIsDriven& taken) {
    driven = taken.what();
    overhearing.emplace(buses.emplace(arguments.robot, Buses::Use::kListen));
  }
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(arguments.for_s > 0.0 ? arguments.for_s : 1e9);
  std::size_t problems = 0;
  while (!interrupted() && std::chrono::steady_clock::now() < end) {
    std::cout << "\x1b[H\x1b[2J";
    if (overhearing) {
      std::cout << driven << ". Only listening:\n";
      problems = overhearing->show();
    } else {
      problems = apps::show(*buses);
      std::this_thread::sleep_for(milliseconds(200));
    }
  }
  return problems == 0 ? kOk : kProblems;
}

struct OneMotor {
  const can::BusSetup& bus;
  const drives::MotorSetup& motor;
  can::Link& link;
};

/// The buses, which are opened only where the joint is one of the robot's.
Buses open_for(const Arguments& arguments) {
  const model::RobotModel robot = model::load_robot(model::find_robot(arguments.robot));
  if (!robot.joint_index.find(arguments.joint))
    throw std::invalid_argument(fmt::format("'{}' isn't a joint; {}", arguments.joint,
                                            files::expected_name(arguments.joint, robot.joint_index.names())));
  return Buses(arguments.robot);
}

OneMotor find(Buses& buses, const std::string& joint) {
  for (std::size_t b = 0; b < buses.setup.buses.size(); ++b) {
    for (const drives::MotorSetup& motor : buses.setup.buses[b].motors) {
      if (motor.joint == joint) return {buses.setup.buses[b], motor, *buses.links[b]};
    }
  }
  throw std::invalid_argument(fmt::format("{}'s motor is on none of robot.yaml's CAN buses", joint));
}

/// Waits for the next bus cycle. Cycles that a busy computer missed are not made up for: in a burst no drive could
/// answer.
std::function<void()> bus_tick() {
  using Clock = std::chrono::steady_clock;
  return [next = Clock::now()]() mutable {
    next = std::max(next + milliseconds(2), Clock::now() + milliseconds(1));
    std::this_thread::sleep_until(next);
  };
}

int enable(const Arguments& arguments) {
  Buses buses = open_for(arguments);
  const OneMotor one = find(buses, arguments.joint);
  const std::function<void()> tick = bus_tick();
  can::FewMotors motor(one.bus, one.motor, one.link, tick);
  const bool on = motor.switch_on();
  const drives::MotorReading at = motor.reading();
  for (int k = 0; k < kOffCycles; ++k) motor.exchange_off();
  const drives::DriveFault fault = motor.reading().fault;
  if (!on) {
    std::cout << fmt::format("{} can't be enabled: {}\n", arguments.joint, drives::to_string(fault));
    return kProblems;
  }
  std::cout << fmt::format("{} was enabled without a command and disabled again: {:.2f} deg, {}\n", arguments.joint,
                           at.q_rad / kRadPerDegree, drives::to_string(fault));
  return fault == drives::DriveFault::kNone ? kOk : kProblems;
}

int zero(const Arguments& arguments) {
  if (!arguments.yes) {
    throw std::invalid_argument(
        "zero overwrites the drive's zero for good; expected --yes when the joint stands at its zero position");
  }
  Buses buses = open_for(arguments);
  const OneMotor one = find(buses, arguments.joint);
  const std::function<void()> tick = bus_tick();
  can::FewMotors motor(one.bus, one.motor, one.link, tick);
  const double before_rad = motor.reading().q_rad;
  const double offset_rad = buses.robot.joints[static_cast<std::size_t>(one.motor.index)].bus.zero_offset_rad;
  if (!motor.set_zero()) {
    std::cout << fmt::format(
        "{} is at {:.2f} deg. Its drive's protocol has no message that sets a zero: write `zero_offset_rad: {:.4f}` "
        "into its `bus` in robot.yaml\n",
        arguments.joint, before_rad / kRadPerDegree, before_rad + offset_rad);
    return kOk;
  }
  for (int k = 0; k < kOffCycles; ++k) motor.exchange_off();
  const double after_rad = motor.reading().q_rad;
  std::cout << fmt::format("{}: was {:.2f} deg, is {:.2f} deg now\n", arguments.joint, before_rad / kRadPerDegree,
                           after_rad / kRadPerDegree);
  return std::abs(after_rad + offset_rad) < kRadPerDegree ? kOk : kProblems;
}

/// How the robot hangs [rad]; joints whose motors don't answer as if they stood, their names in `silent`.
JointVector posture(Buses& buses, std::vector<std::string>& silent) {
  JointVector q = buses.robot.q_stand();
  apps::ask(buses, [&](const can::BusSetup& bus, const drives::Readings& motors) {
    const drives::Readings joints = drives::joint_readings(bus, motors);
    for (std::size_t m = 0; m < joints.size(); ++m) {
      if (!joints[m])
        silent.push_back(bus.motors[m].joint);
      else
        q[bus.motors[m].index] = joints[m]->q_rad;
    }
  });
  return q;
}

/// Where down is, before anything moves.
model::Hanging hangs(Buses& buses, const OneMotor& one, const JointVector& q, can::Plumb* plumb,
                     const std::function<void()>& tick, const std::string& held) {
  model::Hanging hanging{.held_link = held.empty() ? buses.robot.torso_link : held};
  if (!buses.robot.tree.getSegments().contains(hanging.held_link))
    throw std::invalid_argument(fmt::format("'{}' isn't a link; expected --held LINK of the URDF", hanging.held_link));
  std::optional<can::Plumb::Sample> sample;
  constexpr int kImuCycles = 50;  // 0.1 s
  for (int k = 0; plumb != nullptr && k < kImuCycles && !sample; ++k) {
    tick();
    std::array<drives::Message, 64> messages;
    while (const std::size_t count = one.bus.imu ? one.link.receive(messages) : 0) {
      for (const drives::Message& message : std::span(messages).first(count)) plumb->hear(message);
    }
    sample = plumb->sample(q);
  }
  if (!sample) {
    std::cout << "no IMU on a bus speaks: the base counts as upright, and how it leans is not seen\n";
    return hanging;
  }
  hanging.down_B = sample->down_B;
  std::cout << fmt::format("the base leans by {:.1f} deg\n",
                           std::acos(std::clamp(-hanging.down_B.z(), -1.0, 1.0)) / kRadPerDegree);
  return hanging;
}

int told(const can::Verdict& verdict) {
  using Tells = can::Verdict::Tells;
  std::cout << verdict.text << '\n';
  for (const std::string& line : verdict.look) std::cout << "  " << line << '\n';
  return verdict.tells == Tells::kAgrees ? kOk : (verdict.tells == Tells::kWrong ? kProblems : kNotTold);
}

int wiggle_one(Buses& buses, const OneMotor& one, const Arguments& arguments, const JointVector& q,
               const std::function<void()>& tick, const model::Hanging& hanging, can::Plumb* plumb) {
  const double by_rad = arguments.by_deg > 0.0 ? arguments.by_deg * kRadPerDegree
                                               : can::telling_way_rad(buses.robot, q, arguments.joint, hanging);
  std::cout << fmt::format("{} moves by {:.1f} deg there and back. For + the model's limb goes: {}\n", arguments.joint,
                           by_rad / kRadPerDegree, can::way_of(buses.robot, q, arguments.joint, by_rad))
            << std::flush;
  const can::Wiggle result =
      can::wiggle(buses.robot, q, one.bus, one.motor, one.link, {.by_rad = by_rad, .gain_share = arguments.gain_share},
                  tick, interrupted, hanging, plumb);
  std::cout << fmt::format(
      "asked {:.2f} deg, moved {:.2f} deg; holds {:.2f} Nm, the model {:.2f} Nm: ", result.asked_rad / kRadPerDegree,
      result.moved_rad / kRadPerDegree, result.held_Nm, result.model_Nm);
  return told(can::verdict(result));
}

/// The joint's linkage: all of its joints, one after the other.
int wiggle_rods(Buses& buses, const OneMotor& one, const Arguments& arguments, const JointVector& q,
                const std::function<void()>& tick, const model::Hanging& hanging, can::Plumb* plumb) {
  can::WiggleOptions options{.gain_share = arguments.gain_share};
  if (arguments.by_deg > 0.0) options.by_rad = arguments.by_deg * kRadPerDegree;
  constexpr double kShown_rad = 5.0 * kRadPerDegree;
  for (const std::string& joint : can::linked_joints(one.bus, one.motor)) {
    std::cout << fmt::format(
        "{} moves there and back, its linkage's motors together. For + the model's limb goes: {}\n", joint,
        can::way_of(buses.robot, q, joint, options.by_rad.value_or(kShown_rad)));
  }
  std::cout << std::flush;
  const std::vector<can::LinkedWay> ways =
      can::wiggle_linked(buses.robot, q, one.bus, one.motor, one.link, options, tick, interrupted, hanging, plumb);
  for (const can::LinkedWay& way : ways) {
    std::cout << fmt::format("{}: asked {:.2f} deg, moved {:.2f} deg\n", way.joint, way.asked_rad / kRadPerDegree,
                             way.moved_rad / kRadPerDegree);
  }
  return told(can::verdict(buses.robot, q, one.bus, one.motor, ways, hanging));
}

/// The robot before anything moves: its joints, and where down is.
struct AtRest {
  AtRest(Buses& buses, const OneMotor& one, const Arguments& arguments, const std::function<void()>& tick)
      : q(posture(buses, silent)) {
    std::vector<std::string> others = silent;
    std::erase(others, arguments.joint);
    if (!others.empty()) {
      std::cout << fmt::format("{} of the other motors don't answer ({}, ...): the model has their joints standing\n",
                               others.size(), others.front());
    }
    for (std::size_t b = 0; b < buses.setup.buses.size(); ++b) {
      const can::BusSetup& bus = buses.setup.buses[b];
      if (bus.imu) imu.emplace(buses.robot, &bus == &one.bus ? nullptr : buses.links[b].get());
    }
    hanging = hangs(buses, one, q, plumb(), tick, arguments.held);
  }
  can::Plumb* plumb() { return imu ? &*imu : nullptr; }

  std::vector<std::string> silent;  // joints
  JointVector q;
  std::optional<can::Plumb> imu;
  model::Hanging hanging;
};

int wiggle(const Arguments& arguments) {
  Buses buses = open_for(arguments);
  const OneMotor one = find(buses, arguments.joint);
  const std::function<void()> tick = bus_tick();
  AtRest rest(buses, one, arguments, tick);
  return can::linked_joints(one.bus, one.motor).empty()
             ? wiggle_one(buses, one, arguments, rest.q, tick, rest.hanging, rest.plumb())
             : wiggle_rods(buses, one, arguments, rest.q, tick, rest.hanging, rest.plumb());
}

int level(const Arguments& arguments) {
  Buses buses = open_for(arguments);
  const OneMotor one = find(buses, arguments.joint);
  const AtRest rest(buses, one, arguments, bus_tick());
  std::vector<std::string> joints = can::linked_joints(one.bus, one.motor);
  joints.push_back(arguments.joint);
  for (const std::string& joint : joints) {
    if (std::ranges::find(rest.silent, joint) != rest.silent.end())
      throw std::runtime_error(joint + " has no angle; expected one: `pmg_bus scan` says why");
  }
  return told(can::verdict_of_level_sole(buses.robot, rest.q, one.bus, one.motor, rest.hanging.down_B));
}

int dump(const Arguments& arguments) { return apps::dump_buses(arguments.robot, arguments.for_s); }
int replay(const Arguments& arguments) { return apps::replay_recording(arguments.robot, arguments.recording); }

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
  command("scan", "switch all drives off and ask every node that the buses' protocols can have", scan);
  duration(command("watch", "the same again and again: move the joints by hand and look", watch));
  joint(command("enable", "enable one drive without a command, and disable it", enable));
  CLI::App* zeroing =
      command("zero", "the joint's present position becomes its drive's zero, or robot.yaml's offset", zero);
  joint(zeroing);
  zeroing->add_flag("--yes", arguments.yes, "the joint stands at its zero position");
  CLI::App* wiggling = command("wiggle", "move one joint by a few degrees and compare with the model", wiggle);
  joint(wiggling);
  wiggling->add_option("--by", arguments.by_deg, "degrees; not given: 3 to 20, until its load tells the gear")
      ->check(apps::in_range(0.5, 20.0));
  wiggling->add_option("--gains", arguments.gain_share, "share of robot.yaml's gains")
      ->check(apps::in_range(0.05, 1.0))
      ->capture_default_str();
  wiggling->add_option("--held", arguments.held, "the link that the gantry holds; not given: robot.yaml's torso_link");
  joint(command("level", "the sole below this joint lies level: tell how the motors are connected; moves nothing",
                level));
  command("replay", "what the backend says of a recording in candump's format", replay)
      ->add_option("recording", arguments.recording, "a file that dump or candump -L wrote")
      ->required();
  duration(command("dump", "record all buses in candump's format, on stdout", dump));
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, nullptr);
    return chosen(arguments);
  });
}
