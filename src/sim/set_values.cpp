#include "sim/set_values.hpp"

#include <fmt/format.h>

#include <utility>

#include "sim/motors_in_force.hpp"

namespace pmg::sim {

namespace {

class SetValues {
 public:
  SetValues(const model::RobotModel& robot, const WorldOptions& options) : robot_(robot), options_(options) {}

  std::vector<std::string> lines() {
    drives();
    variation();
    const WorldOptions usual;
    number("ground friction", options_.floor_friction, usual.floor_friction, "");
    number("noise of the gyro", options_.gyro_noise_rad_s, 0.0, " rad/s");
    number("noise of encoders", options_.encoder_noise_rad, 0.0, " rad");
    number("noise of measured speeds", options_.velocity_noise_rad_s, 0.0, " rad/s");
    number("noise of the orientation", options_.orientation_noise_rad, 0.0, " rad");
    return std::move(lines_);
  }

 private:
  void number(const std::string& what, double value, double without, const char* unit) {
    if (value != without) lines_.push_back(fmt::format("{} = {:.4g}{}, without it {:.4g}", what, value, unit, without));
  }

  void drives() {
    for (const model::Joint& joint : robot_.joints) {
      if (!options_.motors.contains(joint.name)) continue;
      const model::ActuatorParameters set = actuator_in_force(joint, options_.motors),
                                      own = actuator_in_force(joint, {});
      for (const model::ActuatorParameter& p : model::actuator_parameters()) {
        number(fmt::format("{}: {}", joint.name, p.name), p.value(set), p.value(own),
               fmt::format(" {}", unit(p.quantity)).c_str());
      }
    }
  }

  void of_joints(const char* what, const JointVector& values, double without, const char* unit) {
    for (Eigen::Index j = 0; j < values.size(); ++j)
      number(fmt::format("{}: {}", robot_.joint_index.name(static_cast<int>(j)), what), values[j], without, unit);
  }

  void variation() {
    const Variation& v = options_.variation;
    for (const auto& [link, factor] : v.link_mass_factor) number(link + ": factor of its mass", factor, 1.0, "");
    number("mass added to the torso", v.torso_mass_kg, 0.0, " kg");
    for (const auto& [axis, name] : {std::pair{0, "x"}, std::pair{1, "y"}, std::pair{2, "z"}})
      number(fmt::format("shift of the torso's centre of mass along {}", name), v.torso_center_of_mass_m[axis], 0.0,
             " m");
    for (const Foot side : {kLeft, kRight})
      number(side == kLeft ? "payload of the left hand" : "payload of the right hand", v.hand_payload_kg[side], 0.0,
             " kg");
    of_joints("factor of its armature", v.armature_factor, 1.0, "");
    of_joints("factor of its dry friction", v.joint_friction_factor, 1.0, "");
    of_joints("factor of kp", v.kp_factor, 1.0, "");
    of_joints("factor of kd", v.kd_factor, 1.0, "");
    of_joints("offset of its encoder", v.encoder_offset_rad, 0.0, " rad");
    number("delay of commands", v.delay_s, 0.0, " s");
  }

  const model::RobotModel& robot_;
  const WorldOptions& options_;
  std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> set_values(const model::RobotModel& robot, const WorldOptions& options) {
  return SetValues(robot, options).lines();
}

}  // namespace pmg::sim
