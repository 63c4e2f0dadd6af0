#include "doctor/examination.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>

namespace pmg::doctor {

namespace {

constexpr std::array<const char*, 3> kVerdicts = {"ok", "warn", "fail"};

const char* text_of(Verdict verdict) { return kVerdicts[static_cast<std::size_t>(verdict)]; }

}  // namespace

Findings examine_for_controller(const Host& host, const ControllerNeeds& needs, const Limits& limits) {
  Findings all;
  const auto add = [&all](Findings found) { std::ranges::move(found, std::back_inserter(all)); };
  const ClockReading began = host.clock();
  if (needs.realtime) {
    add(check_kernel(host));
    add(check_realtime_rights(host, needs.priority));
    add(check_cpus(host, needs.cpus));
  }
  for (const std::string& card : needs.cards) add(check_card(host, card, needs.cpus, limits));
  for (const can::BusSetup& bus : needs.can_buses) add(check_can_bus(host, bus, limits));
  if (needs.imu) add(check_serial_imu(host, *needs.imu));
  if (!needs.log.empty()) add(check_disk(host, needs.log, limits));
  add(check_clock(host, began, host.clock(), limits));
  return all;
}

std::vector<std::string> to_lines(const Finding& finding) {
  std::vector<std::string> lines = {fmt::format("{:5} {}: {}", text_of(finding.verdict), finding.check, finding.found)};
  if (!finding.remedy.empty()) lines.push_back("      -> " + finding.remedy);
  return lines;
}

nlohmann::ordered_json to_json(const Findings& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    nlohmann::ordered_json entry = {
        {"check", finding.check}, {"verdict", text_of(finding.verdict)}, {"found", finding.found}};
    if (!finding.remedy.empty()) entry["remedy"] = finding.remedy;
    list.push_back(std::move(entry));
  }
  return list;
}

std::string refusal(const Findings& findings) {
  const auto failed = [](const Finding& finding) { return finding.verdict == Verdict::kFail; };
  const auto first = std::ranges::find_if(findings, failed);
  if (first == findings.end()) return {};
  const auto others = std::ranges::count_if(findings, failed) - 1;
  return fmt::format("{}: {}; {}{}", first->check, first->found, first->remedy,
                     others > 0 ? fmt::format(" ({} more: pmg_doctor)", others) : "");
}

}  // namespace pmg::doctor
