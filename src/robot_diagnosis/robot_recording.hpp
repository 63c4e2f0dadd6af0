// What a whole robot did, tick by tick: what its sensors said and what its drives were given, nothing that only a
// simulation knows.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "model/robot_io.hpp"
#include "model/robot_model.hpp"
#include "robot_diagnosis/drive_sampling.hpp"
#include "sim/world.hpp"
#include "work/progress.hpp"

namespace pmg::robot_diagnosis {

/// A state and the command that was computed from it: it acts from the next bus cycle until the next tick's.
struct RobotTick {
  double t_s = 0.0;  ///< of the state
  model::RobotState state;
  model::JointCommand command;
};

/// Ticks at a constant period; a gap in a log begins another recording.
struct RobotRecording {
  std::string name;  ///< of the log, short
  double period_s = 0.01;
  DriveSampling drive{};
  std::vector<RobotTick> ticks{};
};

/// The runs of these logs (files, or folders of runs), cut where ticks are missing. Stretches shorter than a second are
/// left out. Throws std::runtime_error that names the log: of another robot, without STATE and MOTOR_COMMAND, with
/// values that aren't finite, or with nothing longer than a second.
std::vector<RobotRecording> read_robot_logs(const std::vector<std::filesystem::path>& logs,
                                            const model::RobotModel& robot);

/// Writes ROBOT_INFO, and STATE and MOTOR_COMMAND of every tick, as a controller's log has them; the file is there
/// whole or not at all. Throws std::runtime_error when it can't be written.
void write_robot_log(const RobotRecording& recording, const model::RobotModel& robot,
                     const std::filesystem::path& file);

/// Plays one command a tick on a simulated robot and records it. Throws
/// std::runtime_error when the simulation diverges, work::Interrupted when progress is over.
RobotRecording play(sim::World& world, std::span<const model::JointCommand> commands, const std::string& name,
                    const work::Progress& progress = {});

}  // namespace pmg::robot_diagnosis
