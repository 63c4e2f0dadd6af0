// pmg_diagnose: the errors of a joint's simulation, and the effects behind them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "calib/fit_results.hpp"
#include "calib/simulated.hpp"
#include "data_faults/data_faults_report.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnosis_json.hpp"
#include "diagnosis/next_excitation_files.hpp"
#include "diagnosis_page/diagnosis_page.hpp"
#include "effects/catalogue.hpp"
#include "evidence/thresholds.hpp"
#include "files/nearest_name.hpp"
#include "io/whole_file.hpp"
#include "json_output.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "residual_torque/extension_report.hpp"
#include "result_folder.hpp"
#include "robot_diagnosis.hpp"
#include "shown_progress.hpp"
#include "sim/motor_file.hpp"
#include "work/resources.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kFooter = R"(
BENCH is a folder of bench.yaml, runs.csv and runs/ (docs/reference/file-formats.md). Writes DIR/report.html (pictures
first), DIR/diagnosis.json and DIR/motor.yaml: the model with the effects that were found, which pmg_sil --motor and training
read. Where effects can't be told apart, DIR/next_excitation/ is what to record next. Without --model the drive's gain
and damping, the rotor's inertia and whatever bench.yaml calls unknown are fitted first.

Example:
  pmg_diagnose data/bench/servo --model out/servo/motor.yaml --fit "repeat == 0" --score "repeat == 1" --out out/why
  pmg_diagnose --robot z1 --record out/excited
  pmg_diagnose --robot z1 out/excited/hanging.lcm out/excited/standing.lcm --out out/why_robot

Exit codes: 0 a verdict (found, none, or ambiguous with what to record next), 1 unexplained, or a result that is off its
data or no better than before (the first line says which), 2 bad input or output, 130 interrupted (what was found until
then is kept, without a verdict).)";

const apps::Results kResults = {"a diagnosis", {"diagnosis.json", "report.html", "motor.yaml"}};
const apps::Results kRecordings = {"recordings", {"hanging.lcm", "standing.lcm"}};

struct Arguments {
  fs::path bench, out, model, record;
  std::vector<fs::path> inputs;
  std::string robot;
  std::string fit, score, joint;
  double step_s = 0.0;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency()), seed = 1;
  std::string data_faults = "leave-out";
  std::vector<std::string> set;
  fs::path set_file;
  bool json = false, overwrite = false;

  /// Sets thresholds as --set-file says, then as --set says.
  void set_thresholds(const evidence::ThresholdRows& rows) const {
    if (!set_file.empty()) evidence::set_from_file(rows, set_file);
    for (const std::string& one : set) evidence::set(rows, one);
  }
};

void declare(CLI::App& app, Arguments& arguments) {
  app.footer(kFooter);
  app.add_option("BENCH", arguments.inputs, "folder of the bench; with --robot logs of runs: files or folders");
  app.add_option("--out", arguments.out, "folder for the results; made if absent");
  apps::add_overwrite(app, arguments.overwrite);
  app.add_option("--robot", arguments.robot, "diagnose a whole robot from logs: its name or folder");
  app.add_option("--record", arguments.record,
                 "with --robot: a simulated one plays what shows most, into DIR/hanging.lcm and DIR/standing.lcm");
  app.add_option("--model", arguments.model, "motor.yaml that the simulation has now");
  app.add_option("--joint", arguments.joint,
                 "its name in motor.yaml; the only one in --model, bench.yaml's or the bench folder's if not given");
  app.add_option("--fit", arguments.fit,
                 "rows of runs.csv to diagnose, as in \"kp_firmware in 4,8 and repeat == 0\"; all if not given");
  app.add_option("--score", arguments.score, "rows to judge the result by, once; none of them may be fitted");
  app.add_option(
         "--data-faults", arguments.data_faults,
         "faulty data: leave-out (faulty runs are left out; what all runs share is corrected), correct (every fault is "
         "corrected) or keep")
      ->check(CLI::IsMember({"leave-out", "correct", "keep"}))
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "of the bootstrap")->capture_default_str();
  app.add_option("--threads", arguments.threads, "at most")->check(apps::in_range(1, 256));
  app.add_option("--step", arguments.step_s, "of the simulation [s]; chosen if not given")
      ->check(apps::in_range(1e-5, 0.01));
  app.add_option(
         "--set", arguments.set,
         "NAME=VALUE: a threshold to decide by, by its name in diagnosis.json's options, or data_faults.NAME of its "
         "data_fault_options; once or more")
      ->type_name("NAME=VALUE")
      ->take_all();
  app.add_option("--set-file", arguments.set_file, "YAML file of NAME: VALUE lines; --set overrides it");
  app.add_flag("--json", arguments.json, "print diagnosis.json on stdout instead of the short report");
}

/// The actuator of the chosen joint in the file. Also sets the joint's name.
model::ActuatorParameters given_model(Arguments& arguments) {
  const sim::ActuatorsByJoint joints = sim::read_motor_file(arguments.model);
  if (joints.size() == 1 && arguments.joint.empty()) arguments.joint = joints.begin()->first;
  const auto joint = joints.find(arguments.joint);
  if (joint != joints.end()) return joint->second;
  std::vector<std::string> names;
  for (const auto& [name, actuator] : joints) names.push_back(name);
  throw std::invalid_argument(fmt::format("{}: no joint '{}' for --joint; {}", arguments.model.string(),
                                          arguments.joint, files::expected_name(arguments.joint, names)));
}

std::vector<std::string> remarks(const diagnosis::Diagnosis& found, const bench::Bench& bench) {
  const std::string unit = calib::position_unit(bench, true);
  std::vector<std::string> lines = {
      fmt::format("Written by pmg_diagnose from {}: {}", bench.folder.filename().string(), name(found.verdict))};
  if (const std::string worth = worth_of(found).sentence(); !worth.empty()) lines.insert(lines.begin(), worth);
  for (const diagnosis::Cause& cause : found.causes) {
    lines.push_back(fmt::format("{}: held-out error {:.4g} {} without it, {:.4g} with it",
                                effects::described(cause.effect, cause.form, cause.form_or_instead),
                                1e3 * cause.held_out_error_before, unit, 1e3 * cause.held_out_error_after));
  }
  if (found.residual_extension) lines.push_back(residual_torque::line(*found.residual_extension, unit));
  for (const assembly::Variation& one : found.assemblies.varies) {
    lines.push_back(
        fmt::format("{} is a mean over assemblies ({}), by column {} of runs.csv: a new assembly's value is "
                    "not known",
                    one.parameter, assembly::spread_text(one), assembly::columns_text(one.columns)));
  }
  if (found.after.inertia_scale != 1.0 || found.after.gravity_scale != 1.0) {
    lines.push_back(fmt::format("The bench's loads were off: inertia times {:.4g}, gravity torque times {:.4g}",
                                found.after.inertia_scale, found.after.gravity_scale));
  }
  if (found.after.zero_slip_rad != 0.0)
    lines.push_back("sensor.zero_offset_rad is the one after the slip, which the joint has had from then on");
  return lines;
}

/// What the diagnosis took, in every unit that says something: rollouts don't depend on the machine.
struct Cost {
  double wall_s = 0.0;
  work::Resources used = work::used_resources();
  calib::Simulated simulated = calib::simulated();
};

/// A command that runs as it is printed, where the bench says of which robot the joint is.
std::string simulate_line(const bench::Bench& bench, const fs::path& out) {
  const bool known = !bench.robot.empty();
  return fmt::format("simulate with what was found{}: {} --robot {} --scenario stand --motor {} --out {}",
                     known ? "" : " (ROBOT: one that has this joint)", apps::typed_word(apps::typed_beside("pmg_sil")),
                     known ? apps::typed_word(bench.robot) : "ROBOT", apps::typed_word((out / "motor.yaml").string()),
                     apps::typed_word((out / "stand").string()));
}

void print_summary(const diagnosis::Diagnosis& found, const bench::Bench& bench, const fs::path& out,
                   const Cost& cost) {
  const std::string unit = calib::position_unit(bench, true);
  if (const std::string worth = worth_of(found).sentence(); !worth.empty()) std::cout << worth << '\n';
  std::cout << data_faults::faults_text(found.data) << "verdict: " << name(found.verdict) << '\n';
  if (const std::string odd = calib::odd_runs_text(found.noise_floor.odd_runs); !odd.empty()) std::cout << odd << '\n';
  for (const diagnosis::Cause& cause : found.causes) {
    std::cout << fmt::format("  {}{}: error {:.4g} {} without it, {:.4g} {} with it\n", cause.effect,
                             cause.or_instead.empty() ? "" : fmt::format(" (or {})", fmt::join(cause.or_instead, ", ")),
                             1e3 * cause.held_out_error_before, unit, 1e3 * cause.held_out_error_after, unit);
    if (effects::effect(cause.effect).forms.size() > 1)
      std::cout << "    " << effects::described(cause.effect, cause.form, cause.form_or_instead) << '\n';
    if (!cause.same_here.empty())
      std::cout << fmt::format("    which on this rig is the same as {}\n", fmt::join(cause.same_here, ", "));
    for (const evidence::ParameterEstimate& p : cause.parameters) {
      std::cout << fmt::format("    {} = {}\n", p.name, evidence::text_of(p.estimate, p.unit, 4));
    }
  }
  for (const assembly::Variation& one : found.assemblies.varies) std::cout << "  " << assembly::sentence(one) << '\n';
  if (!found.depends_on.empty())
    std::cout << fmt::format("what remains depends on {}\n", fmt::join(found.depends_on, ", "));
  if (found.residual_extension) std::cout << residual_torque::line(*found.residual_extension, unit) << '\n';
  if (found.next_excitation) std::cout << "record next: " << found.next_excitation->text << '\n';
  const double floor_rad = found.noise_floor.mean_absolute_rad;
  std::cout << fmt::format(
      "{} mean absolute error: {:.4g} {} before, {:.4g} {} after; in noise floors: {:.2g} before, {:.2g} after\n",
      found.held_out ? "held-out" : "fitted", 1e3 * found.held_out_before.value, unit, 1e3 * found.held_out_after.value,
      unit, found.held_out_before.value / floor_rad, found.held_out_after.value / floor_rad);
  std::cout << fmt::format("noise floor {:.4g} {} ({}); {:.0f} % of the way to it\n", 1e3 * floor_rad, unit,
                           found.noise_floor.how, 100.0 * found.share_of_way_to_floor);
  std::cout << fmt::format("simulation step {:.3g} ms ({}); integration error of the model before {:.3g} {} rms\n",
                           1e3 * found.step.error.step_s, name(found.step.limit), 1e3 * found.step.error.rms_rad, unit);
  std::cout << fmt::format("{:.1f} s, {:.1f} s of CPU time, at most {:.0f} MiB of memory, {} rollouts; results in {}\n",
                           cost.wall_s, cost.used.cpu_s, cost.used.peak_memory_MiB, cost.simulated.rollouts,
                           out.string());
  if (!found.causes.empty() || found.after.actuator.residual_torque.count > 0)
    std::cout << simulate_line(bench, out) << '\n';
}

int diagnose_robot(const Arguments& arguments) {
  apps::ProgressLine progress;
  if (!arguments.record.empty()) {
    apps::make_result_folder(arguments.record, kRecordings, arguments.overwrite);
    const bool whole =
        apps::record_robot(arguments.robot, arguments.record, arguments.seed, apps::shown(progress, "excitation"));
    return whole ? kOk : kInterrupted;
  }
  if (arguments.inputs.empty() || arguments.out.empty())
    throw std::invalid_argument("--robot expects logs and --out DIR, or --record DIR");
  apps::expect_unused(arguments.out, kResults, arguments.overwrite);
  robot_diagnosis::RobotDiagnosisOptions options;
  arguments.set_thresholds(evidence::rows(options));
  return apps::diagnose_robot_logs(
      {.robot = arguments.robot,
       .logs = arguments.inputs,
       .out = arguments.out,
       .options = options,
       .make_folder = [&] { apps::make_result_folder(arguments.out, kResults, arguments.overwrite); },
       .json = arguments.json,
       .progress = apps::shown(progress, "equations of motion")});
}

int diagnose(Arguments arguments) {
  if (arguments.inputs.size() != 1 || arguments.out.empty())
    throw std::invalid_argument("expected one BENCH and --out DIR (pmg_diagnose --help shows an example)");
  arguments.bench = arguments.inputs.front();
  apps::expect_unused(arguments.out, kResults, arguments.overwrite);
  const fs::path next = arguments.out / "next_excitation";
  diagnosis::expect_no_recordings(next);
  apps::ProgressLine progress;
  const bench::Bench bench = bench::read_bench(arguments.bench);
  diagnosis::DiagnoseOptions options;
  options.fit = arguments.fit;
  options.score = arguments.score;
  options.threads = arguments.threads;
  options.seed = arguments.seed;
  options.step_s = arguments.step_s;
  options.data.handling = data_faults::handling_of(arguments.data_faults);
  const evidence::ThresholdRows thresholds = diagnosis::rows(options.decide_by, options.data.decide_by);
  arguments.set_thresholds(thresholds);
  if (!arguments.model.empty()) options.model = given_model(arguments);
  if (arguments.joint.empty()) arguments.joint = bench.joint_name();
  const auto begin = std::chrono::steady_clock::now();
  diagnosis::DiagnosedRuns runs;
  const diagnosis::Diagnosis found = diagnosis::diagnose(bench, options, &runs, apps::shown(progress));
  progress.clear();
  const Cost cost{.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
  apps::make_result_folder(arguments.out, kResults, arguments.overwrite);
  diagnosis::remove_next_excitation(next);
  nlohmann::ordered_json json = diagnosis::diagnosis_json(found);
  json["wall_s"] = cost.wall_s;
  json["cost"] = {{"cpu_s", cost.used.cpu_s},
                  {"peak_memory_MiB", cost.used.peak_memory_MiB},
                  {"rollouts", cost.simulated.rollouts},
                  {"steps", cost.simulated.steps}};
  io::write_whole_file(
      arguments.out / "motor.yaml",
      sim::motor_yaml({{arguments.joint, calib::after_the_slip(found.after).actuator}}, remarks(found, bench)));
  if (found.next_excitation) diagnosis::write_next_excitation(next, bench, *found.next_excitation);
  io::write_whole_file(arguments.out / "report.html",
                       diagnosis_page::page_of(bench, found, runs, arguments.threads).html());
  io::write_whole_file(arguments.out / "diagnosis.json", json.dump(2) + "\n");
  if (arguments.json) {
    apps::print_json(json);
  } else {
    print_summary(found, bench, arguments.out, cost);
    if (const auto set = evidence::set_by_hand(thresholds); !set.empty())
      std::cout << fmt::format("decided by thresholds set by hand: {}\n", fmt::join(set, ", "));
  }
  return worth_of(found).exit_code();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Finds what the simulation gets wrong of a recorded joint.", "pmg_diagnose");
  Arguments arguments;
  declare(app, arguments);
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, "the verdict of what was done until now, and its report");
    return arguments.robot.empty() ? diagnose(arguments) : diagnose_robot(arguments);
  });
}
