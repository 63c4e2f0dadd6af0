#include "controller_doctor.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "doctor/examination.hpp"
#include "doctor/linux_host.hpp"

namespace pmg::apps {

namespace {

/// What this controller asks of the computer. A backend that has a network card for itself has the option `interface`.
doctor::ControllerNeeds needs_of(const ControllerArguments& arguments, const model::RobotModel& robot,
                                 const hal::Backend& backend) {
  doctor::ControllerNeeds needs;
  needs.realtime = !arguments.no_realtime;
  needs.priority = std::max(arguments.threads.bus.priority, arguments.threads.control.priority);
  needs.cpus = {.bus = arguments.threads.bus.cpu, .control = arguments.threads.control.cpu};
  if (!arguments.no_log) needs.log = arguments.log;
  if (arguments.backend.hal() == "can") needs.can_buses = can::load_drives(robot).buses;
  needs.imu = robot.imu.serial;
  const hal::OptionValues configuration = backend.configuration();
  const auto card = configuration.find("interface");
  if (card != configuration.end()) needs.cards.push_back(std::get<std::string>(card->second));
  return needs;
}

}  // namespace

void see_doctor(const ControllerArguments& arguments, const model::RobotModel& robot, const hal::Backend& backend) {
  if (backend.description().set_on_simulator) return;
  const doctor::Findings findings =
      doctor::examine_for_controller(doctor::LinuxHost(), needs_of(arguments, robot, backend));
  for (const doctor::Finding& finding : findings) {
    if (finding.verdict == doctor::Verdict::kFail)
      spdlog::error("doctor: {}: {}; {}", finding.check, finding.found, finding.remedy);
    if (finding.verdict == doctor::Verdict::kWarn) spdlog::warn("doctor: {}: {}", finding.check, finding.found);
  }
  const std::string refusal = doctor::refusal(findings);
  if (refusal.empty()) return;
  if (!arguments.despite_doctor) throw std::runtime_error(refusal);
  spdlog::warn("--despite-doctor: the motors are driven all the same");
}

}  // namespace pmg::apps
