// pmg_keyboard: drives a robot by the keys of a terminal and shows its state.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>
#include <string>
#include <vector>

#include "io/lcm_link.hpp"
#include "keyboard/key_command.hpp"
#include "keyboard/terminal_keys.hpp"
#include "operator/driving_station.hpp"
#include "operator/keyboard_text.hpp"
#include "program.hpp"
#include "raw_terminal.hpp"

namespace {

using namespace pmg;

constexpr const char* kFooter = R"(
A key that moves takes the robot from wherever it is to walking: it stands up, is set down if a hoist holds it, and walks. A terminal
doesn't tell when a key is let go: each press changes the velocity by a step, and a second without any key brings it to zero. Postures
stay. Esc damps the robot at once, and needs no second key; afterwards Enter makes it stand up, and nothing else does. Software stops
are not safety-rated.

Inside tmux Esc comes half a second late unless tmux is told otherwise (set -sg escape-time 10); Backspace damps too, and at once.

Example:
  pmg_keyboard --robot z1

Exit codes: 0 ended with Ctrl-C, or by a signal: velocity was brought to zero first; 1 no controller was heard; 2 bad input, no terminal
or no network.)";

struct Arguments {
  std::string robot, lcm_url, keys;
};

enum ExitCode { kOk = 0, kNotHeard = 1 };

int drive(const Arguments& arguments) {
  constexpr int kWait_ms = 5;
  constexpr std::int64_t kPicture_ns = 100'000'000;
  const io::WallClock clock;
  io::LcmLink link(io::choose_lcm_url(arguments.lcm_url));
  ops::KeyCommand keys(ops::KeyReport::kPressOnly);
  ops::DrivingStation station(link, keys, arguments.robot, ops::session_number(), clock,
                              seal::load_operator_seal(arguments.keys, link.url()));
  const std::vector<std::string> meanings = ops::key_lines();
  {
    apps::RawTerminal terminal;
    apps::notice({SIGINT, SIGTERM, SIGHUP, SIGQUIT}, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    ops::TerminalKeys decoder;
    std::int64_t picture_at_ns = 0;
    while (!station.gone()) {
      if (apps::interrupt_requested != 0 || terminal.ended()) station.let_go();
      for (const ops::TerminalKey& key : decoder.take(terminal.read(), clock.now_ns()))
        keys.press(key.name, key.shift, clock.now_ns());
      station.step(kWait_ms);
      if (clock.now_ns() < picture_at_ns) continue;
      picture_at_ns = clock.now_ns() + kPicture_ns;
      terminal.draw(ops::fitted(station.lines(), meanings, terminal.rows()));
    }
  }
  std::cout << station.last_words() << '\n';
  return station.heard() ? kOk : kNotHeard;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Drives a robot by the keys of this terminal.", "pmg_keyboard");
  Arguments arguments;
  app.footer(kFooter);
  app.add_option("--robot", arguments.robot, "controller's name; may be left out when one is heard");
  app.add_option("--lcm-url", arguments.lcm_url,
                 fmt::format("LCM address; LCM_DEFAULT_URL or {} if not given", io::kDefaultLcmUrl));
  app.add_option("--keys", arguments.keys, "folder of this operator's keys; ~/.config/pmg/operator-keys if not given");
  return apps::run_program(app, argc, argv, [&]() -> int { return drive(arguments); });
}
