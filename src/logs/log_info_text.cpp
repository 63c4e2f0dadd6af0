// The summary of a log for people and for programs.
#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/plain_text.hpp"
#include "logs/log_info.hpp"

namespace pmg::logs {

namespace {

std::string utc(std::int64_t utc_ns) {
  const std::time_t time = static_cast<std::time_t>(utc_ns / 1'000'000'000);
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[40];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text;
}

nlohmann::ordered_json at_json(const std::vector<RunSummary::At>& events) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const RunSummary::At& event : events) json.push_back({{"t_s", event.time_s}, {"text", event.text}});
  return json;
}

nlohmann::ordered_json info_json(const pmg_msgs::robot_info_t& info) {
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < info.bundle_file.size(); ++i) files[info.bundle_file[i]] = info.bundle_sha256[i];
  const auto options = nlohmann::ordered_json::parse(info.options, nullptr, false);
  return {
      {"robot", info.robot},     {"model", info.model},
      {"session", info.session}, {"software", info.software},
      {"policy", info.policy},   {"backend", info.backend},
      {"bundle", info.bundle},   {"bundle_files", files},
      {"refused", info.refused}, {"options", options.is_discarded() ? nlohmann::ordered_json(info.options) : options}};
}

nlohmann::ordered_json run_json(const RunSummary& run) {
  nlohmann::ordered_json json;
  if (run.info) json = info_json(*run.info);
  json["files"] = nlohmann::ordered_json::array();
  for (const auto& file : run.files) json["files"].push_back(file.string());
  json["duration_s"] = run.duration_s;
  json["from_the_start"] = run.from_the_start;
  json["ticks"] = run.ticks;
  json["lost_ticks"] = run.lost_ticks;
  json["missed_ticks"] = run.missed_ticks;
  json["missed_bus_cycles"] = run.missed_bus_cycles;
  json["messages"] = run.messages;
  json["modes"] = at_json(run.modes);
  json["faults"] = at_json(run.faults);
  json["driven_s"] = run.driven_s;
  json["timing_us"] = nlohmann::ordered_json::object();
  for (const TimingSpread& timing : run.timing) {
    json["timing_us"][timing.name] = {
        {"p50", timing.p50_us}, {"p99", timing.p99_us}, {"p99.9", timing.p999_us}, {"max", timing.max_us}};
  }
  return json;
}

/// A line of the summary. Names, texts and channels in it were chosen by other programs.
template <typename... Values>
std::string line(fmt::format_string<Values...> format, Values&&... values) {
  return io::plain_text(fmt::format(format, std::forward<Values>(values)...)) + "\n";
}

/// Controller, robot and files. hashes_text() gives the hashes.
std::string info_text(const pmg_msgs::robot_info_t& info) {
  std::string text =
      line("robot      {} (model {}), backend {}, policy {}", info.robot, info.model, info.backend, info.policy);
  text += line("software   {}", info.software);
  if (info.session != 0) text += line("started    {}", utc(info.session));
  for (const std::string& refused : info.refused) text += line("refused    {}", refused);
  return text;
}

std::string hashes_text(const pmg_msgs::robot_info_t& info) {
  std::string text = info.options.empty() ? "" : line("options    {}", info.options);
  text += line("bundle     {}", info.bundle.empty() ? "not stamped" : info.bundle);
  for (std::size_t i = 0; i < info.bundle_file.size(); ++i) {
    text += line("           {}  {}", info.bundle_sha256[i], info.bundle_file[i]);
  }
  return text;
}

std::string drivers_text(const RunSummary& run) {
  std::string text;
  for (const auto& [source, driven_s] : run.driven_s) {
    text += line("{:<10} {:9.2f} s  {}", text.empty() ? "driven by" : "", driven_s, source);
  }
  return text.empty() ? "driven by  nobody\n" : text;
}

std::string timeline(const char* title, const std::vector<RunSummary::At>& events) {
  std::string text;
  for (const RunSummary::At& event : events) {
    text += line("{:<10} {:9.2f} s  {}", text.empty() ? title : "", event.time_s, event.text);
  }
  return text.empty() ? line("{:<10} none", title) : text;
}

std::string run_text(const RunSummary& run) {
  std::string text = line("duration   {:.2f} s, {} ticks{}", run.duration_s, run.ticks,
                          run.from_the_start ? ", from the controller's first" : ", not from the controller's start");
  text += timeline("faults", run.faults);
  text += drivers_text(run);
  text += timeline("modes", run.modes);
  text += line("lost       {} ticks not in the log, {} ticks and {} bus cycles skipped by the controller",
               run.lost_ticks, run.missed_ticks, run.missed_bus_cycles);
  text += run.info ? info_text(*run.info) : "robot      not told: no ROBOT_INFO in this log\n";
  for (const auto& file : run.files) {
    text += line("{:<10} {}", &file == &run.files.front() ? "files" : "", file.string());
  }
  std::string messages;
  for (const auto& [channel, count] : run.messages) {
    messages += line("{:<10} {:>9}  {}", messages.empty() ? "messages" : "", count, channel);
  }
  text += messages;
  if (!run.timing.empty()) {
    text += line("timing     {:<14} {:>9} {:>9} {:>9} {:>9}  us", "", "p50", "p99", "p99.9", "max");
    for (const TimingSpread& timing : run.timing) {
      text += line("           {:<14} {:9.1f} {:9.1f} {:9.1f} {:9.1f}", timing.name, timing.p50_us, timing.p99_us,
                   timing.p999_us, timing.max_us);
    }
  }
  if (run.info) text += hashes_text(*run.info);
  return text;
}

}  // namespace

nlohmann::ordered_json to_json(const LogSummary& summary) {
  nlohmann::ordered_json json;
  json["runs"] = nlohmann::ordered_json::array();
  for (const RunSummary& run : summary.runs) json["runs"].push_back(run_json(run));
  json["cut_short"] = summary.cut_short;
  json["skipped_bytes"] = summary.skipped_bytes;
  return json;
}

std::string to_text(const LogSummary& summary) {
  std::string text;
  for (const RunSummary& run : summary.runs) {
    if (!text.empty()) text += "\n";
    text += run_text(run);
  }
  if (summary.cut_short) text += "cut short  the last event is incomplete (the program was killed, or still writes)\n";
  if (summary.skipped_bytes > 0) text += fmt::format("skipped    {} bytes that are no event\n", summary.skipped_bytes);
  return text;
}

}  // namespace pmg::logs
