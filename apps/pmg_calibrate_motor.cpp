// pmg_calibrate_motor: fits a motor model to recordings of one joint.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "calib/fit_results.hpp"
#include "calib/joint_runs.hpp"
#include "data_faults/data_faults_report.hpp"
#include "effects/fit_words.hpp"
#include "evidence/inverse_dynamics.hpp"
#include "excitation_command.hpp"
#include "io/whole_file.hpp"
#include "json_output.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "result_folder.hpp"
#include "shown_progress.hpp"
#include "sim/motor_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kBeforeWords = R"(
BENCH is a folder of bench.yaml, runs.csv and runs/ (docs/reference/file-formats.md). Writes DIR/motor.yaml (what
pmg_sil --motor reads), DIR/fit.json, DIR/report.html and DIR/fit.svg. Fitted are the drive's gain and damping, the rotor's inertia, whatever
bench.yaml calls unknown, and what --also names: a parameter of motor.yaml by its own name, or an effect,
  )";

constexpr const char* kAfterWords = R"(

With --make-excitation nothing is fitted: DIR is what to record, steps and smooth segments within limits (commands/,
runs.csv), for pmg_sil --bench, pmg_controller --bench, or a rig of your own.

Example:
  pmg_calibrate_motor --make-excitation --robot z1 --joint left_knee --out out/excitation
  pmg_calibrate_motor data/bench/servo --also viscous coulomb delay --fit "repeat == 0" --score "repeat == 1" --out out/servo

Exit codes: 0 fitted, 1 fitted but off its data or no better than where it started (the first line says which), 2 bad
input or output, among it faults of the data, 130 interrupted (what was found until then is kept).)";

const apps::Results kResults = {"a calibration", {"motor.yaml", "fit.json", "report.html", "fit.svg"}};

struct Arguments {
  fs::path bench, out;
  std::vector<std::string> also, ranges, fixed;
  std::string fit, score, joint, method = "sbplx", data_faults = "leave-out";
  double step_s = 0.0;
  unsigned starts = 8, threads = std::max(1U, std::thread::hardware_concurrency()), seed = 1;
  bool only = false, json = false, overwrite = false;
  apps::ExcitationCommand excitation;
};

/// So many to a line that each fits a console.
std::string lines_of(const std::vector<std::string>& words) {
  constexpr std::size_t kWords = 8;
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : i % kWords == 0 ? ",\n  " : ", ") + words[i];
  return text;
}

void declare(CLI::App& app, Arguments& arguments) {
  app.footer(kBeforeWords + lines_of(effects::fit_words()) + kAfterWords);
  app.add_option("BENCH", arguments.bench, "folder of the bench");
  app.add_option("--out", arguments.out, "folder for the results; made if absent")->required();
  CLI::Option* overwriting = apps::add_overwrite(app, arguments.overwrite);
  app.add_option("--also", arguments.also, "effects to fit besides the gains and the rotor");
  app.add_flag("--only", arguments.only, "fit what --also names and nothing else");
  app.add_option("--fit", arguments.fit,
                 "rows of runs.csv to fit, as in \"kp_firmware in 4,8 and repeat == 0\"; all if not given");
  app.add_option("--score", arguments.score, "rows to judge the fit by; none of them may be fitted");
  app.add_option(
         "--data-faults", arguments.data_faults,
         "faulty data: leave-out (single faulty runs are left out, other faults refused), correct (fit the corrected "
         "data) or keep")
      ->check(CLI::IsMember({"leave-out", "correct", "keep"}))
      ->capture_default_str();
  app.add_option("--set", arguments.fixed, "NAME=VALUE: what is known of the model, or where the search begins");
  app.add_option("--range", arguments.ranges, "NAME=LOWER:UPPER: where a parameter is looked for");
  app.add_option("--optimizer", arguments.method, "of the starts; the result is polished by BOBYQA and SBPLX")
      ->check(apps::one_of({"bobyqa", "sbplx", "crs2", "cmaes"}))
      ->capture_default_str();
  app.add_option("--starts", arguments.starts, "how many")->check(apps::in_range(1, 1000))->capture_default_str();
  app.add_option("--seed", arguments.seed, "of starts and random searches")->capture_default_str();
  app.add_option("--threads", arguments.threads, "at most")->check(apps::in_range(1, 256));
  app.add_option("--step", arguments.step_s,
                 "of the simulation [s]; the SIL's, or a quarter of the recording's, if not given")
      ->check(apps::in_range(1e-5, 0.01));
  app.add_option("--joint", arguments.joint, "its name in motor.yaml; bench.yaml's or the bench folder's if not given");
  arguments.excitation.declare(app);
  overwriting->excludes("--make-excitation");
  app.add_flag("--json", arguments.json, "print fit.json on stdout instead of the short report");
}

std::vector<std::string> names_to_fit(const Arguments& arguments, const bench::Bench& bench) {
  std::vector<std::string> names = arguments.only ? std::vector<std::string>{} : calib::basic_parameters(bench);
  for (const std::string& name : calib::unknown_loads(bench)) names.push_back(name);
  for (const std::string& word : arguments.also) calib::add_missing(names, effects::fit_word(word).parameters);
  return names;
}

/// ("NAME=REST") => (NAME, REST)
std::pair<std::string, std::string> split(const std::string& text, const char* expected) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::invalid_argument(fmt::format("'{}'; expected {}", text, expected));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

double number(const std::string& text, const std::string& what) {
  const auto value = bench::to_number(text);
  if (!value) throw std::invalid_argument(fmt::format("{}: '{}' isn't a number", what, text));
  return *value;
}

calib::Unknowns parameters(const Arguments& arguments, const bench::Bench& bench) {
  calib::Unknowns found;
  for (const std::string& name : names_to_fit(arguments, bench)) found.push_back(calib::unknown(name, bench));
  for (const std::string& text : arguments.ranges) {
    const auto [name, range] = split(text, "NAME=LOWER:UPPER");
    const std::size_t colon = range.find(':');
    const auto parameter = std::find_if(found.begin(), found.end(), [&](const auto& p) { return p.name == name; });
    if (colon == std::string::npos || parameter == found.end()) {
      throw std::invalid_argument(
          fmt::format("--range {}: expected NAME=LOWER:UPPER of a parameter that is fitted", text));
    }
    parameter->lower = number(range.substr(0, colon), text);
    parameter->upper = number(range.substr(colon + 1), text);
    if (!(parameter->lower < parameter->upper))
      throw std::invalid_argument(fmt::format("--range {}: expected LOWER below UPPER", text));
  }
  return found;
}

calib::JointModel start_model(const Arguments& arguments, const bench::Bench& bench) {
  calib::JointModel model;
  model.actuator = bench.known;
  for (const std::string& text : arguments.fixed) {
    const auto [name, value] = split(text, "NAME=VALUE");
    calib::set(model, name, number(value, text));
  }
  return model;
}

void write_results(const calib::FitResults& results, const calib::JointModel& before, const fs::path& out,
                   bool overwrite) {
  apps::make_result_folder(out, kResults, overwrite);
  io::write_whole_file(out / "fit.svg", calib::fit_picture(results, before));
  calib::fit_report(results).write(out / "report.html");
  io::write_whole_file(out / "motor.yaml",
                       sim::motor_yaml({{results.joint, results.fit.model.actuator}}, calib::motor_remarks(results)));
  io::write_whole_file(out / "fit.json", calib::fit_json(results).dump(2) + "\n");
}

void print_summary(const calib::FitResults& results, const fs::path& out) {
  if (const std::string worth = worth_of(results).sentence(); !worth.empty()) std::cout << worth << '\n';
  const std::string unit = calib::position_unit(*results.bench, true);
  for (std::size_t i = 0; i < results.confidence.size(); ++i) {
    const calib::Unknown& p = results.problem->parameters()[i];
    const double value = calib::value(results.fit.model, p.name);
    const std::string reservation = calib::reservation(p, value, results.confidence[i]);
    std::cout << fmt::format("{:34} {:>11.5g} +- {:<8} {}{}\n", p.name, value,
                             calib::deviation_text(results.confidence[i]), calib::unit_on_rig(p.unit(), *results.bench),
                             reservation.empty() ? "" : "   (" + reservation + ")");
  }
  const auto line = [&](const char* what, const calib::Assessment& a) {
    std::cout << fmt::format("{} {} runs: mean absolute error {:.4g} {} (before {:.4g})\n", what, a.runs->size(),
                             1e3 * total(a.after).mean_absolute_rad(), unit, 1e3 * total(a.before).mean_absolute_rad());
  };
  if (results.inverse) {
    const calib::InverseDynamics& found = *results.inverse;
    if (calib::possible(found))
      std::cout << fmt::format(
          "inverse dynamics{}: armature {:.4g}, viscous {:.4g}, Coulomb {:.4g} ({:.4g} forwards, {:.4g} backwards), "
          "offset {:.4g}\n",
          results.inverse_taken ? " (taken)" : "", std::max(0.0, found.armature_kg_m2.value),
          std::max(0.0, found.viscous_Nm_s_per_rad.value), std::max(0.0, found.coulomb_Nm.value),
          std::max(0.0, found.coulomb_forward_Nm()), std::max(0.0, found.coulomb_backward_Nm()), found.offset_Nm.value);
    if (const std::string meaning = calib::meaning_of_negative(found); !meaning.empty())
      std::cout << "inverse dynamics: " << meaning << '\n';
  }
  line("fitted", results.fitted);
  if (results.scored) line("scored", *results.scored);
  if (!results.noise_floor.pairs.empty()) {
    std::cout << fmt::format(
        "noise floor: repeats differ by {:.4g} {}, and stray by {:.4g} about what they have in common\n",
        1e3 * results.noise_floor.difference_mean_absolute_rad, unit, 1e3 * results.noise_floor.mean_absolute_rad);
  }
  std::cout << fmt::format("{} evaluations in {:.1f} s on {} threads; results in {}\n", results.fit.evaluations,
                           results.wall_s, results.threads, out.string());
}

bench::NoiseFloor noise_floor(const std::vector<calib::SingleJoint>& fitted,
                              const std::vector<calib::SingleJoint>& scored) {
  std::vector<const bench::BenchRun*> runs;
  for (const std::vector<calib::SingleJoint>* joints : {&fitted, &scored}) {
    for (const calib::SingleJoint& joint : *joints) runs.push_back(&joint.run());
  }
  return bench::noise_floor(runs);
}

/// The bench as it is to be fitted. Throws std::invalid_argument that names the faults if they can't be left out.
bench::Bench examined(const bench::Bench& bench, const Arguments& arguments, const work::Progress& progress,
                      work::Worth& worth) {
  data_faults::ExamineOptions options{.handling = data_faults::handling_of(arguments.data_faults)};
  if (bench.law != bench::DriveLaw::kCascadePd) options.unused = {bench::Column::kTorque};  // the fit is of positions
  const data_faults::Examination found =
      data_faults::examine(bench, {arguments.fit, arguments.score}, std::nullopt, options, arguments.threads, progress);
  worth = data_faults::worth_of(found);
  if (found.handling == data_faults::Handling::kLeaveOut && !found.corrected.empty())
    throw std::invalid_argument(fmt::format(
        "{}: {}; mend the files, or fit the corrected data: --data-faults correct (docs/how-to/diagnosis.md)",
        bench.folder.string(), worth.reservations().at(found.corrected.front()).why));
  return data_faults::examined_bench(bench, found);
}

int calibrate(const Arguments& arguments) {
  if (arguments.excitation.wanted()) {
    std::cout << arguments.excitation.run(arguments.joint, arguments.out, arguments.seed) << '\n';
    return kOk;
  }
  if (arguments.bench.empty()) throw std::invalid_argument("BENCH is missing (--help shows an example)");
  apps::expect_unused(arguments.out, kResults, arguments.overwrite);
  apps::ProgressLine progress;
  const bench::Bench as_recorded = bench::read_bench(arguments.bench);
  parameters(arguments, as_recorded);  // refuses a wrong name before the work, as the next line does
  start_model(arguments, as_recorded);
  for (const std::string& word : arguments.also) {
    const std::string today = effects::fit_word(word).today;
    if (!today.empty()) std::cerr << fmt::format("--also {}: the word is {} now\n", word, today);
  }
  calib::FitResults results;
  const bench::Bench bench = examined(as_recorded, arguments, apps::shown(progress), results.data);
  calib::Unknowns unknowns = parameters(arguments, bench);
  calib::JointModel start = start_model(arguments, bench);
  const double step_s = arguments.step_s > 0.0 ? arguments.step_s : calib::simulation_step_s(bench);
  const work::Progress reading = apps::shown(progress, "reading " + bench.folder.string());
  std::vector<calib::SingleJoint> fitted = calib::read_joints(bench, arguments.fit, step_s, reading), scored;
  if (!arguments.score.empty()) scored = calib::read_joints(bench, arguments.score, step_s, reading);
  if (apps::interrupt_requested != 0) return kInterrupted;  // before any result
  calib::expect_apart(fitted, scored);
  results.noise_floor = noise_floor(fitted, scored);
  std::vector<bench::BenchRun> runs;
  for (const calib::SingleJoint& joint : fitted) runs.push_back(joint.run());
  results.inverse = evidence::inverse_dynamics(bench, runs);
  if (results.inverse && bench.law == bench::DriveLaw::kCascadePd && !arguments.only)
    results.inverse_taken = calib::take_inverse_dynamics(*results.inverse, bench, start, unknowns);
  const calib::FitProblem problem(unknowns, start, std::move(fitted));
  calib::FitOptions options;
  options.method = calib::method_of(arguments.method);
  options.starts = arguments.starts;
  options.runs_while_searching = 8;
  options.newton_steps = 30;
  options.threads = arguments.threads;
  options.seed = arguments.seed;

  const auto begin = std::chrono::steady_clock::now();
  results.fit = calib::fit(problem, options, apps::shown(progress));
  results.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  progress.clear();
  results.confidence = calib::confidence(problem, results.fit.point, arguments.threads);
  results.bench = &bench;
  results.problem = &problem;
  results.method = arguments.method;
  results.threads = arguments.threads;
  results.joint = arguments.joint.empty() ? bench.joint_name() : arguments.joint;
  const calib::JointModel neutral = problem.model_at(problem.point_of(start));
  results.fitted = calib::assess(arguments.fit, problem.runs(), neutral, results.fit.model, arguments.threads);
  if (!scored.empty()) {
    results.scored = calib::assess(arguments.score, scored, neutral, results.fit.model, arguments.threads);
  }
  write_results(results, neutral, arguments.out, arguments.overwrite);
  if (arguments.json)
    apps::print_json(calib::fit_json(results));
  else
    print_summary(results, arguments.out);
  return worth_of(results).exit_code();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Fits a motor model to recordings of one joint.", "pmg_calibrate_motor");
  Arguments arguments;
  declare(app, arguments);
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, "intervals and report of the best that was found");
    return calibrate(arguments);
  });
}
