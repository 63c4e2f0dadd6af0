#include "sil_arguments.hpp"

#include <nlohmann/json.hpp>

#include "option_checks.hpp"
#include "result_folder.hpp"
#include "sil/simulated_robot.hpp"

namespace pmg::apps {

namespace {

constexpr const char* kFooter = R"(
Writes DIR/log.lcm (simulation time only: same binary, inputs and seed give the same bytes), DIR/timing.csv (wall times),
DIR/summary.json, and with --video DIR/video.mp4. With --realtime the controller's threads run by the wall clock, and
summary.json says under "punctuality" how well they kept their times. With --realtime and no scenario operators drive (pmg_keyboard,
pmg_send), a hoist sets the robot down when it stands, and Ctrl-C or closing the window ends the run.

With --bench one joint of the hanging robot is excited while the others hold, and DIR is a bench of that joint for
pmg_calibrate_motor and pmg_diagnose: bench.yaml, runs.csv, runs/. The other files are as ever.

Example:
  pmg_sil --robot z1 --scenario tour --out out/tour --video
  pmg_sil --robot z1 --realtime --viewer --out out/drive
  pmg_sil --robot z1 --bench left_knee --excitation out/excitation --motor out/knee/motor.yaml --out out/knee-bench

Exit codes: 0 the scenario (the bench) ran to its end, or operators drove until it was ended, 1 the robot fell or a fault latched, 2 bad input or
output (a film that fails leaves the other results whole), 130 interrupted or the viewer's window closed (what was done until then is kept).)";

}  // namespace

void SilArguments::declare(CLI::App& app) {
  app.footer(kFooter);
  app.add_option("--robot", control.robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_option("--scenario", scenario,
                 "scenario to play: a name in config/scenarios, or a file (YAML); with --realtime it may be left out");
  app.add_option("--out", out, "folder for the results; made if absent");
  CLI::Option* overwriting = add_overwrite(app, overwrite);
  app.add_option("--policy", control.policy,
                 "policy's name below the robot's policies/, or none: drives follow the reference; robot.yaml's if not "
                 "given, and none with --bench");
  app.add_option(
         "--blend", control.blend,
         "how clips are mixed: as the library says, gain, corners (combined commands keep their size), or paper for "
         "the paper's weights to the letter")
      ->check(one_of({"library", "gain", "paper", "corners"}))
      ->capture_default_str();
  app.add_option("--clips", control.clips, "clip library; the policy's own, or the robot's clips/, if not given");
  app.add_option(
      "--motor", motor,
      "motor.yaml of pmg_calibrate_motor: how the drives really are; robot.yaml's if not given, none for none");
  app.add_option("--inject", inject,
                 "inject the failures of this file (YAML); the report tells what each led to, in bus cycles");
  app.add_flag("--gantry", gantry, "hang the robot in a gantry for the whole run");
  app.add_option("--vary", vary,
                 "draw the simulated robot, its ground and its noise from these ranges by the seed: a name in "
                 "config/evaluation, or a file (YAML)");
  app.add_option("--seed", seed, "of the sensor noise")->capture_default_str();
  CLI::Option* threads = app.add_flag("--realtime", realtime,
                                      "the robot's threads and the wall clock instead of lockstep; not reproducible");
  app.add_option("--lcm-url", lcm_url, "where operators are heard; LCM_DEFAULT_URL or this computer alone if not given")
      ->needs(threads)
      ->excludes("--scenario");
  CLI::Option* film = app.add_flag("--video", video, "film the run (needs ffmpeg)")->excludes(threads);
  CLI::Option* joint =
      app.add_option("--bench", bench, "excite this joint of the hanging robot and write a bench of it")
          ->excludes(threads)
          ->excludes(overwriting)
          ->excludes("--scenario");
  app.add_option("--excitation", excitation, "what to excite it by: a folder of pmg_calibrate_motor --make-excitation")
      ->needs(joint);
  app.add_flag("--viewer", viewer, "watch the run in a window, at the speed of real time; Esc or q ends it")
      ->excludes(film);
  app.add_option("--export-mjcf", export_mjcf, "write the robot's MuJoCo model to this file and exit");
  app.add_flag("--print-config", print_config, "print the configuration in force as JSON and exit");
  app.add_flag("--json", json, "print summary.json on stdout instead of the short report");
}

nlohmann::ordered_json config_json(const SilArguments& arguments, const control::LoadedControl& loaded,
                                   const runtime::BenchSession* bench) {
  nlohmann::ordered_json json = control::control_json(loaded);
  json["scenario"] = arguments.scenario.string();
  json["seed"] = arguments.seed;
  json["gantry"] = arguments.gantry;
  if (bench != nullptr) json["bench"] = bench->json();
  if (!arguments.vary.empty()) json["vary"] = arguments.vary.string();
  if (!arguments.inject.empty()) json["inject"] = arguments.inject.string();
  if (!arguments.motor.empty()) json["motor"] = arguments.motor.string();
  json["sensor_noise"] = {{"gyro_rad_s", sil::kGyroNoise_rad_s},
                          {"encoder_rad", sil::kEncoderNoise_rad},
                          {"orientation_rad", sil::kOrientationNoise_rad}};
  json["drive_sampling_s"] = sim::WorldOptions{}.timestep_s;  // simulated drives read positions once a physics step
  return json;
}

}  // namespace pmg::apps
