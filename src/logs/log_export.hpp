// A log for other programs: CSV for a spreadsheet or pandas, MCAP for Foxglove.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace pmg::logs {

struct ExportReport {
  std::map<std::string, std::int64_t> messages;  ///< by channel
  std::int64_t unknown = 0;  ///< events of channels, or with bytes, that this program doesn't know: left out
};

/// Told now and then; false ends the export, and what was done until then is kept.
using ExportProgress = std::function<bool(double time_s)>;

/// FOLDER/CHANNEL.csv, one row a message: time_s since the log's first event, then the fields of msgs/, vectors with
/// the joint's, foot's, axis' or command channel's name: "q_rad.left_knee". The folder is made if absent. Throws
/// std::runtime_error.
ExportReport export_csv(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder,
                        const ExportProgress& progress = {});

/// One MCAP file of JSON messages with JSON schemas: a topic a channel, vectors as objects ("q_rad": {"left_knee":
/// ...}). Times are UTC when the log knows when it began, else those of its clock. Numbers that are none are null.
/// Throws std::runtime_error.
ExportReport export_mcap(const std::vector<std::filesystem::path>& files, const std::filesystem::path& file,
                         const ExportProgress& progress = {});

}  // namespace pmg::logs
