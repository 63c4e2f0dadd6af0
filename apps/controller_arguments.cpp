#include "controller_arguments.hpp"

#include <nlohmann/json.hpp>

#include "hal/backend_json.hpp"
#include "option_checks.hpp"

namespace pmg::apps {

namespace {

constexpr const char* kFooter = R"(
Starts in Passive and waits for operators on LCM (pmg_send, pmg_watch). SIGINT, SIGTERM and SIGHUP damp the robot, close the
log and end the program. Software stops are not safety-rated: docs/reference/safety.md.

With --bench the robot excites one joint as soon as it stands (pmg_send stand), the others holding, and damps when all is
recorded. It must hang clear of the ground with its base held fast. Stops, faults and limits are in force as ever, and what
was recorded whole until then is kept; nothing begins again by itself.

With --excite the robot moves all its joints: hanging for 42 s, feet clear of the ground, or standing for 56 s. It begins
when the robot has hung or stood still in Stand (pmg_send stand) for 4 s, by the torques of its legs, and comes back to rest
by itself. After hanging the program ends; after standing the robot stands on until you take it up and end the program.
The log is for pmg_diagnose --robot.

Example:
  pmg_controller --hal sil --robot z1 --log out/first
  pmg_send walk --robot z1 --vx 0.4 --for 5
  pmg_controller --hal sil --viewer
  pmg_controller --hal sil --inject failures.yaml
  pmg_controller --hal sil --robot z1 --gantry --excite hanging --log out/hanging
  pmg_controller --hal sil --robot z1 --bench left_knee --excitation out/excitation --bench-out out/knee-bench

Exit codes: 0 ended by a signal, --duration or the bench's end, 1 it could not run on (the drives don't answer, or a thread failed; the robot
was damped), an excitation was given up or something is missing in the log, 2 bad input, a network, name or log folder that can't be used,
or a computer or bus that the doctor refuses.)";

nlohmann::ordered_json thread_json(const runtime::ThreadSchedule& schedule) {
  return {{"priority", schedule.priority}, {"cpu", schedule.cpu}};
}

}  // namespace

void ControllerArguments::declare(CLI::App& app) {
  app.footer(kFooter);
  backend.declare(app);
  app.add_option("--robot", control.robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_option("--name", name, "name that messages are addressed to; the robot's own if not given");
  app.add_option("--policy", control.policy,
                 "policy's name below the robot's policies/, or none: drives follow the reference; robot.yaml's if not "
                 "given, and none with --bench and --excite");
  app.add_option("--clips", control.clips, "clip library; the policy's own, or the robot's clips/, if not given");
  app.add_option("--lcm-url", lcm_url, "LCM network; LCM_DEFAULT_URL or this computer alone if not given");
  CLI::Option* keys_option = app.add_option(
      "--keys", keys, "folder of keys (pmg_key); ~/.config/pmg/controller-keys where messages leave this computer");
  app.add_flag("--insecure-without-keys", insecure, "let everybody who reaches the address drive the robot")
      ->excludes(keys_option);
  CLI::Option* log_option = app.add_option(
      "--log", log,
      "folder of the log; out/NAME-TIME if not given; where one of another run is, FOLDER-2, FOLDER-3, ...");
  app.add_flag("--no-log", no_log, "write no log but that of the seconds around a fault")->excludes(log_option);
  CLI::Option* joint = app.add_option("--bench", bench, "excite this joint of the hanging robot once");
  CLI::Option* folder = app.add_option("--excitation", excitation,
                                       "what to excite it by: a folder of pmg_calibrate_motor --make-excitation");
  CLI::Option* out = app.add_option("--bench-out", bench_out, "folder of the bench that is recorded");
  folder->needs(joint);
  out->needs(joint);
  joint->needs(folder)->needs(out);
  app.add_option(
         "--excite", excite,
         "excite the whole robot once, for pmg_diagnose --robot: hanging (in a gantry) or standing (on the ground)")
      ->check(CLI::IsMember(runtime::robot_excitation_names()))
      ->excludes(joint);
  app.add_option("--bus-cpu", threads.bus.cpu, "the one CPU of the bus thread; -1: any")
      ->check(in_range(-1, 4095))
      ->capture_default_str();
  app.add_option("--control-cpu", threads.control.cpu, "the one CPU of the control thread; -1: any")
      ->check(in_range(-1, 4095))
      ->capture_default_str();
  app.add_option("--bus-priority", threads.bus.priority, "SCHED_FIFO priority of the bus thread")
      ->check(in_range(1, 99))
      ->capture_default_str();
  app.add_option("--control-priority", threads.control.priority, "SCHED_FIFO priority of the control thread")
      ->check(in_range(1, 99))
      ->capture_default_str();
  app.add_flag("--no-realtime", no_realtime, "ordinary scheduling: for trying things out, not for a robot");
  app.add_flag("--despite-doctor", despite_doctor,
               "drive the motors although the doctor (pmg_doctor) found what a robot must not stand with");
  app.add_option("--duration", duration_s, "end after so many seconds")->check(positive());
  app.add_option(
      "--inject", inject,
      "with --hal sil: inject the failures of this file (YAML); the end tells what each led to, in bus cycles");
  app.add_flag("--print-config", print_config, "print the configuration in force as JSON and exit");
  app.add_flag("--json", json, "print how the run went as JSON on stdout at the end");
}

nlohmann::ordered_json config_json(const ControllerArguments& arguments, const control::LoadedControl& loaded,
                                   const hal::Backend& backend, const ControllerExcitation& excitation) {
  nlohmann::ordered_json json = control::control_json(loaded);
  json["name"] = arguments.name;
  json["hal"] = arguments.backend.hal();
  json["lcm_url"] = arguments.lcm_url;
  json["log"] = arguments.log.string();
  if (!arguments.inject.empty()) json["inject"] = arguments.inject.string();
  add_to(json, backend.configuration());
  hal::add_to(json, backend.description());
  excitation.add_to(json);
  json["realtime"] = {{"asked_for", arguments.threads.realtime},
                      {"bus", thread_json(arguments.threads.bus)},
                      {"control", thread_json(arguments.threads.control)}};
  return json;
}

}  // namespace pmg::apps
