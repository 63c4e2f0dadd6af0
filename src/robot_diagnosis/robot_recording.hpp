// A whole robot's recording, tick by tick: sensor readings and commands, no ground truth.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "robot_diagnosis/drive_sampling.hpp"
#include "sim/world.hpp"
#include "work/progress.hpp"

namespace pmg::robot_diagnosis {

/// A state and the command computed from it. The command acts from the next bus cycle until the next tick's command.
struct RobotTick {
  double t_s = 0.0;  ///< of the state
  model::RobotState state;
  model::JointCommand command;
};

/// Where a recording was made.
struct RecordingSource {
  std::string backend{};   ///< of the controller; "" if the log doesn't say
  bool simulated = false;  ///< else hardware, as far as the log says
  /// What was set on the simulator beside the robot's files, one line each; nullopt: the log doesn't say.
  std::optional<std::vector<std::string>> set_on_simulator{};
};

/// (ROBOT_INFO's backend, its options as JSON) => (source).
RecordingSource recording_source(const std::string& backend, const std::string& options);

/// One line for people: what was set on the simulator, or that nothing was, or that nothing can be.
std::string source_text(const RecordingSource& source);

/// Ticks at a constant period. A gap in a log starts a new recording.
struct RobotRecording {
  std::string name;  ///< short name of the log
  RecordingSource source{};
  double period_s = 0.01;
  DriveSampling drive{};
  std::vector<RobotTick> ticks{};
};

/// (log files or folders of runs) => (recordings, cut where ticks are missing). Leaves out stretches shorter than a
/// second. Throws std::runtime_error that names the log if it is of another robot, lacks STATE or MOTOR_COMMAND, has
/// values that are not finite, or has no stretch of a second.
std::vector<RobotRecording> read_robot_logs(const std::vector<std::filesystem::path>& logs,
                                            const model::RobotModel& robot);

/// Writes ROBOT_INFO, and STATE and MOTOR_COMMAND of every tick, like a controller's log. The file appears whole or not
/// at all. Throws std::runtime_error if it can't be written.
void write_robot_log(const RobotRecording& recording, const model::RobotModel& robot,
                     const std::filesystem::path& file);

/// Plays one command per tick on a simulated robot and records it. Throws std::runtime_error if the simulation
/// diverges, work::Interrupted after an interruption.
RobotRecording play(sim::World& world, std::span<const model::JointCommand> commands, const std::string& name,
                    const work::Progress& progress = {});

}  // namespace pmg::robot_diagnosis
