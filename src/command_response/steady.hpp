// Commands that are held: what share of them a policy realises once the robot walks steadily.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"
#include "pmg/command.hpp"

namespace pmg::command_response {

/// A velocity command within the box of robot.yaml's ranges, and the error that is allowed in each of its channels.
struct HeldCommand {
  std::string text;  ///< for people: "vx +80 %, omega -80 %"
  Command command;
  double limit = 0.0;                      ///< of |did - asked| / |asked|
  std::optional<double> drift_limit = {};  ///< of worst_drift(); nothing: any
};

/// Each velocity at both ends (limit 3 %), each pair at 80 % of both ranges and all three at 60 % with every
/// combination of signs (limit 10 %), and each velocity alone at 20 %, as beside a table (limit 15 %, which is 3 % of
/// the range as at its ends; drift 5 %): 6 + 12 + 8 + 6 commands where every range has two sides.
std::vector<HeldCommand> held_commands(const CommandLimits& limits);

struct HeldResult {
  bool complete = false;  ///< false: interrupted
  bool survived = false;  ///< neither fell nor faulted
  /// Means over the steady part. did: heading-frame velocities [m/s, rad/s], torso attitude [rad], height above
  /// standing [m]; admitted: the command that the generator took.
  Command did, admitted;
};

/// The largest |did - asked| / |asked| over the channels that the command uses; 1 for a robot that stands still.
double worst_error(const HeldCommand& asked, const Command& did);

/// The largest |did| / range over the velocity channels that the command leaves at 0: drift.
double worst_drift(const HeldCommand& asked, const Command& did, const CommandLimits& limits);

struct SteadyTest {
  std::string robot;
  evaluation::Candidate candidate;
  double settle_s = 6.0, steady_s = 8.0;  ///< of walking: until the measurement, and during it
  CommandLimits limits;                   ///< robot.yaml's
  std::vector<HeldCommand> commands;      ///< run_steady fills it if it is empty
  std::vector<HeldResult> results;        ///< by command

  bool complete() const;
  bool reached(std::size_t command) const;
  bool all_reached() const;
};

/// Runs every command with the robot as the model says. The result doesn't depend on the number of jobs.
void run_steady(SteadyTest& test, const evaluation::Supervision& supervision);

work::Worth worth_of(const SteadyTest& test);
nlohmann::ordered_json to_json(const SteadyTest& test);
pages::Page page_of(const SteadyTest& test);
std::vector<pages::Table> tables_of(const SteadyTest& test);

}  // namespace pmg::command_response
