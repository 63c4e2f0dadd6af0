#include "buses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <variant>

#include "can/bus_load.hpp"
#include "can/socket_link.hpp"
#include "pmg/types.hpp"
#include "program.hpp"

namespace pmg::apps {
namespace {

std::string row(const drives::MotorSetup& motor, const drives::BusSetup& bus, const can::Answer* answer) {
  const std::string who = fmt::format("{:22} {:6} {:4}  ", motor.joint, bus.name, motor.node);
  if (answer == nullptr) return who + "-";
  const drives::MotorReading joint = motor.transmission.to_joint(answer->reading);
  const auto* cia402 = std::get_if<drives::Cia402Settings>(&motor.drive);
  const bool knows_temperature = cia402 == nullptr || cia402->temperature_index != 0;
  return who + fmt::format("{:8.2f} deg {:8.2f} Nm {:>4} degC  {}", joint.q_rad / kRadPerDegree, joint.torque_Nm,
                           knows_temperature ? fmt::format("{:.0f}", joint.temperature_degC) : "-",
                           drives::to_string(joint.fault));
}

}  // namespace

Buses::Buses(const std::string& robot_name)
    : robot(model::load_robot(model::find_robot(robot_name))), setup(drives::load_drives(robot)) {
  can::check_load(setup);
  for (const drives::BusSetup& bus : setup.buses) {
    links.push_back(std::make_unique<can::SocketLink>(bus.name, std::vector<std::uint32_t>{}, bus.data_bitrate != 0));
  }
}

std::vector<std::string> ask(Buses& buses, const TakeAnswer& take) {
  std::vector<std::string> all;
  for (std::size_t b = 0; b < buses.setup.buses.size(); ++b) {
    const drives::BusSetup& bus = buses.setup.buses[b];
    const std::vector<can::Answer> answers =
        can::ask_bus(bus, *buses.links[b], can::sleeping(), [] { return interrupt_requested != 0; });
    for (const drives::MotorSetup& motor : bus.motors) {
      const auto answer = std::ranges::find(answers, motor.node, &can::Answer::node);
      take(bus, motor, answer == answers.end() ? nullptr : &*answer);
    }
    const std::vector<std::string> found = can::problems(bus, answers);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

std::size_t show(Buses& buses) {
  const std::vector<std::string> all =
      ask(buses, [](const drives::BusSetup& bus, const drives::MotorSetup& motor, const can::Answer* answer) {
        std::cout << row(motor, bus, answer) << '\n';
      });
  for (const std::string& problem : all) std::cout << problem << '\n';
  std::cout << std::flush;
  return all.size();
}

}  // namespace pmg::apps
