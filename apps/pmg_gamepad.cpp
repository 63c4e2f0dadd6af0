// pmg_gamepad: drives a robot by game controllers and shows its state.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "gamepad/pad_command.hpp"
#include "gamepad/pad_text.hpp"
#include "gamepad/sdl_pads.hpp"
#include "io/lcm_link.hpp"
#include "keyboard/key_command.hpp"
#include "keyboard/terminal_keys.hpp"
#include "operator/driving_station.hpp"
#include "program.hpp"
#include "raw_terminal.hpp"

namespace {

using namespace pmg;

constexpr const char* kFooter = R"(
The robot moves only while the deadman is held. It must be pressed anew, with neutral sticks, after a pad came, after a stop and after a
fault. The stop button of every pad damps the robot at once, and so does Esc in this terminal. Standing up, a reset and going limp are
chords that are held. Software stops are not safety-rated.

A pad that is out of radio reach may look like sticks that are held still. So a pad whose sticks are out and that sends nothing for 3 s
(still_s of the mapping) brings the velocity to zero. --wired switches this off: a cable that is pulled out is noticed at once.

Example:
  pmg_gamepad --robot z1

Exit codes: 0 ended with Ctrl-C, or by a signal: velocity was brought to zero first; 1 no controller was heard; 2 bad input, no terminal
or no network.)";

struct Arguments {
  std::string robot, lcm_url, keys, mapping = "standard";
  bool wired = false;
};

int drive(const Arguments& arguments) {
  constexpr int kWait_ms = 5;
  constexpr std::int64_t kPicture_ns = 100'000'000;
  gamepad::Mapping mapping = gamepad::read_mapping(gamepad::find_mapping(arguments.mapping));
  if (arguments.wired) mapping.still_s = std::numeric_limits<double>::infinity();
  const io::WallClock clock;
  io::LcmLink link(io::choose_lcm_url(arguments.lcm_url));
  gamepad::PadCommand command(mapping);
  ops::DrivingStation station(link, command, arguments.robot, ops::session_number(), clock,
                              seal::load_operator_seal(arguments.keys, link.url()));
  {
    apps::RawTerminal terminal;
    apps::notice({SIGINT, SIGTERM, SIGHUP, SIGQUIT}, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    gamepad::SdlPads pads;
    ops::TerminalKeys decoder;
    std::int64_t picture_at_ns = 0;
    while (!station.gone()) {
      if (apps::interrupt_requested != 0 || terminal.ended()) station.let_go();
      for (const ops::TerminalKey& key : decoder.take(terminal.read(), clock.now_ns()))
        if (ops::key_named(key.name) == ops::Key::kDamp) station.stop();
      const auto& reports = pads.poll();
      command.take(reports, clock.now_ns());
      station.step(kWait_ms);
      pads.show(gamepad::sign(station));
      if (clock.now_ns() < picture_at_ns) continue;
      picture_at_ns = clock.now_ns() + kPicture_ns;
      std::vector<std::string> lines = station.lines();
      lines.emplace_back();
      for (std::string& line : gamepad::pad_lines(command, station, reports, pads.useless()))
        lines.push_back(std::move(line));
      lines.emplace_back();
      for (const auto& [hold, meaning] : gamepad::mapping_rows(mapping))
        lines.push_back(fmt::format("{:<34}{}", hold, meaning));
      terminal.draw(lines);
    }
  }
  std::cout << station.last_words() << '\n';
  return station.heard() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Drives a robot by game controllers.", "pmg_gamepad");
  Arguments arguments;
  app.footer(kFooter);
  app.add_option("--robot", arguments.robot, "controller's name; may be left out when one is heard");
  app.add_option("--mapping", arguments.mapping,
                 "what buttons and sticks mean: a name in config/gamepads, or a file; standard if not given");
  app.add_flag("--wired", arguments.wired,
               "every pad is on a cable, so its loss is noticed: hold the sticks still for as long as you like");
  app.add_option("--lcm-url", arguments.lcm_url,
                 fmt::format("LCM address; LCM_DEFAULT_URL or {} if not given", io::kDefaultLcmUrl));
  app.add_option("--keys", arguments.keys, "folder of this operator's keys; ~/.config/pmg/operator-keys if not given");
  return apps::run_program(app, argc, argv, [&]() -> int { return drive(arguments); });
}
