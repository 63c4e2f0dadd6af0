#include "drive_questions.hpp"

#include <fmt/format.h>

#include <exception>

#include "can/bus_claim.hpp"
#include "can/canopen_setup.hpp"
#include "can/socket_link.hpp"
#include "drive_protocols/canopen_drive.hpp"

namespace pmg::apps {

namespace {

constexpr drives::ObjectId kRevision{0x1018, 3, 4};  // CiA 301, identity object

doctor::DriveAnswer ask(const can::BusSetup& bus, const drives::MotorSetup& motor, const std::string& kind,
                        can::Link& link) {
  doctor::DriveAnswer answer{.motor = fmt::format("{} ({}, node {})", motor.joint, bus.name, motor.node),
                             .kind = kind,
                             .revision = {},
                             .problem = {}};
  if (drives::as_cia402(motor.drive) == nullptr) return answer;
  try {
    can::SdoClient objects(motor.node, link, can::sleeping());
    answer.revision = objects.read(kRevision);
    if (!answer.revision) answer.problem = "has no object 0x1018:3 (revision)";
  } catch (const std::exception& error) {
    answer.problem = error.what();
  }
  return answer;
}

}  // namespace

std::vector<doctor::DriveAnswer> ask_firmware(const model::RobotModel& robot, const can::DriveSetup& setup) {
  std::vector<doctor::DriveAnswer> answers;
  for (const can::BusSetup& bus : setup.buses) {
    const can::BusClaim claim(bus.name);
    can::SocketLink link(bus.name, {}, bus.data_bitrate != 0);
    for (const drives::MotorSetup& motor : bus.motors) {
      answers.push_back(ask(bus, motor, robot.joints[static_cast<std::size_t>(motor.index)].bus.drive, link));
    }
  }
  return answers;
}

}  // namespace pmg::apps
