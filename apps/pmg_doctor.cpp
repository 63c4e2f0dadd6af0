// pmg_doctor: whether this computer, its buses and a robot's files are fit for a robot that stands.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "doctor/examination.hpp"
#include "doctor/linux_host.hpp"
#include "drive_questions.hpp"
#include "io/lcm_url.hpp"
#include "io/plain_text.hpp"
#include "json_output.hpp"
#include "option_checks.hpp"
#include "program.hpp"

namespace {

using namespace pmg;

enum ExitCode { kOk = 0, kFailed = 1 };

constexpr const char* kFooter = R"(
Run it on the robot's own computer, as the user that runs pmg_controller, and with the same options. It changes nothing. Each line
begins with ok, warn or fail; below warn and fail stands what to do. pmg_controller asks the same before it drives motors.

Example:
  pmg_doctor --robot z1 --hal can --bus-cpu 2 --control-cpu 3
  pmg_doctor --robot z1 --hal sil
  pmg_doctor --robot z1 --hal ethercat --interface eth1 --json

Exit codes: 0 no line fails, 1 a line fails, 2 bad input. docs/how-to/operation.md has every line.)";

struct Arguments {
  control::ControlSetup control;
  std::string hal = "can", lcm_url, keys, bundle;
  std::vector<std::string> cards;
  std::filesystem::path log = "out";
  doctor::RealtimeCpus cpus;
  int priority = 80;
  bool insecure = false, ask_drives = false, json = false;

  void declare(CLI::App& app);
};

void Arguments::declare(CLI::App& app) {
  app.footer(kFooter);
  app.add_option("--robot", control.robot, "robot's name below config/robots, or its folder")->capture_default_str();
  app.add_option("--policy", control.policy, "policy's name, an ONNX file, or none; robot.yaml's if not given");
  app.add_option("--clips", control.clips, "clip library; the policy's own, or the robot's clips/, if not given");
  app.add_option("--hal", hal, "the drives whose buses are looked at; sil: none")
      ->check(apps::one_of({"can", "ethercat", "sil"}))
      ->capture_default_str();
  app.add_option("--interface", cards, "network card that EtherCAT has for itself; may be given again");
  app.add_flag("--ask-drives", ask_drives, "with --hal can: ask every drive for its firmware; no controller may run");
  app.add_option("--bundle", bundle,
                 "SHA-256 of robot.yaml, URDF, clips and policy that is expected, or its first digits");
  app.add_option("--lcm-url", lcm_url, "LCM network; LCM_DEFAULT_URL or this computer alone if not given");
  CLI::Option* folder = app.add_option("--keys", keys, "folder of keys (pmg_key)");
  app.add_flag("--insecure-without-keys", insecure, "the controller is to run without keys")->excludes(folder);
  app.add_option("--log", log, "folder of the logs")->capture_default_str();
  app.add_option("--bus-cpu", cpus.bus, "the one CPU of the bus thread; -1: any")
      ->check(apps::in_range(-1, 4095))
      ->capture_default_str();
  app.add_option("--control-cpu", cpus.control, "the one CPU of the control thread; -1: any")
      ->check(apps::in_range(-1, 4095))
      ->capture_default_str();
  app.add_option("--priority", priority, "highest SCHED_FIFO priority of the controller")
      ->check(apps::in_range(1, 99))
      ->capture_default_str();
  app.add_flag("--json", json, "print the findings as JSON");
}

/// Adds what a check found; what it throws is a finding, too.
template <typename Check>
void add(doctor::Findings& all, const std::string& name, Check&& check) {
  try {
    std::ranges::move(check(), std::back_inserter(all));
  } catch (const std::exception& error) {
    all.push_back(doctor::fail(name, error.what(), "correct what the line says, and ask again"));
  }
}

doctor::Findings examine(const Arguments& arguments) {
  const doctor::LinuxHost host;
  const bool can = arguments.hal == "can";
  if (arguments.ask_drives && !can) throw std::invalid_argument("--ask-drives: needs --hal can");
  if (arguments.hal == "ethercat" && arguments.cards.empty())
    throw std::invalid_argument(
        "--hal ethercat: --interface is missing; expected the card that EtherCAT has for itself");
  model::find_robot(arguments.control.robot);
  can::DriveSetup setup;
  std::optional<model::SerialImuModel> imu;
  doctor::Findings all;
  add(all, "robot", [&] { return doctor::check_robot_files(arguments.control, arguments.bundle, can); });
  const bool known = std::ranges::any_of(all, [](const doctor::Finding& finding) {
    return finding.check == "drives" && finding.verdict == doctor::Verdict::kOk;
  });
  if (known) {
    const model::RobotModel robot = model::load_robot(model::find_robot(arguments.control.robot));
    setup = can::load_drives(robot);
    imu = robot.imu.serial;
    add(all, "drives' firmware", [&] {
      if (!arguments.ask_drives) return doctor::check_firmware(std::nullopt);
      return doctor::check_firmware(apps::ask_firmware(robot, setup));
    });
  }
  add(all, "computer", [&] {
    return doctor::examine_for_controller(host, {.realtime = true,
                                                 .priority = arguments.priority,
                                                 .cpus = arguments.cpus,
                                                 .can_buses = setup.buses,
                                                 .cards = arguments.cards,
                                                 .imu = imu,
                                                 .log = arguments.log});
  });
  const std::string url = io::choose_lcm_url(arguments.lcm_url);
  add(all, "multicast route", [&] { return doctor::check_multicast(host, url, arguments.cards); });
  add(all, "keys", [&] { return doctor::check_keys(arguments.keys, url, arguments.insecure); });
  return all;
}

int report(const doctor::Findings& findings, bool json) {
  const auto count = [&findings](doctor::Verdict verdict) {
    return std::ranges::count(findings, verdict, &doctor::Finding::verdict);
  };
  const auto failed = count(doctor::Verdict::kFail), warned = count(doctor::Verdict::kWarn);
  if (json) {
    nlohmann::ordered_json out = {{"fail", failed}, {"warn", warned}, {"findings", doctor::to_json(findings)}};
    apps::print_json(out);
  } else {
    for (const doctor::Finding& finding : findings) {
      for (const std::string& line : doctor::to_lines(finding)) std::cout << io::plain_text(line) << '\n';
    }
    std::cout << fmt::format("{} lines: {} fail, {} warn\n", findings.size(), failed, warned);
  }
  return failed > 0 ? kFailed : kOk;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Says whether this computer, its buses and a robot's files are fit for a robot that stands, and what to do.",
      "pmg_doctor");
  Arguments arguments;
  arguments.declare(app);
  return apps::run_program(
      app, argc, argv, [&]() -> int { return report(examine(arguments), arguments.json); },
      [&] { return control::told_bundle(arguments.control); });
}
