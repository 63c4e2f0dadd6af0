// Commands that jump between the ends of their ranges, as fast as a person can throw a stick: does the robot stay up?
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"
#include "pmg/command.hpp"

namespace pmg::command_response {

inline constexpr double kJump_s = 0.5;  ///< between two jumps

/// Stands, walks for duration_s, and rests. Every kJump_s each velocity goes to its lower end, its upper end or 0 with
/// equal chances; with an even seed each posture does, too.
sil::Scenario jump_scenario(const CommandLimits& limits, std::uint64_t seed, double duration_s);

struct JumpTest {
  std::string robot, ranges_file;
  evaluation::Case evaluated;
  int seeds = 0;
  double duration_s = 60.0;                   ///< of jumping
  std::vector<evaluation::TrialResult> runs;  ///< by seed, from 1

  bool complete() const;
  bool all_survived() const;
};

/// Every seed is another robot with another sequence of jumps. The result doesn't depend on the number of jobs.
void run_jumps(JumpTest& test, const evaluation::Supervision& supervision);

work::Worth worth_of(const JumpTest& test);
nlohmann::ordered_json to_json(const JumpTest& test);
pages::Page page_of(const JumpTest& test);
std::vector<pages::Table> tables_of(const JumpTest& test);

}  // namespace pmg::command_response
