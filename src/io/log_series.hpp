// Several logs, given as files or folders, read in order as one log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "io/log_reader.hpp"

namespace pmg::io {

/// The folder's log-NNNN.lcm files by number.
std::map<int, std::filesystem::path> rotated_log_files(const std::filesystem::path& folder);

/// The log files of these paths, in the order of a run. A folder stands for its log.lcm, or for its log-NNNN.lcm by
/// number. A flight recorder's fault-*.lcm are logs of their own; name them one by one. Throws std::runtime_error with
/// the path that is absent or holds no log.
std::vector<std::filesystem::path> log_files(const std::vector<std::filesystem::path>& paths);

/// All events of these files.
class LogSeries {
 public:
  explicit LogSeries(std::vector<std::filesystem::path> files);  ///< throws std::runtime_error when the first can't be
                                                                 ///< opened, next() when a later one can't

  bool next();  ///< to the next event; false at the end of the last file
  const LogReader& event() const { return *reader_; }
  const std::filesystem::path& file() const { return files_[at_]; }  ///< the event's file
  std::size_t file_number() const { return at_; }

  /// Of all files so far.
  std::int64_t skipped_bytes() const { return skipped_before_ + reader_->skipped_bytes(); }
  bool cut_short() const { return cut_short_; }  ///< a file's last event is incomplete

 private:
  std::vector<std::filesystem::path> files_;
  std::size_t at_ = 0;
  std::optional<LogReader> reader_;
  std::int64_t skipped_before_ = 0;
  bool cut_short_ = false;
};

}  // namespace pmg::io
