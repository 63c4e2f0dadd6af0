// (a log's states, commands and requests) => each tick computed again by the same Tick, and each output compared.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/excitation_player.hpp"
#include "work/progress.hpp"

namespace pmg::logs {

/// The excitation of a run with --bench.
struct PlayedExcitation {
  control::ExcitationPlan plan;
  std::string sha256;  ///< of the excitation's files
};

struct ReplayOptions {
  std::string robot;            ///< name or folder; empty: the log's
  std::filesystem::path clips;  ///< empty: the log's, or the robot's own if robot is given
  /// Reads the excitation of this joint from the log's folder. Without it a run with an excitation can't be replayed.
  std::function<PlayedExcitation(const model::RobotModel&, const std::string& joint,
                                 const std::filesystem::path& folder)>
      excitation{};
};

/// The place of a difference between an output and the log.
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
  /// By channel and field: largest |logged - replayed| of numbers; infinite if one is not finite or if texts differ.
  std::map<std::string, double> largest;
  std::vector<std::string> notes;  ///< differences before the first tick: bundle, options, software
  bool cut_short = false;          ///< the log's last event is incomplete

  bool equal() const { return different_messages == 0; }
  double largest_difference() const;
};

/// Compares REFERENCE, MOTOR_COMMAND, STATUS and ARMS_STATE of every tick, bit for bit. Throws std::runtime_error or
/// std::invalid_argument with the reason if these logs can't be replayed: they don't begin with the controller's first
/// tick, ticks are missing, or robot, clips or policy can't be loaded. From time to time it calls progress with the
/// replayed time.
ReplayReport replay(const std::vector<std::filesystem::path>& files, const ReplayOptions& options,
                    const work::Progress& progress = {});

}  // namespace pmg::logs
