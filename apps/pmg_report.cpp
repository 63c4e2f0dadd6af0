// pmg_report: a page with pictures of one or several logs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "json_output.hpp"
#include "pages/page.hpp"
#include "program.hpp"
#include "report/run_figures.hpp"
#include "report/run_report.hpp"
#include "shown_progress.hpp"

namespace {

namespace fs = std::filesystem;
using namespace pmg;

constexpr const char* kFooter = R"(
LOG is a .lcm file, or the folder of a run. Several logs are laid over each other, each from its own beginning. The page
holds all that it needs: it can be mailed and read without a network. docs/how-to/reports.md says how to read it.

Example:
  pmg_report out/tour/log.lcm --out tour.html

Exit codes: 0 the page is written, 1 it is written but part of a log could not be read, 2 bad input or output, 130
interrupted (the page shows what was read until then).)";

struct Arguments {
  std::vector<fs::path> logs;
  fs::path out = "report.html";
  bool json = false;
};

std::vector<report::RunSeries> read(const std::vector<fs::path>& logs) {
  std::vector<report::RunSeries> runs;
  apps::ProgressLine progress;
  for (const fs::path& log : logs) {
    runs.push_back(report::read_run(log, apps::shown(progress, "reading " + log.string())));
  }
  return runs;
}

void tell(const Arguments& arguments, const std::vector<report::RunSeries>& runs) {
  if (arguments.json) {
    nlohmann::ordered_json json = {{"report", arguments.out.string()}, {"runs", nlohmann::ordered_json::array()}};
    for (const report::RunSeries& run : runs) json["runs"].push_back(report::run_json(run));
    apps::print_json(json);
    return;
  }
  for (const report::RunSeries& run : runs) {
    std::cout << report::verdict(run) << '\n';
    if (const std::string worth = worth_of_reading(run).sentence(); !worth.empty()) std::cout << "  " << worth << '\n';
  }
  std::cout << fmt::format("report in {}\n", arguments.out.string());
}

int write_report(const Arguments& arguments) {
  if (arguments.logs.size() > report::kMostRuns) {
    throw std::invalid_argument(
        fmt::format("{} logs; expected {} at most in one report", arguments.logs.size(), report::kMostRuns));
  }
  for (const fs::path& log : arguments.logs) {
    if (log.extension() == ".html")
      throw std::invalid_argument(
          fmt::format("{}: is no log; --out {} names the file for the page", log.string(), log.string()));
  }
  if (fs::is_directory(arguments.out))
    throw std::invalid_argument(fmt::format("--out {}: is a folder; expected a file for the page, as {}",
                                            arguments.out.string(), (arguments.out / "report.html").string()));
  pages::expect_page_or_none(arguments.out);
  const std::vector<report::RunSeries> runs = read(arguments.logs);
  report::run_report(runs).write(arguments.out);
  tell(arguments, runs);
  work::Worth reading;
  for (const report::RunSeries& run : runs) reading.add(worth_of_reading(run));
  return reading.exit_code();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Shows logs as one self-contained HTML page, pictures first.", "pmg_report");
  Arguments arguments;
  app.footer(kFooter);
  app.add_option("LOG", arguments.logs, "log of a run, or a run's folder; several are laid over each other")
      ->required();
  app.add_option("--out", arguments.out, "file for the page")->capture_default_str();
  app.add_flag("--json", arguments.json, "print the runs' figures on stdout as JSON instead of one line each");
  return apps::run_program(app, argc, argv, [&]() -> int {
    apps::notice({SIGINT, SIGTERM}, "drawing what was read until now");
    return write_report(arguments);
  });
}
