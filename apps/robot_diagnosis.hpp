// pmg_diagnose --robot: diagnosis of a whole robot from its logs, and recording of a simulated robot.
#pragma once

#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "excitation/robot_excitation.hpp"
#include "io/whole_file.hpp"
#include "json_output.hpp"
#include "model/clip_library_file.hpp"
#include "robot_diagnosis/robot_diagnosis.hpp"
#include "robot_diagnosis/robot_report.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::apps {

struct RobotDiagnosisArguments {
  std::string robot;                        ///< name or folder
  std::vector<std::filesystem::path> logs;  ///< files, or folders of runs
  std::filesystem::path out;
  robot_diagnosis::RobotDiagnosisOptions options{};
  std::function<void()> make_folder;  ///< makes out when there is a result
  bool json = false;
  work::Progress progress{};
};

/// Plays both excitations on a simulated robot and writes DIR/hanging.lcm and DIR/standing.lcm. False after an
/// interruption: complete recordings are kept, and stderr names them.
inline bool record_robot(const std::string& name, const std::filesystem::path& out, unsigned seed,
                         const work::Progress& progress = {}) {
  const model::RobotModel robot = model::load_robot(model::find_robot(name));
  const ClipLibrary clips = model::load_clip_library(robot.directory / "clips", robot);
  std::string kept = "nothing was written";
  try {
    sim::World gantry(robot, sil::world_with_noise(seed, true));
    robot_diagnosis::write_robot_log(
        robot_diagnosis::play(gantry, excitation::hanging_excitation(robot), "hanging", progress), robot,
        out / "hanging.lcm");
    kept = "hanging.lcm is written, standing.lcm isn't";
    sim::World ground(robot, sil::world_with_noise(seed, false));
    robot_diagnosis::write_robot_log(
        robot_diagnosis::play(ground, excitation::standing_excitation(robot, clips), "standing", progress), robot,
        out / "standing.lcm");
  } catch (const work::Interrupted&) {
    std::cerr << "interrupted: " << kept << '\n';
    return false;
  }
  return true;
}

/// Writes DIR/diagnosis.json and DIR/report.html, and the verdict to stdout; returns the exit code of what it is worth.
/// After an interruption nothing is written, and stderr says so. Throws std::exception on bad input, before anything is
/// written.
inline int diagnose_robot_logs(const RobotDiagnosisArguments& arguments) {
  const model::RobotModel robot = model::load_robot(model::find_robot(arguments.robot));
  const std::vector<robot_diagnosis::RobotRecording> recordings =
      robot_diagnosis::read_robot_logs(arguments.logs, robot);
  robot_diagnosis::RobotDiagnosis found;
  try {
    found = robot_diagnosis::diagnose_robot(robot, recordings, arguments.options, arguments.progress);
  } catch (const work::Interrupted&) {
    std::cerr << "interrupted: nothing was written\n";
    return work::Worth(work::Grade::kInterrupted, "").exit_code();
  }
  nlohmann::ordered_json json = robot_diagnosis::robot_diagnosis_json(found);
  add_to(json, worth_of(found));
  arguments.make_folder();
  io::write_whole_file(arguments.out / "diagnosis.json", json.dump(2) + "\n");
  robot_diagnosis::robot_diagnosis_page(robot.name, found).write(arguments.out / "report.html");
  if (arguments.json) {
    apps::print_json(json);
  } else {
    std::cout << robot_diagnosis::robot_diagnosis_text(found);
  }
  return worth_of(found).exit_code();
}

}  // namespace pmg::apps
