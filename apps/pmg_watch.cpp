// pmg_watch: shows the state of the controllers on an LCM address in a terminal.
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "arms_operator/arms_board.hpp"
#include "arms_operator/arms_text.hpp"
#include "io/lcm_link.hpp"
#include "json_output.hpp"
#include "operator/nobody_answers.hpp"
#include "operator/robot_board.hpp"
#include "operator/robot_text.hpp"
#include "option_checks.hpp"
#include "program.hpp"

namespace {

using namespace pmg;

enum ExitCode { kOk = 0, kNotHeard = 1, kBadInput = 2 };

constexpr const char* kFooter = R"(
One robot fills a screen; of several each gets a line (--robot shows one of them at full length). Without a terminal: a line
a second and robot, or a JSON object with --json. Commands are in m/s, rad/s, rad and m: asked by who drives, u as the generator admits
it, u' as it is possible on the ground.

Examples:
  pmg_watch
  pmg_watch --once --json

Exit codes: 0 ended with Ctrl-C, or with --once a robot was heard; 1 with --once none was; 2 bad input or no network.)";

constexpr double kNotHeardAfter_s = 2.0;

struct Arguments {
  std::string robot, lcm_url, keys;
  double timeout_s = 3.0;
  bool once = false, json = false;
};

/// Width of the terminal. A longer line would wrap, and the next picture would begin too high.
std::size_t columns() {
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

class Watch {
 public:
  explicit Watch(const Arguments& arguments)
      : arguments_(arguments),
        link_(io::choose_lcm_url(arguments.lcm_url)),
        seal_(seal::load_operator_seal(arguments.keys, link_.url())),
        board_(link_, clock_, seal_),
        arms_(link_, clock_, seal_) {}

  /// Waits for one STATUS, and for a short time for the messages that come once a second.
  int once() {
    const auto complete = [&] {
      const std::vector<const ops::RobotNews*> shown = selected();
      return !shown.empty() &&
             std::ranges::all_of(shown, [](const ops::RobotNews* news) { return news->info && news->link; });
    };
    std::optional<double> heard_at_s;
    while (apps::interrupt_requested == 0 && elapsed_s() < arguments_.timeout_s && !complete()) {
      link_.receive(20);
      if (!heard_at_s && !selected().empty()) heard_at_s = elapsed_s();
      if (heard_at_s && elapsed_s() - *heard_at_s > 1.2) break;
    }
    print_all(true);
    return selected().empty() ? kNotHeard : kOk;
  }

  int forever() {
    const bool terminal = isatty(STDOUT_FILENO) != 0 && !arguments_.json;
    const double period_s = terminal ? 0.2 : 1.0;
    for (double next_s = period_s; apps::interrupt_requested == 0 && std::cout.good();) {
      link_.receive(20);
      if (elapsed_s() < next_s) continue;
      next_s = elapsed_s() + period_s;
      if (terminal) {
        redraw();
      } else {
        print_all(false);
      }
    }
    return kOk;
  }

 private:
  double elapsed_s() const { return static_cast<double>(clock_.now_ns() - begin_ns_) * 1e-9; }

  std::vector<const ops::RobotNews*> selected() const {
    std::vector<const ops::RobotNews*> news;
    for (const auto& [name, robot] : board_.robots()) {
      if (arguments_.robot.empty() || name == arguments_.robot) news.push_back(&robot);
    }
    return news;
  }

  std::string nobody() const { return ops::nobody_heard(link_.url(), arguments_.robot); }

  std::vector<std::string> screen(const ops::RobotNews& news) const {
    std::vector<std::string> lines = ops::screen(news, board_.silence_s(news));
    if (const ops::HeardArms* arms = arms_.of(news.status.robot)) {
      for (const std::string& line : ops::arms_lines(arms->state)) lines.push_back(line);
    }
    return lines;
  }

  void redraw() {
    std::vector<std::string> lines;
    const std::vector<const ops::RobotNews*> shown = selected();
    if (shown.size() == 1) {
      lines = screen(*shown.front());
    } else {
      for (const ops::RobotNews* news : shown) lines.push_back(ops::one_line(*news, board_.silence_s(*news)));
    }
    if (shown.empty()) lines = {elapsed_s() > kNotHeardAfter_s ? nobody() : "listening on " + link_.url()};
    std::string text;
    if (drawn_lines_ > 0)
      text += fmt::format("\x1b[{}A", drawn_lines_);  // moves the cursor to the beginning of the last picture
    for (const std::string& line : lines) text += line.substr(0, columns()) + "\x1b[K\n";
    text += "\x1b[J";
    drawn_lines_ = lines.size();
    std::cout << text << std::flush;
  }

  void print_all(bool at_length) {
    const std::vector<const ops::RobotNews*> shown = selected();
    if (shown.empty() && (at_length || elapsed_s() > kNotHeardAfter_s)) std::cerr << "pmg_watch: " << nobody() << '\n';
    for (const ops::RobotNews* news : shown) {
      const double silence_s = board_.silence_s(*news);
      if (arguments_.json) {
        nlohmann::ordered_json json = ops::news_json(*news, silence_s);
        if (const ops::HeardArms* arms = arms_.of(news->status.robot)) json["arms"] = ops::arms_json(arms->state);
        apps::print_json(json, at_length ? 2 : -1);
      } else if (at_length && shown.size() == 1) {
        for (const std::string& line : screen(*news)) std::cout << line << '\n';
      } else {
        std::cout << ops::one_line(*news, silence_s) << '\n';
      }
    }
    std::cout << std::flush;
  }

  const Arguments& arguments_;
  io::WallClock clock_;
  io::LcmLink link_;
  seal::OperatorSeal seal_;
  ops::RobotBoard board_;
  ops::ArmsBoard arms_;
  std::int64_t begin_ns_ = clock_.now_ns();
  std::size_t drawn_lines_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Shows what the controllers on an LCM address do.", "pmg_watch");
  Arguments arguments;
  app.footer(kFooter);
  app.add_option("--robot", arguments.robot, "show the controller of this name only");
  app.add_option("--lcm-url", arguments.lcm_url,
                 fmt::format("LCM address; LCM_DEFAULT_URL or {} if not given", io::kDefaultLcmUrl));
  app.add_option("--keys", arguments.keys, "folder of this operator's keys; ~/.config/pmg/operator-keys if not given");
  app.add_flag("--once", arguments.once, "print one status and end");
  app.add_option("--timeout", arguments.timeout_s, "with --once: wait so long [s]")
      ->capture_default_str()
      ->check(apps::positive());
  app.add_flag("--json", arguments.json, "print JSON, an object a line");
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, nullptr);
    std::signal(SIGPIPE, SIG_IGN);  // as in pmg_watch | head
    Watch watch(arguments);
    return arguments.once ? watch.once() : watch.forever();
  });
}
