#include "sim/motors_in_force.hpp"

#include "model/config_reader.hpp"

namespace pmg::sim {

ActuatorsByJoint motors_in_force(const model::RobotModel& robot, const std::filesystem::path& named) {
  if (named == "none") return {};
  if (!named.empty()) return read_motor_file(named, robot.joint_index);
  model::ConfigReader reader = model::ConfigReader::from_file(robot.directory / "robot.yaml");
  if (!reader.has("motor")) return {};
  return read_motor_file(robot.directory / reader.required<std::string>("motor"), robot.joint_index);
}

}  // namespace pmg::sim
