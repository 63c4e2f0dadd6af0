#include "buses.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iostream>
#include <span>
#include <thread>

#include "can/bus_ids.hpp"
#include "can/bus_load.hpp"
#include "can/linked_wiggle.hpp"
#include "can/socket_link.hpp"
#include "doctor/can_link.hpp"
#include "doctor/checks.hpp"
#include "drive_protocols/canopen.hpp"
#include "pmg/types.hpp"
#include "program.hpp"

namespace pmg::apps {
namespace {

std::string values(const drives::MotorSetup& motor, const drives::MotorReading& reading) {
  return fmt::format("{:8.2f} deg {:8.2f} Nm {:>4} degC  {}", reading.q_rad / kRadPerDegree, reading.torque_Nm,
                     motor.drive->tells_temperature() ? fmt::format("{:.0f}", reading.temperature_degC) : "-",
                     drives::to_string(reading.fault));
}

/// A row for each motor; of a linkage, its crank's values, and then a row for each joint.
void print_rows(const can::BusSetup& bus, const drives::Readings& motors) {
  const drives::Readings joints = drives::joint_readings(bus, motors);
  std::vector<std::string> linked;  // rows
  for (std::size_t m = 0; m < bus.motors.size(); ++m) {
    const drives::MotorSetup& motor = bus.motors[m];
    const std::vector<std::string> names = can::linked_joints(bus, motor);
    std::cout << fmt::format("{:22} {:6} {:4}  ", motor.joint, bus.name, motor.node)
              << (motors[m] ? values(motor, motor.transmission.to_joint(*motors[m])) : "-")
              << (names.empty()       ? ""
                  : names.size() == 1 ? "  (its crank)"
                                      : fmt::format("  (its crank; {} turn together)", fmt::join(names, " and ")))
              << '\n';
    if (names.empty()) continue;
    linked.push_back(
        fmt::format("{:22} {:6} joint  ", motor.joint, bus.name) +
        (joints[m] ? fmt::format("{:8.2f} deg {:8.2f} Nm", joints[m]->q_rad / kRadPerDegree, joints[m]->torque_Nm)
                   : "-"));
  }
  for (const std::string& line : linked) std::cout << line << '\n';
}

/// Whom else was asked, and who answered.
std::string line_of(const can::BusSetup& bus, const can::Strangers& strangers) {
  if (!strangers.why_not.empty())
    return fmt::format("{}: nodes that robot.yaml doesn't have were not asked: {}", bus.name, strangers.why_not);
  const int canopen = bus.has_canopen() ? static_cast<int>(drives::canopen::kHostNode) : 0;
  return fmt::format("{}: {} other nodes were asked{}; {} of them answered", bus.name, strangers.asked,
                     canopen > 0 ? fmt::format(", and CANopen's up to {}", canopen) : "", strangers.answers.size());
}

/// What the interface's controller has, where that isn't robot.yaml's; empty: the same, or the kernel doesn't tell.
std::string interface_rate(const can::BusSetup& bus) {
  int error = 0;
  const auto link = doctor::ask_can_link(bus.name, error);
  if (!link || link->kind != "can") return {};
  const doctor::Finding finding = doctor::bitrate_finding(bus, *link);
  return finding.verdict == doctor::Verdict::kOk ? std::string() : finding.check + ": " + finding.found;
}

}  // namespace

Buses::Buses(const std::string& robot_name, Use use)
    : robot(model::load_robot(model::find_robot(robot_name))), setup(can::load_drives(robot)) {
  can::check_load(setup);
  can::check_ids(setup);
  for (const can::BusSetup& bus : setup.buses) {
    if (use == Use::kDrive) claims.emplace_back(bus.name);
    links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
  }
}

std::vector<std::string> ask(Buses& buses, const TakeReadings& take, Whom whom) {
  std::vector<std::string> all;
  const auto interrupted = [] { return interrupt_requested != 0; };
  for (std::size_t b = 0; b < buses.setup.buses.size(); ++b) {
    const can::BusSetup& bus = buses.setup.buses[b];
    can::Link& link = *buses.links[b];
    can::OtherFrames others;
    std::vector<can::Answer> answers = can::ask_bus(bus, link, can::sleeping(), interrupted, &others);
    take(bus, can::motor_readings(bus, answers));
    if (whom == Whom::kAll) {
      const can::Strangers strangers = can::ask_strangers(bus, link, can::sleeping(), interrupted, &others);
      std::cout << line_of(bus, strangers) << '\n';
      answers.insert(answers.end(), strangers.answers.begin(), strangers.answers.end());
    }
    const std::vector<std::string> found = can::problems(bus, answers);
    all.insert(all.end(), found.begin(), found.end());
    if (found.empty()) continue;  // what else is on the bus does no harm
    for (const std::string& line : others.lines(bus)) all.push_back(line);
    const std::string controller = can::controller_line(bus, link);
    if (!controller.empty()) all.push_back(controller);
    const std::string rate = interface_rate(bus);
    if (!rate.empty()) all.push_back(rate);
  }
  return all;
}

Overhearing::Overhearing(Buses& buses) : buses_(buses) {
  for (const can::BusSetup& bus : buses.setup.buses) {
    auto& motors = heard_.emplace_back();
    for (const drives::MotorSetup& motor : bus.motors)
      motors.push_back({.motor = &motor,
                        .protocol = motor.drive->protocol(motor.node, motor.limits, bus.data_bitrate != 0),
                        .answer = {.node = motor.node, .count = 1}});
  }
}

void Overhearing::listen() {
  for (std::size_t b = 0; b < heard_.size(); ++b) {
    std::array<drives::Message, 64> frames;
    while (const std::size_t count = buses_.links[b]->receive(frames)) {
      for (const drives::Message& frame : std::span(frames).first(count)) {
        for (Heard& heard : heard_[b]) {
          const drives::Heard said = heard.protocol->hear(frame);
          if (said.what != drives::Heard::What::kReading) continue;
          heard.answer.reading = said.reading;
          heard.at = std::chrono::steady_clock::now();
        }
      }
    }
  }
}

std::size_t Overhearing::show() {
  constexpr std::chrono::milliseconds kWindow(200), kKept(2000), kNap(1);
  const auto begin = std::chrono::steady_clock::now();
  while (interrupt_requested == 0 && std::chrono::steady_clock::now() < begin + kWindow) {
    listen();
    std::this_thread::sleep_for(kNap);
  }
  std::vector<std::string> all;
  for (std::size_t b = 0; b < heard_.size(); ++b) {
    const can::BusSetup& bus = buses_.setup.buses[b];
    std::vector<can::Answer> answers;
    for (const Heard& heard : heard_[b]) {
      const bool known =
          heard.at.time_since_epoch().count() != 0 && std::chrono::steady_clock::now() < heard.at + kKept;
      if (known) answers.push_back(heard.answer);
    }
    print_rows(bus, can::motor_readings(bus, answers));
    const std::vector<std::string> found = can::problems(bus, answers);
    all.insert(all.end(), found.begin(), found.end());
  }
  for (const std::string& problem : all) std::cout << problem << '\n';
  std::cout << std::flush;
  return all.size();
}

std::size_t show(Buses& buses, Whom whom) {
  const std::vector<std::string> all = ask(buses, print_rows, whom);
  for (const std::string& problem : all) std::cout << problem << '\n';
  std::cout << std::flush;
  return all.size();
}

}  // namespace pmg::apps
