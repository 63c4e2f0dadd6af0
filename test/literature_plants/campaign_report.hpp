// What many judgements amount to: shares with intervals, and the misses.
#pragma once

#include <string>
#include <vector>

#include "judgement.hpp"

namespace pmg::literature {

/// kept of `of`, with Wilson's 95 % interval.
struct Rate {
  std::string what;
  int kept = 0, of = 0;
  double share = 0.0, low = 0.0, high = 1.0;
};

struct CampaignReport {
  std::vector<Judgement> judgements;
  std::vector<Rate> rates;
  double median_width = 0.0;  ///< of the parameters' intervals, as a share of the truth
  double seconds = 0.0;       ///< mean of a diagnosis [CPU s]
};

CampaignReport report_of(std::vector<Judgement> judgements);

/// The rate of that name. Throws std::out_of_range if there is none.
const Rate& rate(const CampaignReport& report, const std::string& what);

/// (report, strata and verdicts) => (those of which no plant counts, and which no diagnosis said).
std::vector<std::string> absent(const CampaignReport& report, const std::vector<std::string>& wanted);

/// The table of rates, what counted of each stratum, and the misses, as Markdown.
std::string markdown(const CampaignReport& report);
nlohmann::ordered_json report_json(const CampaignReport& report);

}  // namespace pmg::literature
