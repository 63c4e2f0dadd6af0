// Robots that replace hardware, and their calibration by the project's own tools.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "calib/single_joint.hpp"
#include "control/control_setup.hpp"
#include "model/robot_model.hpp"
#include "sim/motor_file.hpp"
#include "sim/variation.hpp"
#include "work/progress.hpp"

namespace pmg::evaluation {

/// config/evaluation/table2.yaml: distributions for every leg joint.
struct PlantRanges {
  int plants = 0;
  int seed = 0;
  sim::Range coulomb_Nm, viscous_Nm_s_per_rad, armature_factor, kp_factor, kd_factor, delay_s, zero_offset_rad,
      backlash_rad, stiffness_Nm_per_rad, load_friction;
};

/// Throws files::ConfigError.
PlantRanges load_plant_ranges(const std::filesystem::path& file);

/// Actuators of the policy's joints. The same ranges, robot and number give the same plant on every machine.
sim::ActuatorsByJoint draw_plant(const PlantRanges& ranges, const model::RobotModel& robot, int number);

/// The drives' gains from the policy, or else robot.yaml's.
struct Gains {
  JointVector kp_Nm_per_rad, kd_Nm_s_per_rad;
};

/// Recordings of one joint of a plant, at two gains and with encoder noise. Its load is the limb that hangs from it, in
/// half of the runs with a known weight on the limb.
std::vector<calib::SingleJoint> record_joint(const bench::Bench& bench, const model::RobotModel& robot,
                                             const std::string& joint, const model::ActuatorParameters& truth,
                                             const Gains& gains, unsigned seed);

/// Motor calibration (paper III-C.1, eq. 20). Every joint of the plant plays an excitation (record_joint). Gain,
/// damping, rotor, friction and delay are fitted. The recording comes from the single-joint simulation that agrees with
/// MuJoCo's joint in tests, not from a robot on a bench.
sim::ActuatorsByJoint calibrated_motors(const sim::ActuatorsByJoint& plant, const model::RobotModel& robot,
                                        const Gains& gains, unsigned seed);

/// Zero calibration (paper III-C.2, eq. 21 to 25). The plant takes the stances of pmg_calibrate_zero --make-stances,
/// steadied by the gantry; its log is evaluated. Returns the offsets (reading minus true angle) of the
/// joints whose zero points are known well or roughly.
/// All files are below folder. After an interruption it returns nothing.
struct FoundOffset {
  std::string joint;
  double zero_offset_rad = 0.0;
  bool well = false;  ///< known well; otherwise roughly (zero::Known)
};
std::vector<FoundOffset> calibrated_offsets(const sim::ActuatorsByJoint& plant, const model::RobotModel& robot,
                                            const std::filesystem::path& folder, std::uint64_t seed,
                                            const work::Progress& progress);

}  // namespace pmg::evaluation
