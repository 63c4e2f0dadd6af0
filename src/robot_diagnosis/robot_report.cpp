#include "robot_diagnosis/robot_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "evidence/thresholds.hpp"

namespace pmg::robot_diagnosis {

namespace {

using Json = nlohmann::ordered_json;

Json cause_json(const RobotCause& cause) {
  Json parameters = Json::object();
  for (const evidence::ParameterEstimate& p : cause.parameters) {
    parameters[p.name] = {
        {"value", p.estimate.value}, {"low", p.estimate.low}, {"high", p.estimate.high}, {"unit", p.unit}};
  }
  return {{"effect", cause.effect},
          {"place", cause.place},
          {"parameters", parameters},
          {"log_evidence", cause.log_evidence},
          {"folds_better", cause.folds_better},
          {"folds", cause.folds},
          {"or_instead", cause.or_instead}};
}

Json ground_json(const GroundFriction& ground) {
  Json json = {{"observable", ground.observable}};
  if (ground.observable) {
    json["value"] = ground.value;
    json["low"] = ground.low;
    json["high"] = ground.high;
  }
  json["held_at_least"] = ground.at_least;
  return json;
}

/// The recording that would resolve the ambiguity; empty if there is none.
std::string next_excitation(const RobotDiagnosis& d) {
  if (d.coverage.hanging_s == 0.0) return "record the hanging excitation: without it single joints aren't told apart";
  if (d.coverage.standing_s == 0.0)
    return "record the standing excitation: without it masses above the hips aren't seen";
  std::string next;
  for (const RobotCause& cause : d.causes) {
    if (cause.or_instead.empty()) continue;
    next +=
        fmt::format("{}record the {} excitation again: it is where {} of {} and {} differ most",
                    next.empty() ? "" : "; ", cause.told_apart_by, cause.effect, cause.place, cause.or_instead.front());
  }
  return next;
}

std::string ground_text(const GroundFriction& ground) {
  if (ground.observable)
    return fmt::format("ground friction {:.2f} ({:.2f} to {:.2f})", ground.value, ground.low, ground.high);
  return fmt::format("ground friction: not observable, no sole slipped; at least {:.2f}", ground.at_least);
}

}  // namespace

nlohmann::ordered_json robot_diagnosis_json(const RobotDiagnosis& d) {
  Json json = {{"verdict", name(d.verdict)}, {"causes", Json::array()}, {"rejected", Json::array()}};
  for (const RobotCause& cause : d.causes) json["causes"].push_back(cause_json(cause));
  for (const RobotCause& other : d.others) {
    json["rejected"].push_back({{"effect", other.effect},
                                {"place", other.place},
                                {"log_evidence", other.log_evidence},
                                {"why", "what was found explains it, or the evidence is too weak"}});
  }
  json["ground_friction"] = ground_json(d.ground);
  json["coverage_s"] = {
      {"hanging", d.coverage.hanging_s}, {"standing", d.coverage.standing_s}, {"unused", d.coverage.other_s}};
  json["noise_floor"] = 1.0;
  json["held_out_error_before"] = d.held_out_before;
  json["held_out_error_after"] = d.held_out_after;
  json["unit"] = "noise of the equations";
  json["depends_on"] = d.depends_on;
  json["not_seen"] = d.not_seen;
  json["recordings"] = d.recordings;
  json["drive_sampling"] = d.drive_sampling;
  json["options"] = evidence::thresholds_json(d.options);
  const std::string next = next_excitation(d);
  json["next_excitation"] = next.empty() ? Json(nullptr) : Json(next);
  return json;
}

work::Worth worth_of(const RobotDiagnosis& d) {
  work::Worth worth;
  worth.add_if(d.verdict == evidence::Verdict::kUnexplained, work::Grade::kMissed,
               fmt::format("no cause of the list explains {}", fmt::join(d.depends_on, ", ")));
  worth.add_if(d.verdict == evidence::Verdict::kAmbiguous, work::Grade::kOpen,
               "these logs don't tell all causes apart");
  worth.add_if(!d.causes.empty() && !(d.held_out_after < d.held_out_before), work::Grade::kNoBetter,
               "the equations are no better with the causes than without them");
  worth.add_if(!(d.held_out_after <= kMostOfNoise), work::Grade::kOffItsData,
               fmt::format("left-out equations miss by {:.3g} times their noise", d.held_out_after));
  return worth;
}

std::string robot_diagnosis_text(const RobotDiagnosis& d) {
  std::string text = worth_of(d).sentence();
  text += fmt::format("{}verdict: {}\n", text.empty() ? "" : "\n", name(d.verdict));
  for (const RobotCause& cause : d.causes) {
    text += fmt::format("  {} of {}, log evidence {:.0f}, {} of {} folds{}\n", cause.effect, cause.place,
                        cause.log_evidence, cause.folds_better, cause.folds,
                        cause.or_instead.empty() ? "" : fmt::format("; or {}", fmt::join(cause.or_instead, ", ")));
    for (const evidence::ParameterEstimate& p : cause.parameters) {
      text += fmt::format("    {} = {}\n", p.name, evidence::text_of(p.estimate, p.unit, 4));
    }
  }
  text += ground_text(d.ground) + "\n";
  text += fmt::format(
      "{:.0f} s hanging, {:.0f} s standing, {:.0f} s of no use; left-out equations {:.2f} -> {:.2f} times "
      "their noise\n",
      d.coverage.hanging_s, d.coverage.standing_s, d.coverage.other_s, d.held_out_before, d.held_out_after);
  text += d.drive_sampling + "\n";
  const std::string next = next_excitation(d);
  if (!next.empty()) text += next + "\n";
  return text;
}

pages::Page robot_diagnosis_page(const std::string& robot, const RobotDiagnosis& d) {
  pages::Page page("Diagnosis of " + robot);
  const bool clean = d.verdict == evidence::Verdict::kNone;
  std::vector<std::string> found;
  for (const RobotCause& cause : d.causes) found.push_back(fmt::format("{} of {}", cause.effect, cause.place));
  page.worth(worth_of(d));
  page.verdict({}, clean ? "Nothing beyond what robots of a kind differ by"
                         : fmt::format("{}: {}", name(d.verdict), fmt::join(found, ", ")));
  pages::Bars bars{
      .title = "log evidence of each cause", .unit = "", .names = {}, .sets = {{.name = "", .values = {}}}};
  for (const auto* causes : {&d.causes, &d.others}) {
    for (const RobotCause& cause : *causes) {
      bars.names.push_back(fmt::format("{} of {}", cause.effect, cause.place));
      bars.sets.front().values.push_back(cause.log_evidence);
    }
  }
  if (!bars.names.empty()) page.bars(bars);
  pages::Table table{.header = {"cause", "parameter", "value", "95 %", "unit"}, .rows = {}};
  for (std::size_t i = 0; i < d.causes.size(); ++i) {
    for (const evidence::ParameterEstimate& p : d.causes[i].parameters) {
      table.rows.push_back({found[i], p.name, fmt::format("{:.4g}", p.estimate.value),
                            fmt::format("{:.4g} to {:.4g}", p.estimate.low, p.estimate.high), p.unit});
    }
  }
  if (!table.rows.empty()) page.table(table);
  std::istringstream lines(robot_diagnosis_text(d));
  for (std::string line; std::getline(lines, line);) page.paragraph(line);
  page.heading("Where the logs were made");
  for (const std::string& recording : d.recordings) page.paragraph(recording);
  page.heading("What these logs would not have shown");
  page.paragraph(d.not_seen.empty() ? "Every cause of the list would have shown."
                                    : fmt::format("{}", fmt::join(d.not_seen, "; ")));
  return page;
}

}  // namespace pmg::robot_diagnosis
