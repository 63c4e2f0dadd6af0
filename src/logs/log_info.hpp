// A summary of a log: controller, robot and policy, duration, events.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "control/mode.hpp"
#include "pmg_msgs/robot_info_t.hpp"

namespace pmg::logs {

/// Percentiles of one field of TIMING over the run.
struct TimingSpread {
  std::string name;
  double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
};

/// One run of one controller; a folder may hold several.
struct RunSummary {
  struct At {
    double time_s;  ///< since the run's first event
    std::string text;
  };

  std::optional<pmg_msgs::robot_info_t> info;  ///< absent: the log has no ROBOT_INFO
  std::vector<std::filesystem::path> files;
  double duration_s = 0.0;
  bool from_the_start = false;                   ///< the log holds the first tick
  std::map<std::string, std::int64_t> messages;  ///< by channel
  std::vector<At> modes;                         ///< with the time of each beginning
  std::vector<At> faults;
  std::map<std::string, double> driven_s;  ///< by source: seconds in which the controller followed it
  std::int64_t ticks = 0, lost_ticks = 0, missed_ticks = 0, missed_bus_cycles = 0;
  std::vector<TimingSpread> timing;  ///< empty in lockstep
};

struct LogSummary {
  std::vector<RunSummary> runs;
  std::int64_t skipped_bytes = 0;
  bool cut_short = false;
};

/// Reads these logs. Throws std::runtime_error if one can't be opened, or if none holds an event.
LogSummary summarise_logs(const std::vector<std::filesystem::path>& files);

nlohmann::ordered_json to_json(const LogSummary& summary);
std::string to_text(const LogSummary& summary);

}  // namespace pmg::logs
