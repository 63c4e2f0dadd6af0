// Robots that stand in for hardware, and what calibration finds of them by the project's own tools.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "control/control_setup.hpp"
#include "model/robot_model.hpp"
#include "sim/motor_file.hpp"
#include "sim/variation.hpp"

namespace pmg::evaluation {

/// config/evaluation/table2.yaml: a draw for every leg joint.
struct PlantRanges {
  int plants = 0;
  int seed = 0;
  sim::Range coulomb_Nm, viscous_Nm_s_per_rad, armature_factor, kp_factor, kd_factor, delay_s, zero_offset_rad,
      backlash_rad, stiffness_Nm_per_rad, load_friction;
};

/// Throws model::ConfigError.
PlantRanges load_plant_ranges(const std::filesystem::path& file);

/// Actuators of the policy's joints. Same ranges, robot and number: same plant, on every machine.
sim::ActuatorsByJoint draw_plant(const PlantRanges& ranges, const model::RobotModel& robot, int number);

/// The drives' gains as the policy asks for them, or robot.yaml's.
struct Gains {
  JointVector kp_Nm_per_rad, kd_Nm_s_per_rad;
};

/// Motor calibration (paper III-C.1): every joint of the plant plays an excitation with the limb that hangs on it as
/// its load, at two gains, with encoder noise; gain, damping, rotor, friction and delay are fitted. The recording is
/// the single-joint simulation that MuJoCo's joint is tested against, not a robot on a bench.
sim::ActuatorsByJoint calibrated_motors(const sim::ActuatorsByJoint& plant, const model::RobotModel& robot,
                                        const Gains& gains, unsigned seed);

/// Zero calibration (paper III-C.2): the plant takes the stances of pmg_calibrate_zero --make-stances, steadied by the
/// gantry, and its log is read. Returns offsets (reading less truth) by joint, observable ones only. Everything is
/// written below folder. stop() ends it early with nothing found.
struct FoundOffset {
  std::string joint;
  double zero_offset_rad = 0.0;
};
std::vector<FoundOffset> calibrated_offsets(const sim::ActuatorsByJoint& plant, const model::RobotModel& robot,
                                            const std::filesystem::path& folder, std::uint64_t seed,
                                            const std::function<bool()>& stop);

}  // namespace pmg::evaluation
