// The paper's table of teleoperation tasks: how often a scripted operator in a headset does them.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/campaign.hpp"
#include "pages/page.hpp"
#include "teleoperation/wiping.hpp"

namespace pmg::teleoperation {

inline constexpr double kPaperWiping = 0.95, kPaperBoxPicking = 0.80;  ///< over 20 trials each on the real Z1

/// The wiping task. Box picking isn't in it yet.
struct Table3 {
  std::string robot, ranges_file;
  evaluation::Case evaluated;
  int trials = 0;
  std::vector<WipingResult> wiping;  ///< by trial; kInterrupted: it didn't take place
  bool complete = true;

  evaluation::Estimate wiped() const;  ///< share of success with Wilson's interval, over the trials that took place
  std::map<std::string, int> ends() const;  ///< of those, by end_name()
  bool reached() const;                     ///< at or above the paper's share
};

/// Trial i has the same robot and towel for every policy. The result doesn't depend on the number of jobs.
void run_table3(Table3& table, const evaluation::Supervision& supervision);

/// Interrupted; missed, below the paper's share; partial, as box picking isn't simulated.
work::Worth worth_of(const Table3& table);

nlohmann::ordered_json to_json(const Table3& table);
pages::Page page_of(const Table3& table);
std::vector<std::string> text_of(const Table3& table);

}  // namespace pmg::teleoperation
