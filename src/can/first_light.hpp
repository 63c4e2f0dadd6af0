// The first movements of a new robot on the gantry: one motor at a time, the others switched off.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "can/bus_setup.hpp"
#include "can/link.hpp"
#include "can/plumb.hpp"
#include "model/hanging_load.hpp"
#include "model/robot_model.hpp"

namespace pmg::can {

struct WiggleOptions {
  /// There, back, and back to the start; nullopt: as far as telling_way_rad says.
  std::optional<double> by_rad{};
  double gain_share = 0.3;  ///< of robot.yaml's kp and kd; a drive in position mode has its own
  double speed_rad_s = 0.1;
  double effort_share = 0.2;  ///< of the joint's effort, besides twice the model's load: more torque ends it
};

/// One joint's movement as its drive reports it, in the joint's own sign.
struct Wiggle {
  double asked_rad = 0.0, moved_rad = 0.0;            ///< from the start to the end of the positive way
  double asked_down_rad = 0.0, moved_down_rad = 0.0;  ///< of the negative way; positive numbers
  double held_Nm = 0.0;                               ///< mean torque of the drive at rest at the two ends
  double model_Nm = 0.0;                              ///< the model's torque to hold the hanging joint there
  double model_inverted_Nm = 0.0;  ///< the same if the motor turned the other way round than robot.yaml has it
  double held_end_Nm = 0.0, model_end_Nm = 0.0;  ///< drive's and model's torque at the end where the load pulls more
  double inverted_end_Nm = 0.0;                  ///< the model's there, if the motor turned the other way round
  double friction_Nm = 0.0;                      ///< within which torques can't be compared
  bool on_stop = false;  ///< an end lies on a stop, which holds some of the load: the mean can't be compared
  /// How far the way would be out of the joint's range if the motor turned the other way round; negative: within it.
  double inverted_beyond_rad = -1.0;
  bool stopped_as_inverted = false;  ///< a way ended where the other way round the joint's range does
  /// How far the base leaned the way that the model says from one end to the other; negative: the opposite way.
  /// Nullopt: no IMU, or the model doesn't say.
  std::optional<double> leaned_rad{};
  double least_lean_rad = 0.0;  ///< that tells: above the noise, and what the base lacked when the joint was back
};

/// How far a hanging joint moves from q until its load is well above three times its friction, so that the drive's
/// torque tells the gear, and until the base leans where the load doesn't tell the direction: 3 to 20 degrees [rad].
double telling_way_rad(const model::RobotModel& robot, const JointVector& q, const std::string& joint,
                       const model::Hanging& hanging = {});

/// Enables the motor, moves the joint forth and back, and disables it whatever happens. Throws std::runtime_error when
/// the motor doesn't answer, reports a fault, starts outside its joint's range, meets more torque than the options
/// allow, or when it was interrupted. q: how the robot hangs [rad], which the model's torque depends on. The gantry
/// holds hanging.held_link; its down_B counts where the plumb says nothing. tick is called every 2 ms and waits;
/// emulators answer in it. plumb: null: the robot has no IMU.
Wiggle wiggle(const model::RobotModel& robot, const JointVector& q, const BusSetup& bus,
              const drives::MotorSetup& motor, Link& link, const WiggleOptions& options,
              const std::function<void()>& tick, const std::function<bool()>& interrupted,
              const model::Hanging& hanging = {}, Plumb* plumb = nullptr);

/// Where the centre of mass of everything beyond the joint goes when the joint turns by +by_rad from the posture q
/// [rad], base upright: "31 mm backward, 4 mm up". This is what the eye compares.
std::string way_of(const model::RobotModel& robot, const JointVector& q, const std::string& joint, double by_rad);

/// The same from one posture to another.
std::string way_between(const model::RobotModel& robot, const JointVector& from, const JointVector& to,
                        const std::string& joint);

struct Verdict {
  enum class Tells : std::uint8_t { kAgrees, kWrong, kNotAll } tells = Tells::kAgrees;
  std::string text;                 ///< one line
  std::vector<std::string> look{};  ///< of a linkage: what the eye would see if it were otherwise, a line each
};

/// What the figures say of direction and gear. A limb that hangs straight down from its joint pulls alike whichever way
/// its motor turns: then the base that leans the other way tells the direction, and without it nothing but the eye.
Verdict verdict(const Wiggle& wiggle);

}  // namespace pmg::can
