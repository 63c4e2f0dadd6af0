#include "runtime/controller_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace pmg::runtime {

namespace {

constexpr std::size_t kDelayedShown = 10;
constexpr std::int64_t kTold_ns = 5'000'000'000;
constexpr double kWorthSaying = 0.05;  // a share of the time; less is not seen in a walk

nlohmann::ordered_json histogram_json(const TimeHistogram& times) {
  return {{"p50", times.percentile_us(0.50)}, {"p99", times.percentile_us(0.99)}};
}

nlohmann::ordered_json thread_json(const CycleStatistics& statistics, const char* duration_name) {
  nlohmann::ordered_json delayed = nlohmann::ordered_json::array();
  for (const DelayedCycle& cycle : statistics.delayed()) {
    delayed.push_back({{"t_s", static_cast<double>(cycle.planned_ns - statistics.first_ns()) * 1e-9},
                       {"late_ms", static_cast<double>(cycle.late_ns) * 1e-6}});
  }
  return {{"cycles", statistics.cycles()},
          {"missed", statistics.missed()},
          {"overruns", statistics.overruns()},
          {"wake_us", histogram_json(statistics.wake())},
          {duration_name, histogram_json(statistics.duration())},
          {"delayed_count", statistics.delayed_count()},
          {"delayed", delayed}};
}

std::string thread_line(const char* name, const CycleStatistics& statistics, const char* duration_name) {
  return fmt::format(
      "{}: {} cycles, wake-up p50 {:.0f} us, p99 {:.0f} us, {} p50 {:.0f} us, p99 {:.0f} us; {} missed, {} overran, {} "
      "delayed by the host over 2 ms",
      name, statistics.cycles(), statistics.wake().percentile_us(0.50), statistics.wake().percentile_us(0.99),
      duration_name, statistics.duration().percentile_us(0.50), statistics.duration().percentile_us(0.99),
      statistics.missed(), statistics.overruns(), statistics.delayed_count());
}

void add_delayed_line(const char* name, const CycleStatistics& statistics, std::vector<std::string>& lines) {
  if (statistics.delayed().empty()) return;
  std::string text = fmt::format("{}, delayed by the host:", name);
  for (std::size_t i = 0; i < std::min(kDelayedShown, statistics.delayed().size()); ++i) {
    const DelayedCycle& cycle = statistics.delayed()[i];
    text += fmt::format(" {:.1f} ms at {:.3f} s,", static_cast<double>(cycle.late_ns) * 1e-6,
                        static_cast<double>(cycle.planned_ns - statistics.first_ns()) * 1e-9);
  }
  text.back() = statistics.delayed_count() > static_cast<std::int64_t>(kDelayedShown) ? ';' : '.';
  if (text.back() == ';') text += fmt::format(" {} in all", statistics.delayed_count());
  lines.push_back(text);
}

double seconds(std::int64_t time_ns) { return static_cast<double>(time_ns) * 1e-9; }

std::string lateness_text(std::int64_t passed_ns, std::int64_t lost_ns) {
  return fmt::format(
      "this computer is late: of {:.1f} s the simulation waited {:.1f} s for it. A robot's physics don't wait: free "
      "the "
      "computer before you judge by this run how fast it is",
      seconds(passed_ns), seconds(lost_ns));
}

}  // namespace

std::string LatenessNews::since(const std::optional<Turns>& turns) {
  if (!turns || turns->passed_ns() < passed_ns_ + kTold_ns) return "";
  const std::int64_t passed_ns = turns->passed_ns(), lost_ns = turns->lost_ns();
  const std::int64_t of_ns = passed_ns - std::exchange(passed_ns_, passed_ns);
  const std::int64_t waited_ns = lost_ns - std::exchange(lost_ns_, lost_ns);
  return seconds(waited_ns) > kWorthSaying * seconds(of_ns) ? lateness_text(of_ns, waited_ns) : "";
}

nlohmann::ordered_json punctuality_json(const Controller& controller) {
  const control::DroppedItems dropped = controller.outbox().dropped();
  nlohmann::ordered_json json = {{"realtime", controller.refused().empty()}, {"refused", controller.refused()}};
  if (const auto& turns = controller.turns()) json["simulation_waited_s"] = seconds(turns->lost_ns());
  json.update({{"control", thread_json(controller.control_statistics(), "tick_us")},
               {"bus", thread_json(controller.bus_statistics(), "exchange_us")},
               {"dropped_records", dropped.records},
               {"dropped_bus_cycles", dropped.bus_cycles},
               {"dropped_acks", dropped.acks}});
  return json;
}

std::vector<std::string> punctuality_lines(const Controller& controller) {
  std::vector<std::string> lines = {thread_line("control", controller.control_statistics(), "tick"),
                                    thread_line("bus", controller.bus_statistics(), "exchange")};
  if (const auto& turns = controller.turns();
      turns && seconds(turns->lost_ns()) > kWorthSaying * seconds(turns->passed_ns())) {
    lines.push_back(lateness_text(turns->passed_ns(), turns->lost_ns()));
  }
  add_delayed_line("control", controller.control_statistics(), lines);
  add_delayed_line("bus", controller.bus_statistics(), lines);
  const control::DroppedItems dropped = controller.outbox().dropped();
  if (dropped.records > 0) {
    lines.push_back(fmt::format("{} ticks are not in the log: the recorder did not keep up", dropped.records));
  }
  if (dropped.acks > 0) {
    lines.push_back(fmt::format("{} operators' requests were not answered: the network did not keep up", dropped.acks));
  }
  return lines;
}

}  // namespace pmg::runtime
