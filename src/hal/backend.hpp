// One way to a robot's drives, and the services that it offers beside them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "hal/command_guard.hpp"
#include "hal/hal.hpp"
#include "hal/hoist_line.hpp"
#include "io/clock.hpp"
#include "model/ground_truth.hpp"
#include "model/robot_model.hpp"

namespace pmg::hal {

/// The value of one option of a backend; the alternative is its type on the command line.
using OptionValue = std::variant<bool, std::uint64_t, double, std::string>;
using OptionValues = std::map<std::string, OptionValue>;  ///< by option name

/// What every backend is made from. A backend with a configuration file has an option that names the file, or finds it
/// in robot.directory; it reads the file through files::ConfigReader.
struct BackendSetup {
  const model::RobotModel& robot;  ///< outlives the backend
  const io::Clock& clock;          ///< of the run; outlives the backend
  std::string name;                ///< the controller's, to which operators address their messages
  std::string lcm_url;             ///< where the controller hears operators
  std::string benched_joint;       ///< this joint is excited while the robot hangs, base held fast; empty: none
  bool keeps_truth = false;        ///< somebody calls take_truth()
  OptionValues options;            ///< every option that the backend has declared
};

/// Limits that depend on drives and bus. Those without a value stay as the controller has them.
struct BackendLimits {
  GuardOptions guard;                   ///< largest gains; age of a command
  std::optional<double> stale_state_s;  ///< a state older than this is stale
  std::optional<int> overrun_ticks;     ///< so many control periods in a row that end late are a fault
  bool waits = false;                   ///< physics stand still while the controller is late: of simulations alone
};

/// What a log says of the backend that made it, for those who use the log.
struct BackendDescription {
  /// Time between two positions that a drive takes from its sensor for its own loop [s]; 0: much shorter than a control
  /// tick. nullopt: unknown.
  std::optional<double> drive_sampling_s{};
  /// From the moment in which the drives had a state to the one in which they take the command computed from it, while
  /// no tick is late [s]. nullopt: unknown.
  std::optional<double> command_delay_s{};
  /// Joints, and perhaps the IMU, whose state is older than the others' in the same sample [s].
  std::vector<std::string> older_joints{};
  bool older_imu = false;
  double older_by_s = 0.0;
  /// Joints whose drives obey torques: the bus thread closes their position loop, from positions and speeds that are so
  /// old on average while their torque acts [s].
  std::vector<std::string> closed_by_bus{};
  double bus_loop_age_s = 0.0;
  /// Joints whose drives move with robot.yaml's gains alone and know no target speed: what excites a robot lets both
  /// be.
  std::vector<std::string> own_gains{};
  /// Of a simulation: what was set on it beside the robot's files, one line each. nullopt: hardware.
  std::optional<std::vector<std::string>> set_on_simulator{};
};

/// What only a simulation knows of one bus cycle.
struct TruthSample {
  std::uint64_t bus_sample = 0;  ///< of the state that the controller got in the same cycle
  model::GroundTruth truth;
  bool hoisted = false;  ///< the gantry carries the robot
};

/// A window on the robot, whose keys drive it. For the main thread.
class Window {
 public:
  virtual ~Window() = default;
  virtual void show() = 0;          ///< the robot, from now on
  virtual void listen() = 0;        ///< takes what was typed; to be called every 10 ms or so
  virtual bool closed() const = 0;  ///< by the user
  virtual void let_go() = 0;        ///< velocity to zero, then Stand; returns when that is so, after seconds at most
};

/// Its constructor reads and checks the configuration and touches neither bus nor screen. It throws files::ConfigError
/// or std::invalid_argument. The main thread makes, connects and destroys it.
class Backend {
 public:
  virtual ~Backend() = default;

  /// The configuration in force, for --print-config and logs.
  virtual OptionValues configuration() const = 0;
  virtual BackendLimits limits() const { return {}; }
  virtual BackendDescription description() const { return {}; }

  /// Opens bus and windows. Called once; the services below exist afterwards. From then on the bus thread alone uses
  /// the drives. A backend that waits for its drives asks interrupted() and gives up when that is true. Throws
  /// std::runtime_error: one line.
  virtual Hal& connect(const std::function<bool()>& interrupted) = 0;

  /// What has changed with the drives since the last call, one line for people ("left_knee (can0, node 4) does not
  /// answer"); empty: nothing. For one thread, after connect().
  virtual std::string news() { return {}; }

  virtual HoistLine* hoist() noexcept { return nullptr; }  ///< null: nothing carries the robot
  virtual Window* window() noexcept { return nullptr; }    ///< null: none was asked for
  /// The truth of this bus cycle; null: unknown. For one thread; older samples are given up.
  virtual const TruthSample* take_truth(std::uint64_t /*bus_sample*/) noexcept { return nullptr; }
};

}  // namespace pmg::hal
