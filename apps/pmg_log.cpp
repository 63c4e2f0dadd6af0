// pmg_log: summary of a log, its export for other programs, and its replay by the same controller.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/log_series.hpp"
#include "io/plain_text.hpp"
#include "json_output.hpp"
#include "logs/log_export.hpp"
#include "logs/log_info.hpp"
#include "logs/replay.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "result_folder.hpp"
#include "runtime/bench_session.hpp"
#include "shown_progress.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

enum ExitCode { kOk = 0, kDifferent = 1, kBadInput = 2, kInterrupted = 130 };

constexpr const char* kFooter = R"(
LOG is a log file, or a folder that pmg_controller or pmg_sil wrote. A log that was cut short (power lost, program killed) is
read up to its last whole event.

Examples:
  pmg_log info out/tour
  pmg_log export out/tour --csv out/tour/csv
  pmg_log export out/tour --mcap out/tour/tour.mcap
  pmg_log replay out/tour

Exit codes: 0 done (replay: every output is the same, bit for bit), 1 replay: an output differs, 2 bad input or output,
130 interrupted (what was exported until then is kept).)";

struct Arguments {
  std::vector<fs::path> logs;
  bool json = false, overwrite = false;
  fs::path csv, mcap;
  std::string robot;
  logs::ReplayOptions replay;
  fs::path excitation;
  bool tolerant = false;
  double tolerance = 0.0;
};

int info(const Arguments& arguments) {
  const logs::LogSummary summary = logs::summarise_logs(io::log_files(arguments.logs));
  if (arguments.json) {
    apps::print_json(to_json(summary));
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
  for (const std::string& note : report.notes) std::cout << "note: " << io::plain_text(note) << '\n';
  if (report.cut_short) std::cout << "note: the log's last event is incomplete\n";
  std::cout << fmt::format("{} ticks, {:.2f} s, {} messages compared: ", report.ticks, report.duration_s,
                           report.compared_messages);
  if (report.equal()) {
    std::cout << "every output is the same, bit for bit\n";
    return;
  }
  const logs::Difference& first = *report.first;
  std::cout << fmt::format("{} differ\n", report.different_messages)
            << io::plain_text(fmt::format("first: at {:.2f} s (tick {}) {} {}: logged {}, replayed {}", first.time_s,
                                          first.tick, first.channel, first.field, first.logged, first.replayed))
            << '\n';
  for (const auto& [field, value] : report.largest) std::cout << fmt::format("largest: {} {:.3g}\n", field, value);
}

void print_export(const Arguments& arguments, const fs::path& into, const logs::ExportReport& report) {
  if (arguments.json) {
    apps::print_json(nlohmann::ordered_json{
        {"file", into.string()}, {"messages", report.messages}, {"left_out", report.unknown}, {"notes", report.notes}});
    return;
  }
  std::int64_t all = 0;
  for (const auto& [channel, count] : report.messages) all += count;
  std::cout << fmt::format("{} messages of {} channels in {}\n", all, report.messages.size(), into.string());
  for (const std::string& note : report.notes) std::cout << "note: " << io::plain_text(note) << '\n';
  if (report.unknown > 0) std::cout << fmt::format("{} messages that aren't known were left out\n", report.unknown);
}

/// An export is never written over something else: neither over a log nor among the tables of another one.
void expect_new_targets(const Arguments& arguments, const std::vector<fs::path>& logs) {
  for (const fs::path& log : logs) {
    std::error_code error;  // no such file yet
    if (!arguments.mcap.empty() && fs::equivalent(log, arguments.mcap, error))
      throw std::invalid_argument(arguments.mcap.string() + ": is the log itself; expected a new file");
  }
  if (arguments.overwrite) return;
  if (!arguments.csv.empty())
    files::expect_unused(arguments.csv, "an export", {"STATUS.csv", "STATE.csv", "ROBOT_INFO.csv"},
                         "a new folder, or --overwrite");
  if (!arguments.mcap.empty() && fs::is_regular_file(arguments.mcap))
    throw std::invalid_argument(arguments.mcap.string() + ": is there already; expected a new file, or --overwrite");
}

int export_log(const Arguments& arguments) {
  if (arguments.csv.empty() && arguments.mcap.empty())
    throw std::invalid_argument("export needs --csv or --mcap (pmg_log export --help shows an example)");
  apps::notice({SIGINT, SIGTERM}, "closing the files that were begun");
  apps::ProgressLine line;
  const work::Progress progress = apps::shown(line);
  const std::vector<fs::path> files = io::log_files(arguments.logs);
  expect_new_targets(arguments, files);
  const auto tell = [&](const fs::path& target, const logs::ExportReport& exported) {
    line.clear();
    print_export(arguments, target, exported);
  };
  if (!arguments.csv.empty()) tell(arguments.csv, logs::export_csv(files, arguments.csv, progress));
  if (!arguments.mcap.empty() && apps::interrupt_requested == 0) {
    tell(arguments.mcap, logs::export_mcap(files, arguments.mcap, arguments.robot, progress));
  }
  return apps::interrupt_requested == 0 ? kOk : kInterrupted;
}

/// The excitation of a run with --bench, from its folder at that time or from --excitation.
logs::PlayedExcitation played_excitation(const model::RobotModel& robot, const std::string& joint,
                                         const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw std::invalid_argument(fmt::format(
        "this run excited {} by {}, which isn't here; expected its place now in --excitation", joint, folder.string()));
  }
  const bench::Excitation excitation = bench::read_excitation(folder);
  return {runtime::excitation_plan(robot, joint, excitation), bench::excitation_sha256(folder, excitation)};
}

logs::ReplayReport replay_with_progress(const Arguments& arguments) {
  apps::ProgressLine line;
  logs::ReplayOptions options = arguments.replay;
  options.excitation = [&](const model::RobotModel& robot, const std::string& joint, const fs::path& logged) {
    return played_excitation(robot, joint, arguments.excitation.empty() ? logged : arguments.excitation);
  };
  return logs::replay(io::log_files(arguments.logs), options, apps::shown(line));
}

int replay(const Arguments& arguments) {
  const logs::ReplayReport report = replay_with_progress(arguments);
  const bool passed = report.equal() || (arguments.tolerant && report.largest_difference() <= arguments.tolerance);
  if (arguments.json) {
    apps::print_json(replay_json(report, passed));
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
  CLI::App* export_command = command(app, arguments, "export", "write a log for other programs");
  export_command->add_option("--csv", arguments.csv, "folder for one CSV a channel");
  export_command->add_option("--mcap", arguments.mcap, "MCAP file, for Foxglove (layout: config/foxglove/walk.json)");
  export_command->add_option(
      "--robot", arguments.robot,
      "robot's name or folder, for its frames and URDF in the MCAP; as the log says if not given");
  export_command->add_flag("--overwrite", arguments.overwrite, "replace an export that is there");
  export_command->add_flag("--json", arguments.json, "say as JSON what was written");
  CLI::App* replay_command =
      command(app, arguments, "replay", "compute every tick again and compare all outputs, bit for bit");
  replay_command->add_flag("--json", arguments.json, "as JSON");
  replay_command->add_option("--robot", arguments.replay.robot, "robot's name or folder; as the log says if not given");
  replay_command->add_option("--clips", arguments.replay.clips, "clip library; as the log says if not given");
  replay_command->add_option("--excitation", arguments.excitation,
                             "folder of the excitation that a run with --bench played; as the log says if not given");
  replay_command
      ->add_option("--tolerance", arguments.tolerance,
                   "differences up to this pass: for a log of another compiler or mathematics library")
      ->check(apps::non_negative())
      ->each([&](const std::string&) { arguments.tolerant = true; });
  return apps::run_program(app, argc, argv, [&]() -> int {
    if (info_command->parsed()) return info(arguments);
    return export_command->parsed() ? export_log(arguments) : replay(arguments);
  });
}
