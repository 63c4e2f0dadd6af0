#include "send_arguments.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "io/lcm_link.hpp"
#include "option_checks.hpp"

namespace pmg::apps {

namespace {

/// A palm is no farther from the torso [m], and no angle is larger [rad].
CLI::Validator palm_value() { return in_range(-10.0, 10.0); }

constexpr const char* kFooter = R"(
Examples:
  pmg_send stop                              brake every robot, whoever drives it
  pmg_send stand                             the one robot that is heard
  pmg_send walk --vx 0.3 --for 5 --robot z1  climb to walk, drive 5 s, come to rest, stand
  pmg_send command --omega 0.4 --for 2       drive a robot that is in walk already
  pmg_send arms --left 0.3 0.25 0.3 --for 3  walk on the spot, left palm there (torso's frame, m), right arm as it was
  pmg_send arms --hand-back --for 3          the gait moves both arms again
  pmg_send lift                              a simulated robot that fell: up on its hoist; then reset, stand

A command that the robot can't follow as it was asked is told, with what the controller made of it and why. After another
source's crash the end of its lease is waited for. A stop is asked for every 50 ms until it is acknowledged. Software stops are not safety-rated.

Exit codes: 0 acknowledged and the mode reached, 1 refused, or not acknowledged or not reached in time, 2 bad input or no
network, 130 interrupted (a robot that was driven is brought to rest first).)";

void declare_arms(CLI::App& app, SendArguments& arguments) {
  CLI::App* arms = app.get_subcommand(kArms);
  constexpr const char* kHelp = "palm to X Y Z [m], or X Y Z ROLL PITCH YAW [rad], in the torso link's frame";
  arms->add_option("--left", arguments.palm[kLeft], fmt::format("left {}", kHelp))->expected(3, 6)->check(palm_value());
  arms->add_option("--right", arguments.palm[kRight], fmt::format("right {}", kHelp))
      ->expected(3, 6)
      ->check(palm_value());
  arms->add_flag("--hand-back", arguments.hand_back, "both arms back to the gait");
}

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
  app.add_option(
         "--timeout", arguments.timeout_s,
         "give up after so long [s]; stop, damping, passive, reset 2, lift, lower 60, others 10; a robot that is on a\n"
         "simulation's hoist first gets six times as long to come down")
      ->check(positive());
  app.add_flag("--json", arguments.json, "print the outcome as JSON");
  for (const SendRequest& request : kSendRequests) app.add_subcommand(request.name, request.help)->fallthrough();
  app.add_subcommand(kLift, "simulation: catch the robot with its hoist, lift it, keep it up")->fallthrough();
  app.add_subcommand(kLower, "simulation: set it down and let go, if it stands")->fallthrough();
  declare_drive(app, arguments, "walk", "climb to walk, drive for a while, come to rest and stand");
  declare_drive(app, arguments, kArms,
                "climb to walk, lead the arms for a while, come to rest and stand; arms stay where they are");
  declare_arms(app, arguments);
  declare_drive(app, arguments, "command", "drive a robot that is in walk for a while, and come to rest");
}

PerFoot<ops::PalmGoal> palm_goals(const SendArguments& arguments) {
  const bool aims = !arguments.palm[kLeft].empty() || !arguments.palm[kRight].empty();
  if (aims == arguments.hand_back)
    throw std::invalid_argument("arms: expected --left or --right, or --hand-back alone");
  PerFoot<ops::PalmGoal> goals;
  for (const Foot side : {kLeft, kRight}) {
    const std::vector<double>& values = arguments.palm[side];
    if (arguments.hand_back) goals[side].wish = pmg_msgs::arms_t::HAND_BACK;
    if (values.empty()) continue;
    if (values.size() != 3 && values.size() != 6) {
      throw std::invalid_argument(fmt::format("{}: {} numbers; expected X Y Z, or X Y Z ROLL PITCH YAW",
                                              side == kLeft ? "--left" : "--right", values.size()));
    }
    goals[side].wish = pmg_msgs::arms_t::AIM;
    goals[side].p_m = {values[0], values[1], values[2]};
    if (values.size() == 6) {
      goals[side].R = Eigen::AngleAxisd(values[5], Eigen::Vector3d::UnitZ()) *
                      Eigen::AngleAxisd(values[4], Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(values[3], Eigen::Vector3d::UnitX());
    }
  }
  return goals;
}

}  // namespace pmg::apps
