// pmg_calibrate_zero: finds the zero points of a robot's joints from logs in which it stood still.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "io/whole_file.hpp"
#include "json_output.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "result_folder.hpp"
#include "shown_progress.hpp"
#include "zero/zero_results.hpp"
#include "zero/zero_stances.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kFooter = R"(
LOG is a log, or a run's folder, of pmg_sil or pmg_controller in which the robot stood still on both feet on level
ground, in several postures (docs/how-to/zero-calibration.md). Writes DIR/zero.yaml (what pmg_sil --motor reads),
DIR/zero.json and DIR/report.html. --make-stances writes a robot folder and a scenario with which to take such logs instead.

Examples:
  pmg_calibrate_zero --robot z1 --make-stances out/stances
  pmg_sil --robot out/stances --scenario out/stances/scenario.yaml --motor hidden.yaml --out out/zero_run
  pmg_calibrate_zero out/zero_run --robot z1 --out out/zero

Exit codes: 0 every joint between soles and IMU is calibrated, 1 some are known roughly or not at all, the poses
disagree or the iteration did not converge (the first line says which), 2 bad input or output, 130 interrupted (what was found until then is kept).)";

const apps::Results kResults = {"a calibration", {"zero.yaml", "zero.json", "report.html"}};
const apps::Results kStances = {"a robot or a scenario", {"robot.yaml", "scenario.yaml"}};

struct Arguments {
  std::vector<fs::path> logs;
  std::string robot = "z1";
  fs::path out, stances, motor;
  zero::ZeroOptions options;
  bool json = false, overwrite = false;
};

void declare(CLI::App& app, Arguments& arguments) {
  app.footer(kFooter);
  app.add_option("LOG", arguments.logs, "logs or folders of runs");
  app.add_option("--robot", arguments.robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_option("--out", arguments.out, "folder for the results; made if absent");
  apps::add_overwrite(app, arguments.overwrite);
  app.add_option("--make-stances", arguments.stances,
                 "write a robot folder and scenario.yaml for taking logs, and exit");
  app.add_option("--motor", arguments.motor, "motor.yaml whose other numbers zero.yaml shall keep");
  app.add_option("--tau", arguments.options.tau_rad, "largest misalignment of the IMU in a pose that counts [rad]")
      ->check(apps::positive())
      ->capture_default_str();
  app.add_option("--alpha", arguments.options.alpha, "damping of the update, in (0, 1]")
      ->check(apps::in_range(1e-3, 1.0))
      ->capture_default_str();
  app.add_option("--epsilon", arguments.options.epsilon_rad, "largest update of a converged zero point [rad]")
      ->check(apps::positive())
      ->capture_default_str();
  app.add_option("-M,--iterations", arguments.options.M, "consecutive iterations that updates must stay below epsilon")
      ->check(apps::in_range(1, 1000))
      ->capture_default_str();
  app.add_option("--imu-mounting", arguments.options.imu_mounting_rad,
                 "how well the IMU's attitude against robot.yaml is known, one standard deviation [rad]")
      ->check(apps::positive())
      ->capture_default_str();
  app.add_flag("--json", arguments.json, "print zero.json on stdout instead of the short report");
}

int make_stances(const Arguments& arguments) {
  apps::make_result_folder(arguments.stances, kStances, arguments.overwrite);
  zero::write_zero_rig(model::load_robot(model::find_robot(arguments.robot)), arguments.stances);
  std::cout << fmt::format("stances in {}\n", arguments.stances.string());
  return kOk;
}

void write_results(const zero::ZeroResults& results, const sim::ActuatorsByJoint& known, const fs::path& out,
                   bool overwrite) {
  apps::make_result_folder(out, kResults, overwrite);
  zero::zero_report(results).write(out / "report.html");
  io::write_whole_file(out / "zero.yaml",
                       sim::motor_yaml(zero::with_zero_offsets(known, results), zero::zero_remarks(results)));
  io::write_whole_file(out / "zero.json", zero::zero_json(results).dump(2) + "\n");
}

int calibrate(const Arguments& arguments) {
  if (arguments.logs.empty())
    throw std::invalid_argument("LOG is missing (pmg_calibrate_zero --help shows an example)");
  if (arguments.out.empty()) throw std::invalid_argument("--out is missing; expected a folder for the results");
  apps::expect_unused(arguments.out, kResults, arguments.overwrite);
  const model::RobotModel robot = model::load_robot(model::find_robot(arguments.robot));
  sim::ActuatorsByJoint known;
  if (!arguments.motor.empty()) known = sim::read_motor_file(arguments.motor, robot.joint_index);
  apps::ProgressLine progress;
  const std::vector<zero::StillPose> poses =
      zero::read_still_poses(arguments.logs, robot, {}, apps::shown(progress, "reading logs"));
  zero::ZeroResults results{.robot = &robot, .poses = &poses, .options = arguments.options, .found = {}};
  results.found = zero::calibrate_zero(robot, poses, arguments.options, apps::shown(progress));
  results.interrupted = apps::interrupt_requested != 0;
  progress.clear();
  if (results.interrupted && results.found.steps_rad.empty()) return kInterrupted;  // before any result
  write_results(results, known, arguments.out, arguments.overwrite);
  if (arguments.json) {
    apps::print_json(zero::zero_json(results));
  } else {
    for (const std::string& line : zero::zero_text(results)) std::cout << line << '\n';
    std::cout << fmt::format("results in {}\n", arguments.out.string());
  }
  return worth_of(results).exit_code();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Finds the zero points of joints from logs of still poses.", "pmg_calibrate_zero");
  Arguments arguments;
  declare(app, arguments);
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM});
    return arguments.stances.empty() ? calibrate(arguments) : make_stances(arguments);
  });
}
