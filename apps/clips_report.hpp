// pmg_clips report and preview: a library beside the person that it was made from.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace pmg::apps {

struct ReportOptions {
  std::string robot = "z1";
  std::filesystem::path clips, recipe, recordings, out;
};

/// The subcommands and their options. preview is null in a build without simulation.
CLI::App* add_report(CLI::App& app, ReportOptions& options);
CLI::App* add_preview(CLI::App& app, ReportOptions& options);

/// Writes the page. Exit code: 0 every figure as asked, 1 one missed or not measured. Throws files::ConfigError and
/// work::Interrupted, and writes nothing then.
int report(const ReportOptions& options);

/// Writes the film. Throws as report, and std::runtime_error without ffmpeg or OSMesa.
int preview(const ReportOptions& options);

}  // namespace pmg::apps
