// A log's tick computed again: the logged states, commands and requests through the same Tick, every output compared.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/excitation_player.hpp"

namespace pmg::logs {

/// What a run with --bench played.
struct PlayedExcitation {
  control::ExcitationPlan plan;
  std::string sha256;  ///< of its files
};

struct ReplayOptions {
  std::string robot;            ///< name or folder; empty: as the log says
  std::filesystem::path clips;  ///< empty: as the log says; the robot's own if robot is given
  /// Reads the excitation of this joint; folder as the log says. Absent: a run with one is refused.
  std::function<PlayedExcitation(const model::RobotModel&, const std::string& joint,
                                 const std::filesystem::path& folder)>
      excitation{};
};

/// Where an output isn't the logged one.
struct Difference {
  double time_s = 0.0;  ///< since the log's first event
  std::int64_t tick = 0;
  std::string channel;
  std::string field;  ///< with joint, foot, axis or command channel
  std::string logged, replayed;
};

struct ReplayReport {
  std::int64_t ticks = 0;
  double duration_s = 0.0;
  std::int64_t compared_messages = 0, different_messages = 0;
  std::optional<Difference> first;
  /// By channel and field: largest |logged - replayed| over numbers; infinite where one is no number or texts differ.
  std::map<std::string, double> largest;
  std::vector<std::string> notes;  ///< what differs before the first tick: bundle, options, software
  bool cut_short = false;          ///< the log's last event is incomplete

  bool equal() const { return different_messages == 0; }
  double largest_difference() const;
};

/// REFERENCE, MOTOR_COMMAND and STATUS of every tick, bit for bit. Throws std::runtime_error or
/// std::invalid_argument when these logs can't be replayed, and says why: they don't begin with the controller's first
/// tick, ticks are missing, or robot, clips or policy can't be loaded. progress is told the replayed time now and then.
ReplayReport replay(const std::vector<std::filesystem::path>& files, const ReplayOptions& options,
                    const std::function<void(double time_s)>& progress = {});

}  // namespace pmg::logs
