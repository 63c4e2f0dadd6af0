// summary.json: one run in figures, for people and for CI.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "model/robot_model.hpp"
#include "sil/run_measure.hpp"
#include "sil/stage_timing.hpp"

namespace pmg::sil {

/// What was run: everything that the figures depend on besides the code.
struct RunIdentity {
  std::string robot, scenario, policy;
  std::uint64_t seed = 0;
  double wall_s = 0.0;
  std::string variant{};  ///< the policy's; empty without one
};

nlohmann::ordered_json summary_json(const RunIdentity& run, const RunOutcome& outcome, const StageTiming& timing,
                                    const model::RobotModel& robot);

/// Its parts, as reports tell them too.
nlohmann::ordered_json tracking_json(const TrackingSummary& tracking);
nlohmann::ordered_json reference_slip_json(const gco::SlipSummary& slip);

/// Throws std::runtime_error.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace pmg::sil
