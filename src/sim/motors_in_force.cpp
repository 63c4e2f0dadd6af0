#include "sim/motors_in_force.hpp"

#include <cmath>

#include "files/config_reader.hpp"

namespace pmg::sim {

ActuatorsByJoint motors_in_force(const model::RobotModel& robot, const std::filesystem::path& named) {
  if (named == "none") return {};
  if (!named.empty()) return read_motor_file(named, robot.joint_index);
  files::ConfigReader reader = files::ConfigReader::from_file(robot.directory / "robot.yaml");
  if (!reader.has("motor")) return {};
  return read_motor_file(robot.directory / reader.required<std::string>("motor"), robot.joint_index);
}

model::ActuatorParameters actuator_in_force(const model::Joint& joint, const ActuatorsByJoint& motors) {
  const auto named = motors.find(joint.name);
  model::ActuatorParameters actuator = named == motors.end() ? model::ActuatorParameters{} : named->second;
  if (!std::isfinite(actuator.drive.limit)) actuator.drive.limit = joint.effort_limit_Nm;
  if (actuator.transmission.armature_kg_m2 == 0.0) actuator.transmission.armature_kg_m2 = joint.armature_kg_m2;
  if (actuator.friction == model::ActuatorParameters::Friction{}) {
    actuator.friction.coulomb_Nm = joint.friction_Nm;
    actuator.friction.viscous_Nm_s_per_rad = joint.damping_Nm_s_per_rad;
  }
  return actuator;
}

}  // namespace pmg::sim
