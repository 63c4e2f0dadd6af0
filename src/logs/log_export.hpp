// A log for other programs: CSV for a spreadsheet or pandas, MCAP for Foxglove.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "work/progress.hpp"

namespace pmg::logs {

struct ExportReport {
  std::map<std::string, std::int64_t> messages;  ///< by channel
  std::int64_t unknown = 0;                      ///< events that are left out: unknown channel or unknown bytes
  std::vector<std::string> notes;                ///< what could not be had, one sentence each
};

/// Writes FOLDER/CHANNEL.csv with one row for each message: time_s since the log's first event, then the fields of
/// msgs/; behind a number that means one of several constants its name ("mode", "mode_name"). An element of a vector
/// has the name of its joint, foot, axis or command channel: "q_rad.left_knee". Makes the folder if it is absent.
/// Throws std::runtime_error. Where progress is over, it keeps the part so far.
ExportReport export_csv(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder,
                        const work::Progress& progress = {});

/// Writes one MCAP file of JSON messages with JSON schemas: one topic for each channel, vectors as objects ("q_rad":
/// {"left_knee": ...}), and Foxglove's own topics (foxglove_topics.hpp). Numbers have the digits of a 32-bit float; the
/// CSV has all. Times are UTC if the log holds the wall clock of its start, else those of its own clock. Numbers that
/// aren't finite are null. robot: the name or folder of the log's robot; empty: as the log says. Throws
/// std::runtime_error, and files::ConfigError for a named robot that can't be read.
ExportReport export_mcap(const std::vector<std::filesystem::path>& files, const std::filesystem::path& file,
                         const std::string& robot = {}, const work::Progress& progress = {});

}  // namespace pmg::logs
