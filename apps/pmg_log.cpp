// pmg_log: what a log is about, what is in it for other programs, and whether the same controller does the same again.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/log_series.hpp"
#include "logs/log_info.hpp"
#include "logs/replay.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kDifferent = 1, kBadInput = 2 };

constexpr const char* kFooter = R"(
LOG is a log file, or a folder that pmg_controller or pmg_sil wrote. A log that was cut short (power lost, program killed) is
read up to its last whole event.

Examples:
  pmg_log info out/tour
  pmg_log export out/tour --csv out/tour/csv
  pmg_log export out/tour --mcap out/tour/tour.mcap
  pmg_log replay out/tour

Exit codes: 0 done (replay: every output is the same, bit for bit), 1 replay: an output differs, 2 bad input or output.)";

struct Arguments {
  std::vector<fs::path> logs;
  bool json = false;
  logs::ReplayOptions replay;
  bool tolerant = false;
  double tolerance = 0.0;
};

int info(const Arguments& arguments) {
  const logs::LogSummary summary = logs::summarise_logs(io::log_files(arguments.logs));
  if (arguments.json) {
    std::cout << to_json(summary).dump(2) << '\n';
  } else {
    std::cout << to_text(summary);
  }
  return kOk;
}

nlohmann::ordered_json replay_json(const logs::ReplayReport& report, bool passed) {
  nlohmann::ordered_json json = {{"passed", passed},
                                 {"equal", report.equal()},
                                 {"ticks", report.ticks},
                                 {"duration_s", report.duration_s},
                                 {"compared_messages", report.compared_messages},
                                 {"different_messages", report.different_messages},
                                 {"cut_short", report.cut_short},
                                 {"notes", report.notes},
                                 {"largest_differences", report.largest}};
  if (report.first) {
    json["first_difference"] = {{"t_s", report.first->time_s},      {"tick", report.first->tick},
                                {"channel", report.first->channel}, {"field", report.first->field},
                                {"logged", report.first->logged},   {"replayed", report.first->replayed}};
  }
  return json;
}

void print_replay(const logs::ReplayReport& report) {
  for (const std::string& note : report.notes) std::cout << "note: " << note << '\n';
  if (report.cut_short) std::cout << "note: the log's last event is incomplete\n";
  std::cout << fmt::format("{} ticks, {:.2f} s, {} messages compared: ", report.ticks, report.duration_s,
                           report.compared_messages);
  if (report.equal()) {
    std::cout << "every output is the same, bit for bit\n";
    return;
  }
  const logs::Difference& first = *report.first;
  std::cout << fmt::format("{} differ\n", report.different_messages)
            << fmt::format("first: at {:.2f} s (tick {}) {} {}: logged {}, replayed {}\n", first.time_s, first.tick,
                           first.channel, first.field, first.logged, first.replayed);
  for (const auto& [field, value] : report.largest) std::cout << fmt::format("largest: {} {:.3g}\n", field, value);
}

int replay(const Arguments& arguments) {
  const bool watched = isatty(STDERR_FILENO) == 1;
  const logs::ReplayReport report =
      logs::replay(io::log_files(arguments.logs), arguments.replay, [watched](double time_s) {
        if (watched) std::cerr << fmt::format("\r{:8.1f} s replayed", time_s) << std::flush;
      });
  if (watched) std::cerr << '\r' << std::string(24, ' ') << '\r' << std::flush;
  const bool passed = report.equal() || (arguments.tolerant && report.largest_difference() <= arguments.tolerance);
  if (arguments.json) {
    std::cout << replay_json(report, passed).dump(2) << '\n';
  } else {
    print_replay(report);
  }
  return passed ? kOk : kDifferent;
}

CLI::App* command(CLI::App& app, Arguments& arguments, const char* name, const char* description) {
  CLI::App* command = app.add_subcommand(name, description);
  command->add_option("LOG", arguments.logs, "log files or folders")->required();
  command->footer(kFooter);
  return command;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Tells, exports and replays logs.", "pmg_log");
  Arguments arguments;
  app.footer(kFooter);
  app.require_subcommand(1);
  CLI::App* info_command = command(app, arguments, "info", "who ran what, for how long, and what happened");
  info_command->add_flag("--json", arguments.json, "as JSON");
  CLI::App* replay_command =
      command(app, arguments, "replay", "compute every tick again and compare all outputs, bit for bit");
  replay_command->add_flag("--json", arguments.json, "as JSON");
  replay_command->add_option("--robot", arguments.replay.robot, "robot's name or folder; as the log says if not given");
  replay_command->add_option("--clips", arguments.replay.clips, "clip library; as the log says if not given");
  replay_command
      ->add_option("--tolerance", arguments.tolerance,
                   "differences up to this pass: for a log of another compiler or mathematics library")
      ->check(CLI::NonNegativeNumber)
      ->each([&](const std::string&) { arguments.tolerant = true; });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kBadInput;
  }
  try {
    return info_command->parsed() ? info(arguments) : replay(arguments);
  } catch (const std::exception& error) {
    std::cerr << "pmg_log: " << error.what() << '\n';
    return kBadInput;
  }
}
