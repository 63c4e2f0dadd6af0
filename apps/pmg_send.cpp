// pmg_send: asks a running controller for a mode, drives it for some time, or stops it, from a shell.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "arms_operator/arms_board.hpp"
#include "arms_operator/arms_lead.hpp"
#include "io/lcm_link.hpp"
#include "io/plain_text.hpp"
#include "json_output.hpp"
#include "operator/drive.hpp"
#include "operator/hoist_wish.hpp"
#include "operator/mode_wish.hpp"
#include "operator/nobody_answers.hpp"
#include "operator/robot_board.hpp"
#include "operator/way_up.hpp"
#include "operator/words.hpp"
#include "program.hpp"
#include "send_arguments.hpp"

namespace {

using namespace pmg;

enum ExitCode { kOk = 0, kNotReached = 1, kBadInput = 2, kInterrupted = 130 };

using Arguments = apps::SendArguments;

/// A stop goes out whatever the keys are: nobody needs one to stop a robot.
seal::OperatorSeal load_seal(const Arguments& arguments, const std::string& lcm_url) {
  try {
    return seal::load_operator_seal(arguments.keys, lcm_url);
  } catch (const std::exception& error) {
    if (arguments.request != "stop") throw;
    std::cerr << "pmg_send: " << io::plain_text(error.what()) << "; the stop goes out without a key\n";
    return {};
  }
}

class Session {
 public:
  explicit Session(const Arguments& arguments)
      : arguments_(arguments),
        link_(io::choose_lcm_url(arguments.lcm_url)),
        seal_(load_seal(arguments, link_.url())),
        source_(link_, seal_.source_name("pmg_send"), ops::session_number(), clock_, seal_),
        board_(link_, clock_, seal_),
        arms_(link_, clock_, seal_) {}

  int run() {
    for (const apps::SendRequest& request : apps::kSendRequests) {
      if (arguments_.request == request.name) return ask(request);
    }
    return arguments_.request == apps::kLift || arguments_.request == apps::kLower ? hoist() : drive();
  }

 private:
  double timeout_s(double otherwise) const { return arguments_.timeout_s > 0.0 ? arguments_.timeout_s : otherwise; }

  /// Name of the robot to command. Reports an error and returns empty if there is none.
  std::string find_robot(double within_s) {
    if (!arguments_.robot.empty()) return arguments_.robot;
    const std::int64_t begin_ns = clock_.now_ns();
    const auto elapsed_ns = [&] { return clock_.now_ns() - begin_ns; };
    while (apps::interrupt_requested == 0 && static_cast<double>(elapsed_ns()) * 1e-9 < within_s &&
           (source_.heard().empty() || elapsed_ns() < ops::ModeWish::kGather_ns)) {
      link_.receive(10);
    }
    if (source_.heard().size() == 1) return source_.heard().begin()->first;
    if (source_.heard().empty()) {
      report({{.robot = "", .mode = "unknown", .text = ops::nobody_heard(link_.url())}}, false);
      return "";
    }
    std::string names;
    for (const auto& [name, heard] : source_.heard()) names += (names.empty() ? "" : ", ") + name;
    throw std::invalid_argument(fmt::format("several robots are heard ({}): say which one with --robot", names));
  }

  int ask(const apps::SendRequest& request) {
    const bool every_robot = request.goal == ops::Goal::kStop;
    const std::string robot = every_robot ? arguments_.robot : find_robot(timeout_s(request.timeout_s));
    if (robot.empty() && !every_robot) return apps::interrupt_requested != 0 ? kInterrupted : kNotReached;
    ops::ModeWish wish(source_, robot, request.goal, timeout_s(request.timeout_s));
    ops::Progress progress = ops::Progress::kPending;
    while (progress == ops::Progress::kPending && apps::interrupt_requested == 0) {
      link_.receive(10);
      progress = wish.step();
      say_whose_lease(robot, wish.waits_for());
    }
    std::vector<ops::Answer> answers = wish.answers();
    if (answers.empty()) {
      answers.push_back({.robot = "", .mode = "unknown", .text = ops::nobody_heard(link_.url())});
    }
    const bool reached = progress == ops::Progress::kReached;
    for (ops::Answer& answer : answers)
      if (!every_robot && (!reached || request.goal == ops::Goal::kReset) && listened(answer.robot))
        answer.text += (answer.text.empty() ? "" : ": ") + way_up(answer.robot);
    report(answers, reached, wish.elapsed_s());
    return apps::interrupt_requested != 0 ? kInterrupted : reached ? kOk : kNotReached;
  }

  /// Its answer wasn't that somebody else asks, or that this user has no key.
  bool listened(const std::string& robot) const {
    const ops::HeardRobot* heard = source_.heard(robot);
    return heard != nullptr && heard->ack &&
           (heard->ack->verdict == pmg_msgs::ack_t::TAKEN || heard->ack->verdict == pmg_msgs::ack_t::TILTED);
  }
  /// What comes next so that the robot stands; empty: it does.
  std::string way_up(const std::string& robot) const {
    const ops::HeardRobot* heard = source_.heard(robot);
    if (heard == nullptr) return "";
    return ops::way_up(ops::posture(*heard, news_of(robot), clock_.now_ns()), ops::shell_manner());
  }

  int hoist() {
    const std::string robot = find_robot(timeout_s(apps::kHoistTimeout_s));
    if (robot.empty()) return apps::interrupt_requested != 0 ? kInterrupted : kNotReached;
    ops::HoistWish wish(source_, robot, arguments_.request == apps::kLift, timeout_s(apps::kHoistTimeout_s));
    ops::Progress progress = ops::Progress::kPending;
    while (progress == ops::Progress::kPending && apps::interrupt_requested == 0) {
      link_.receive(10);
      progress = wish.step();
    }
    const std::string way = progress == ops::Progress::kFailed ? way_up(robot) : "";
    return conclude(robot, progress, wish.text() + (way.empty() ? "" : ": " + way), wish.elapsed_s());
  }

  int drive() {
    const std::string robot = find_robot(timeout_s(apps::kDriveTimeout_s));
    if (robot.empty()) return apps::interrupt_requested != 0 ? kInterrupted : kNotReached;
    ops::Drive drive(source_, robot, arguments_.command,
                     {.duration_s = arguments_.duration_s,
                      .climb = arguments_.request == "walk" || arguments_.request == apps::kArms,
                      .timeout_s = timeout_s(apps::kDriveTimeout_s)});
    std::optional<ops::ArmsLead> lead;
    if (arguments_.request == apps::kArms) lead.emplace(clock_, arms_, robot, apps::palm_goals(arguments_));
    bool led = false;
    std::string arms_text;
    ops::Progress progress = ops::Progress::kPending;
    while (progress == ops::Progress::kPending) {
      link_.receive(5);
      if (lead && drive.driving()) {
        lead->step();
        drive.lead(lead->wishes());
        led = lead->reached();
        arms_text = lead->trouble().empty() ? lead->text() : lead->trouble();
        if (!lead->trouble().empty()) drive.end_early();
      }
      if (apps::interrupt_requested != 0) drive.end_early();
      progress = drive.step(news_of(robot));
      say_whose_lease(robot, drive.waits_for());
      say_what_is_taken(robot, drive.limited());
      show_progress(robot, drive);
    }
    const bool drove = progress == ops::Progress::kReached;
    if (!lead) return conclude(robot, progress, drive.last_words(), drive.driven_s());
    if (drove && !led) progress = ops::Progress::kFailed;
    return conclude(robot, progress, drive.last_words() + (arms_text.empty() ? "" : "; " + arms_text),
                    drive.driven_s());
  }

  int conclude(const std::string& robot, ops::Progress progress, const std::string& text, double elapsed_s) {
    const bool reached = progress == ops::Progress::kReached;
    ops::Answer answer{.robot = robot, .progress = progress, .mode = "unknown", .text = text};
    const ops::HeardRobot* heard = source_.heard(robot);
    if (heard != nullptr && heard->mode()) {
      answer.acknowledged = true;
      answer.mode = ops::mode_name(*heard->mode());
    }
    report({answer}, reached, elapsed_s);
    return apps::interrupt_requested != 0 ? kInterrupted : reached ? kOk : kNotReached;
  }

  /// Prints once why nothing happens yet.
  void say_whose_lease(const std::string& robot, const std::string& source) {
    if (source.empty() || waiting_said_) return;
    waiting_said_ = true;
    std::cerr << io::plain_text(robot + ": " + source)
              << " drove and fell silent without letting go; waiting until its lease is over\n";
  }

  /// Null: the robot has sent nothing.
  const ops::RobotNews* news_of(const std::string& robot) const {
    const auto news = board_.robots().find(robot);
    return news == board_.robots().end() ? nullptr : &news->second;
  }

  /// Prints once that the controller cannot follow the command as asked.
  void say_what_is_taken(const std::string& robot, const std::string& text) {
    if (text.empty() || !limited_.empty()) return;
    limited_ = text;
    std::cerr << io::plain_text(fmt::format("{}: {}", robot, text)) << '\n';
  }

  /// Prints the progress once a second, if stderr is a terminal.
  void show_progress(const std::string& robot, const ops::Drive& drive) {
    const auto second = static_cast<int>(drive.driven_s());
    if (!drive.driving() || second == shown_second_ || isatty(STDERR_FILENO) == 0) return;
    shown_second_ = second;
    std::cerr << fmt::format("{}: walk, {} of {:g} s (Ctrl-C: come to rest)\n", io::plain_text(robot), second,
                             arguments_.duration_s);
  }

  void report(const std::vector<ops::Answer>& answers, bool reached, double elapsed_s = 0.0) const {
    if (arguments_.json) {
      nlohmann::ordered_json json{{"request", arguments_.request},
                                  {"reached", reached},
                                  {"elapsed_s", elapsed_s},
                                  {"lcm_url", link_.url()},
                                  {"robots", nlohmann::json::array()}};
      if (!limited_.empty()) json["limited"] = limited_;
      for (const ops::Answer& answer : answers) {
        if (answer.robot.empty()) {
          json["text"] = answer.text;
          continue;
        }
        nlohmann::ordered_json entry = {{"robot", answer.robot},
                                        {"acknowledged", answer.acknowledged},
                                        {"reached", answer.progress == ops::Progress::kReached},
                                        {"mode", answer.mode},
                                        {"text", answer.text}};
        if (answer.acknowledged_after_s) entry["acknowledged_after_s"] = *answer.acknowledged_after_s;
        if (answer.reached_after_s) entry["reached_after_s"] = *answer.reached_after_s;
        json["robots"].push_back(std::move(entry));
      }
      apps::print_json(json);
      return;
    }
    for (const ops::Answer& answer : answers) {
      const std::string text = answer.text.empty() ? "" : " (" + answer.text + ")";
      std::ostream& out = reached ? std::cout : std::cerr;
      if (answer.robot.empty()) {
        out << "pmg_send: " << io::plain_text(answer.text) << '\n';
      } else {
        out << io::plain_text(fmt::format("{}: {}{}{}", answer.robot, answer.mode, text, times_text(answer))) << '\n';
      }
    }
  }

  /// Of a stop: how long each half took.
  std::string times_text(const ops::Answer& answer) const {
    if (arguments_.request != "stop" || !answer.acknowledged_after_s || !answer.reached_after_s) return {};
    return fmt::format("; acknowledged after {:.0f} ms, damping known after {:.0f} ms",
                       1e3 * *answer.acknowledged_after_s, 1e3 * *answer.reached_after_s);
  }

  const Arguments& arguments_;
  io::WallClock clock_;
  io::LcmLink link_;
  seal::OperatorSeal seal_;
  ops::OperatorSource source_;
  ops::RobotBoard board_;
  ops::ArmsBoard arms_;
  std::string limited_;  ///< the controller's replacement of a command that it cannot follow; or empty
  bool waiting_said_ = false;
  int shown_second_ = -1;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Asks a running controller for a mode, drives it for a while, or stops it.", "pmg_send");
  Arguments arguments;
  apps::declare(app, arguments);
  return apps::run_program(app, argc, argv, [&]() -> int {
    arguments.request = app.get_subcommands().front()->get_name();
    if (arguments.request == apps::kArms) apps::palm_goals(arguments);  // wrong ones are told before anything moves
    apps::notice({SIGINT, SIGTERM}, "bringing the robot to rest");
    return Session(arguments).run();
  });
}
