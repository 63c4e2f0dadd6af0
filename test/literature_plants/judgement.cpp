#include "judgement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace pmg::literature {

namespace {

using nlohmann::json;

/// A string, or a list of strings.
std::set<std::string> strings(const json& value) {
  if (value.is_string()) return {value.get<std::string>()};
  std::set<std::string> all;
  for (const json& one : value) {
    if (one.is_string()) all.insert(one.get<std::string>());
  }
  return all;
}

const json& list(const json& object, const char* key) {
  static const json kEmpty = json::array();
  return object.contains(key) ? object.at(key) : kEmpty;
}

/// For the score, what would explain the same files, and what describes a part of a form, may be found and needn't be:
/// an effect of no size.
json truth_of_effects(const json& truth) {
  json of_effects = truth;
  const auto allow = [&](const json& names) {
    for (const json& name : names) {
      of_effects["effects"].push_back({{"effect", name}, {"moves_floors", 0.0}, {"parameters", json::object()}});
    }
  };
  for (const json& fault : list(truth, "faults")) allow(list(fault, "same_here"));
  for (const json& effect : list(truth, "effects")) allow(list(effect, "besides"));
  return of_effects;
}

/// data_faults[].kind of a planted fault's kind.
std::string kind_in_diagnosis(const std::string& planted) {
  if (planted == "units_of_feed_forward" || planted == "degrees") return "unit";
  if (planted == "flipped_sign") return "sign";
  if (planted == "wrong_mass") return "mass";
  return planted;
}

/// True if the diagnosis names the runs that have the fault, or all where several have it.
bool placed(const json& planted, const json& said) {
  const json& runs = list(said, "runs");
  if (runs == "all") return planted.at("runs").size() > 1;
  std::set<std::string> files;
  for (const json& file : runs) files.insert(std::filesystem::path(file.get<std::string>()).filename().string());
  return files == strings(planted.at("runs"));
}

/// Late readings in every run are a delay: that name is right, too.
bool named_as_effect(const json& truth, const json& diagnosis) {
  if (diagnosis.at("verdict") != "found") return false;
  for (const json& planted : list(truth, "faults")) {
    const std::set<std::string> same = strings(list(planted, "same_here"));
    for (const json& cause : diagnosis.at("causes")) {
      if (same.contains(cause.at("effect").get<std::string>())) return true;
    }
  }
  return false;
}

}  // namespace

FaultJudgement judge_faults(const json& truth, const json& diagnosis) {
  FaultJudgement judgement;
  for (const json& said : list(diagnosis, "data_faults")) {
    bool meant = false;
    for (const json& planted : list(truth, "faults")) {
      if (kind_in_diagnosis(planted.at("kind")) != said.at("kind").get<std::string>()) continue;
      meant = judgement.named = true;
      judgement.placed = judgement.placed || placed(planted, said);
    }
    judgement.false_fault = judgement.false_fault || !meant;
  }
  return judgement;
}

Judgement judge(const json& result) {
  const json &truth = result.at("truth"), &diagnosis = result.at("diagnosis");
  Judgement j;
  json of_effects = result;
  of_effects["truth"] = truth_of_effects(truth);
  j.score = literature::score(of_effects);
  j.planted = planted_text(truth);
  j.said = said_text(diagnosis);
  j.law = truth.at("law").get<std::string>();
  j.floors = std::numeric_limits<double>::infinity();
  for (const char* key : {"effects", "faults"}) {
    for (const json& one : truth.at(key)) j.floors = std::min(j.floors, one.at("moves_floors").get<double>());
  }
  j.counts = j.floors >= kStrong_floors;
  const FaultJudgement faults = judge_faults(truth, diagnosis);
  const bool as_effect = named_as_effect(truth, diagnosis);
  j.fault_named = faults.named || as_effect, j.fault_placed = faults.placed || as_effect;
  j.false_fault = faults.false_fault;
  // Off the catalogue no cause is right.
  const bool strange = j.score.kind == "strange";
  j.false_cause =
      (j.score.verdict == "found" && (strange ? !diagnosis.at("causes").empty() : j.score.accused)) || j.false_fault;
  j.right = j.score.kind == "clean"   ? !j.score.accused && !j.false_fault
            : strange                 ? j.score.verdict == "unexplained" && !j.false_fault
            : j.score.kind == "fault" ? j.fault_named && !j.false_cause
                                      : j.score.named && !j.false_fault;
  if (diagnosis.contains("residual_extension") && diagnosis.at("residual_extension").is_object()) {
    const json& extension = diagnosis.at("residual_extension");
    j.extension_better =
        extension.at("held_out_error_after").get<double>() < extension.at("held_out_error_before").get<double>();
  }
  return j;
}

std::string planted_text(const json& truth) {
  std::string text;
  for (const json& effect : truth.at("effects")) {
    text += fmt::format("{}{}, {} ({:.1f})", text.empty() ? "" : "; ", effect.at("effect").get<std::string>(),
                        effect.at("form").get<std::string>(), effect.at("moves_floors").get<double>());
  }
  for (const json& fault : truth.at("faults")) {
    const std::size_t runs = fault.at("runs").size();
    text += fmt::format(
        "{} {} x {:.3g} in {} run{} ({:.1f})", fault.at("kind").get<std::string>(),
        fault.at("column").get<std::string>(),
        fault.at("shift_samples") != 0 ? fault.at("shift_samples").get<double>() : fault.at("factor").get<double>(),
        runs, runs == 1 ? "" : "s", fault.at("moves_floors").get<double>());
  }
  return text;
}

std::string said_text(const json& diagnosis) {
  std::string text = diagnosis.at("verdict").get<std::string>(), between = ": ";
  for (const json& cause : diagnosis.at("causes")) {
    text += between + cause.at("effect").get<std::string>();
    for (const auto& [key, word] : {std::pair{"same_here", " = "}, std::pair{"or_instead", " or "}}) {
      for (const json& other : list(cause, key)) text += word + other.get<std::string>();
    }
    between = ", ";
  }
  for (const json& fault : list(diagnosis, "data_faults")) {
    text += between + "data fault " + fault.at("kind").get<std::string>();
    between = ", ";
  }
  return text;
}

}  // namespace pmg::literature
