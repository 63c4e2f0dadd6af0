// From what a user names (robot, clips, policy) to a tick: the one place, for the controller, simulation and replay.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "control/tick.hpp"
#include "hal/backend.hpp"
#include "io/clock.hpp"
#include "model/robot_model.hpp"
#include "pmg/clip.hpp"
#include "policy/policy.hpp"

namespace pmg::control {

struct ControlSetup {
  std::string robot = "z1";     ///< name below config/robots, or a folder
  std::filesystem::path clips;  ///< empty: the policy's own, or the robot's (chosen_clips)
  std::string policy;  ///< name below the robot's policies/, or none: drives follow the reference; empty: robot.yaml's
  std::string blend = "library";  ///< how clips are mixed: as the library says, or gain, paper or corners
};

/// What a setup names, read from its files and checked. The tick refers to nothing of it but robot.
struct LoadedControl {
  model::RobotModel robot;
  std::filesystem::path clips;  ///< empty: the policy steps by itself
  ClipLibrary library;          ///< then the standing posture alone
  std::string policy_name;      ///< as ControlSetup's, and never empty
  std::unique_ptr<policy::Policy> policy;
  Variant variant = Variant::kPmg;  ///< the policy's
  TickOptions options;
  std::string bundle;                                      ///< as RunInfo's
  std::vector<std::pair<std::string, std::string>> files;  ///< likewise
};

/// The clip library that a setup runs on: the named one; else clips/ in the folder beside the policy that has its name
/// (policies/NAME/clips of policies/NAME.onnx), so that one name chooses a policy with its clips; else the robot's.
/// Empty for a policy that steps by itself (policies/NAME.yaml). Throws std::invalid_argument when clips are named for
/// such a one.
std::filesystem::path chosen_clips(const ControlSetup& setup, const model::RobotModel& robot);

/// The robot that a setup names. On a policy's own clips it stands as they stand at command 0, which may be another
/// posture than robot.yaml's. Throws files::ConfigError.
model::RobotModel load_robot(const ControlSetup& setup);

/// Throws files::ConfigError or std::invalid_argument.
LoadedControl load_control(const ControlSetup& setup);

/// (limits of a backend, options) => the options of a tick whose commands go to that backend.
void take_limits(const hal::BackendLimits& limits, TickOptions& options);

/// For --version: the bundle that such a setup runs on, and what it is of. Throws as load_control does.
std::string told_bundle(const ControlSetup& setup);

/// Takes the policy out of loaded. Keeps a reference to the stopwatch.
std::unique_ptr<Tick> make_tick(LoadedControl& loaded, const io::Clock& stopwatch);

/// The configuration in force, as --print-config shows it and a log's ROBOT_INFO keeps it.
nlohmann::ordered_json control_json(const LoadedControl& loaded);

/// Back: the options of the tick that such a configuration names; what it doesn't name stays. Throws
/// nlohmann::json::exception when a value is of another type.
void restore_options(const nlohmann::ordered_json& json, TickOptions& options);

}  // namespace pmg::control
