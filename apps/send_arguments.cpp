#include "send_arguments.hpp"

#include <fmt/format.h>

#include "io/lcm_link.hpp"
#include "option_checks.hpp"

namespace pmg::apps {

namespace {

constexpr const char* kFooter = R"(
Examples:
  pmg_send stop                              brake every robot, whoever drives it
  pmg_send stand                             the one robot that is heard
  pmg_send walk --vx 0.3 --for 5 --robot z1  climb to walk, drive 5 s, come to rest, stand
  pmg_send command --omega 0.4 --for 2       drive a robot that is in walk already
  pmg_send lift                              a simulated robot that fell: up on its hoist; then reset, stand

A command that the robot can't follow as it was asked is told, with what the controller made of it and why. After another
source's crash the end of its lease is waited for. A stop is asked for every 50 ms until it is acknowledged. Software stops are not safety-rated.

Exit codes: 0 acknowledged and the mode reached, 1 refused, or not acknowledged or not reached in time, 2 bad input or no
network, 130 interrupted (a robot that was driven is brought to rest first).)";

void declare_drive(CLI::App& app, SendArguments& arguments, const char* name, const char* help) {
  CLI::App* drive = app.add_subcommand(name, help);
  drive->fallthrough();
  drive->add_option("--for", arguments.duration_s, "how long [s]")->required()->check(positive());
  constexpr const char* kOptions[] = {"--vx", "--vy", "--omega", "--pitch", "--roll", "--height"};
  constexpr const char* kHelp[] = {"forward [m/s]",       "to the left [m/s]",        "turning left [rad/s]",
                                   "torso forward [rad]", "torso to the right [rad]", "above standing [m]"};
  for (std::size_t i = 0; i < kChannels; ++i) {
    drive->add_option(kOptions[i], arguments.command.u[i], kHelp[i])->check(finite());
  }
}

}  // namespace

void declare(CLI::App& app, SendArguments& arguments) {
  app.footer(kFooter);
  app.require_subcommand(1);
  app.add_option("--robot", arguments.robot, "controller's name; may be left out when one is heard, and for stop");
  app.add_option("--lcm-url", arguments.lcm_url,
                 fmt::format("LCM address; LCM_DEFAULT_URL or {} if not given", io::kDefaultLcmUrl));
  app.add_option("--keys", arguments.keys, "folder of this operator's keys; ~/.config/pmg/operator-keys if not given");
  app.add_option("--timeout", arguments.timeout_s,
                 "give up after so long [s]; stop, damping, passive, reset 2, lift, lower 15, others 10")
      ->check(positive());
  app.add_flag("--json", arguments.json, "print the outcome as JSON");
  for (const SendRequest& request : kSendRequests) app.add_subcommand(request.name, request.help)->fallthrough();
  app.add_subcommand(kLift, "simulation: catch the robot with its hoist, lift it, keep it up")->fallthrough();
  app.add_subcommand(kLower, "simulation: set it down and let go, if it stands")->fallthrough();
  declare_drive(app, arguments, "walk", "climb to walk, drive for a while, come to rest and stand");
  declare_drive(app, arguments, "command", "drive a robot that is in walk for a while, and come to rest");
}

}  // namespace pmg::apps
