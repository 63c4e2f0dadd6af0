#include "campaign_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>

#include "evaluation/statistics.hpp"
#include "fitting/statistics.hpp"

namespace pmg::literature {

namespace {

Rate rate_of(const std::string& what, const std::vector<Judgement>& judgements, auto counts, auto keeps) {
  Rate r;
  for (const Judgement& j : judgements) {
    if (!counts(j)) continue;
    ++r.of;
    r.kept += keeps(j) ? 1 : 0;
  }
  const evaluation::Estimate share = evaluation::share_interval(r.kept, r.of);
  return {what, r.kept, r.of, share.mean, share.lower, share.upper};
}

auto counted(const char* kind) {
  return [kind](const Judgement& j) { return j.counts && j.score.kind == kind; };
}

Rate parameters_inside(const std::vector<Judgement>& judgements) {
  int kept = 0, of = 0;
  for (const Judgement& j : judgements) {
    for (const ScoredParameter& p : j.score.parameters) {
      ++of;
      kept += p.inside() ? 1 : 0;
    }
  }
  const evaluation::Estimate share = evaluation::share_interval(kept, of);
  return {"parameters in their intervals", kept, of, share.mean, share.lower, share.upper};
}

std::vector<Rate> rates_of(const std::vector<Judgement>& all) {
  const auto right = [](const Judgement& j) { return j.right; };
  const auto effects = [](const Judgement& j) {
    return j.counts && (j.score.kind == "single" || j.score.kind == "double");
  };
  const auto any = [](const Judgement& j) { return j.counts; };
  std::vector<Rate> rates;
  rates.push_back(rate_of("singles named", all, counted("single"), right));
  rates.push_back(rate_of("one effect or two: all named", all, effects, right));
  rates.push_back(rate_of("verdict ambiguous, of singles and doubles", all, effects,
                          [](const Judgement& j) { return j.score.ambiguous; }));
  rates.push_back(rate_of(
      "of these settled by the recordings asked for", all,
      [&](const Judgement& j) { return effects(j) && j.score.ambiguous; },
      [](const Judgement& j) { return j.score.settled; }));
  rates.push_back(rate_of("doubles: both named", all, counted("double"), right));
  rates.push_back(
      rate_of("data faults named", all, counted("fault"), [](const Judgement& j) { return j.fault_named; }));
  rates.push_back(rate_of("data faults named, with their runs and without a false cause", all, counted("fault"),
                          [](const Judgement& j) { return j.right && j.fault_placed; }));
  rates.push_back(rate_of("clean kept clean", all, counted("clean"), right));
  rates.push_back(rate_of("found with a false cause", all, any, [](const Judgement& j) { return j.false_cause; }));
  rates.push_back(rate_of("off the catalogue: unexplained", all, counted("strange"), right));
  rates.push_back(rate_of(
      "residual extension better on left-out data", all,
      [](const Judgement& j) { return j.counts && j.extension_better.has_value(); },
      [](const Judgement& j) { return *j.extension_better; }));
  rates.push_back(rate_of(
      "off the catalogue: residual extension better on left-out data", all,
      [](const Judgement& j) { return j.counts && j.score.kind == "strange" && j.extension_better.has_value(); },
      [](const Judgement& j) { return *j.extension_better; }));
  rates.push_back(parameters_inside(all));
  return rates;
}

std::string row(const Judgement& j) {
  return fmt::format("| {} | {} | {} | {} | {} | {}{} | {:.1f} |\n", j.score.seed, j.score.kind, j.law, j.planted,
                     j.said,
                     !j.counts ? "weak"
                     : j.right ? "yes"
                               : "no",
                     j.false_cause     ? ", false cause"
                     : j.score.settled ? ", settled"
                                       : "",
                     j.score.seconds);
}

}  // namespace

CampaignReport report_of(std::vector<Judgement> judgements) {
  CampaignReport report;
  report.judgements = std::move(judgements);
  report.rates = rates_of(report.judgements);
  std::vector<double> widths;
  for (const Judgement& j : report.judgements) {
    for (const ScoredParameter& p : j.score.parameters) widths.push_back(p.width());
    report.seconds += j.score.seconds / static_cast<double>(report.judgements.size());
  }
  report.median_width = fitting::median(widths);
  return report;
}

const Rate& rate(const CampaignReport& report, const std::string& what) {
  const auto found =
      std::find_if(report.rates.begin(), report.rates.end(), [&](const Rate& r) { return r.what == what; });
  if (found == report.rates.end()) throw std::out_of_range("no rate is called '" + what + "'");
  return *found;
}

std::vector<std::string> absent(const CampaignReport& report, const std::vector<std::string>& wanted) {
  std::vector<std::string> found;
  std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(found), [&](const std::string& what) {
    return std::none_of(report.judgements.begin(), report.judgements.end(), [&](const Judgement& j) {
      return (j.counts && j.score.kind == what) || j.score.verdict == what;
    });
  });
  return found;
}

std::string markdown(const CampaignReport& report) {
  std::string text = "| | kept | of | share | 95 % interval |\n|---|---|---|---|---|\n";
  for (const Rate& r : report.rates) {
    text += r.of == 0 ? fmt::format("| {} | 0 | 0 | | |\n", r.what)
                      : fmt::format("| {} | {} | {} | {:.1f} % | {:.1f} to {:.1f} % |\n", r.what, r.kept, r.of,
                                    100.0 * r.share, 100.0 * r.low, 100.0 * r.high);
  }
  text += fmt::format("| median width of the intervals | | | {:.1f} % | |\n\n", 100.0 * report.median_width);
  std::map<std::string, std::pair<int, int>> strata;
  for (const Judgement& j : report.judgements) {
    ++strata[j.score.kind].second;
    strata[j.score.kind].first += j.counts ? 1 : 0;
  }
  text += "| stratum | plants | that count |\n|---|---|---|\n";
  for (const auto& [kind, count] : strata) text += fmt::format("| {} | {} | {} |\n", kind, count.second, count.first);
  text += fmt::format("\nA diagnosis took {:.1f} s of CPU time on average.\n\n", report.seconds);
  text += "| seed | stratum | drive | planted (noise floors) | said | right | s |\n|---|---|---|---|---|---|---|\n";
  for (const Judgement& j : report.judgements) text += row(j);
  return text;
}

nlohmann::ordered_json report_json(const CampaignReport& report) {
  using Json = nlohmann::ordered_json;
  Json rates = Json::array(), plants = Json::array();
  for (const Rate& r : report.rates) {
    rates.push_back({{"what", r.what}, {"kept", r.kept}, {"of", r.of}, {"ci95", {r.low, r.high}}});
  }
  for (const Judgement& j : report.judgements) {
    plants.push_back({{"seed", j.score.seed},
                      {"stratum", j.score.kind},
                      {"planted", j.planted},
                      {"said", j.said},
                      {"counts", j.counts},
                      {"right", j.right},
                      {"false_cause", j.false_cause}});
  }
  return {{"rates", rates}, {"median_interval_width", report.median_width}, {"plants", plants}};
}

}  // namespace pmg::literature
