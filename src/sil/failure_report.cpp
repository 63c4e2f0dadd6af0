#include "sil/failure_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace pmg::sil {

namespace {

using nlohmann::ordered_json;

std::string range_text(const faults::CycleRange& range) {
  if (range.most < 0) return "-";
  return range.least == range.most ? fmt::format("{}", range.most) : fmt::format("{} to {}", range.least, range.most);
}

ordered_json cycles_json(std::int64_t cycles) { return cycles < 0 ? ordered_json(nullptr) : ordered_json(cycles); }

std::string cycles_text(const ordered_json& cycles) { return cycles.is_null() ? "-" : cycles.dump(); }

}  // namespace

ordered_json failures_json(std::span<const Failure> failures, std::span<const FailureReaction> reactions,
                           std::span<const faults::Fault> faults) {
  ordered_json json = ordered_json::array();
  for (std::size_t i = 0; i < failures.size(); ++i) {
    const Failure& failure = failures[i];
    const auto fault = std::ranges::find_if(
        faults, [&](const faults::Fault& found) { return static_cast<double>(found.stamp_ns) * 1e-9 >= failure.at_s; });
    ordered_json entry = {{"kind", to_string(failure.kind)}, {"at_s", failure.at_s}, {"for_s", failure.for_s}};
    entry["fault"] = fault == faults.end() ? ordered_json(nullptr) : ordered_json(to_string(fault->code));
    entry["cycles_to_sit_down"] = cycles_json(reactions[i].cycles_to_sit_down);
    entry["cycles_to_damping"] = cycles_json(reactions[i].cycles_to_damping);
    if (fault != faults.end()) {
      const faults::Reaction promised = faults::reaction(fault->code);
      entry["promised_cycles_to_sit_down"] = range_text(promised.sit_down);
      entry["promised_cycles_to_damping"] = range_text(promised.damping);
    }
    json.push_back(std::move(entry));
  }
  return json;
}

std::string failures_text(const ordered_json& failures) {
  std::string text;
  for (const ordered_json& entry : failures) {
    text += fmt::format("{} at {:g} s: ", entry["kind"].get<std::string>(), entry["at_s"].get<double>());
    if (entry["fault"].is_null()) {
      text += "no fault\n";
      continue;
    }
    text +=
        fmt::format("{}; bus cycles to the sit-down {} (promised {}), to damping {} (promised {})\n",
                    entry["fault"].get<std::string>(), cycles_text(entry["cycles_to_sit_down"]),
                    entry["promised_cycles_to_sit_down"].get<std::string>(), cycles_text(entry["cycles_to_damping"]),
                    entry["promised_cycles_to_damping"].get<std::string>());
  }
  return text;
}

}  // namespace pmg::sil
