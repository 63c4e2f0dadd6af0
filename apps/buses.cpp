#include "buses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <span>
#include <thread>

#include "can/bus_ids.hpp"
#include "can/bus_load.hpp"
#include "can/socket_link.hpp"
#include "doctor/can_link.hpp"
#include "doctor/checks.hpp"
#include "pmg/types.hpp"
#include "program.hpp"

namespace pmg::apps {
namespace {

std::string row(const drives::MotorSetup& motor, const can::BusSetup& bus, const can::Answer* answer) {
  const std::string who = fmt::format("{:22} {:6} {:4}  ", motor.joint, bus.name, motor.node);
  if (answer == nullptr) return who + "-";
  const drives::MotorReading joint = motor.transmission.to_joint(answer->reading);
  return who + fmt::format("{:8.2f} deg {:8.2f} Nm {:>4} degC  {}", joint.q_rad / kRadPerDegree, joint.torque_Nm,
                           motor.drive->tells_temperature() ? fmt::format("{:.0f}", joint.temperature_degC) : "-",
                           drives::to_string(joint.fault));
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

std::vector<std::string> ask(Buses& buses, const TakeAnswer& take) {
  std::vector<std::string> all;
  for (std::size_t b = 0; b < buses.setup.buses.size(); ++b) {
    const can::BusSetup& bus = buses.setup.buses[b];
    can::OtherFrames others;
    const std::vector<can::Answer> answers = can::ask_bus(
        bus, *buses.links[b], can::sleeping(), [] { return interrupt_requested != 0; }, &others);
    for (const drives::MotorSetup& motor : bus.motors) {
      const auto answer = std::ranges::find(answers, motor.node, &can::Answer::node);
      take(bus, motor, answer == answers.end() ? nullptr : &*answer);
    }
    const std::vector<std::string> found = can::problems(bus, answers);
    all.insert(all.end(), found.begin(), found.end());
    if (found.empty()) continue;  // what else is on the bus does no harm
    for (const std::string& line : others.lines(bus)) all.push_back(line);
    const std::string controller = can::controller_line(bus, *buses.links[b]);
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
      std::cout << row(*heard.motor, bus, known ? &heard.answer : nullptr) << '\n';
      if (known) answers.push_back(heard.answer);
    }
    const std::vector<std::string> found = can::problems(bus, answers);
    all.insert(all.end(), found.begin(), found.end());
  }
  for (const std::string& problem : all) std::cout << problem << '\n';
  std::cout << std::flush;
  return all.size();
}

std::size_t show(Buses& buses) {
  const std::vector<std::string> all =
      ask(buses, [](const can::BusSetup& bus, const drives::MotorSetup& motor, const can::Answer* answer) {
        std::cout << row(motor, bus, answer) << '\n';
      });
  for (const std::string& problem : all) std::cout << problem << '\n';
  std::cout << std::flush;
  return all.size();
}

}  // namespace pmg::apps
