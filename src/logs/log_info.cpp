#include "logs/log_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "io/log_series.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "pmg_msgs/timing_t.hpp"

namespace pmg::logs {

namespace {

constexpr std::array<std::pair<const char*, std::int64_t pmg_msgs::timing_t::*>, 7> kTimings = {{
    {"wake", &pmg_msgs::timing_t::wake_ns},
    {"tick", &pmg_msgs::timing_t::tick_ns},
    {"generator", &pmg_msgs::timing_t::generator_ns},
    {"gco", &pmg_msgs::timing_t::gco_ns},
    {"policy", &pmg_msgs::timing_t::policy_ns},
    {"bus wake", &pmg_msgs::timing_t::bus_wake_max_ns},
    {"bus exchange", &pmg_msgs::timing_t::bus_exchange_max_ns},
}};

std::string mode_name(std::int8_t mode) {
  return mode >= 0 && mode <= static_cast<std::int8_t>(control::Mode::kFault)
             ? control::to_string(static_cast<control::Mode>(mode))
             : fmt::format("mode {}", mode);
}

/// Nearest rank.
TimingSpread spread(const char* name, std::vector<std::int64_t>& values_ns) {
  std::ranges::sort(values_ns);
  const auto rank = [&](double share) {
    const auto position = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values_ns.size())));
    return static_cast<double>(values_ns[std::max<std::size_t>(position, 1) - 1]) * 1e-3;
  };
  return {.name = name, .p50_us = rank(0.5), .p99_us = rank(0.99), .p999_us = rank(0.999), .max_us = rank(1.0)};
}

/// (a series of events) => its runs, one after the other.
class Summariser {
 public:
  void take(const io::LogReader& event, const std::filesystem::path& file) {
    if (event.channel() == "ROBOT_INFO") take_info(event);
    if (!run_) begin_run(event.stamp_ns());
    if (run_->files.empty() || run_->files.back() != file) run_->files.push_back(file);
    ++run_->messages[event.channel()];
    last_ns_ = event.stamp_ns();
    if (event.channel() == "TICK") take_tick(event);
    if (event.channel() == "STATUS") take_status(event);
    if (event.channel() == "FAULT") take_fault(event);
    if (event.channel() == "TIMING") take_timing(event);
  }

  std::vector<RunSummary> end() {
    end_run();
    return std::move(runs_);
  }

 private:
  void begin_run(std::int64_t stamp_ns) {
    run_.emplace();
    first_ns_ = stamp_ns;
    next_tick_.reset();
    driver_.clear();
    told_faults_.clear();
    latched_before_ = 0;
    timings_ns_ = {};
  }

  void end_run() {
    if (!run_) return;
    run_->duration_s = seconds(last_ns_);
    for (std::size_t i = 0; i < kTimings.size(); ++i) {
      if (!timings_ns_[i].empty()) run_->timing.push_back(spread(kTimings[i].first, timings_ns_[i]));
    }
    runs_.push_back(*std::exchange(run_, std::nullopt));
  }

  double seconds(std::int64_t stamp_ns) const { return static_cast<double>(stamp_ns - first_ns_) * 1e-9; }

  /// A rotated file repeats its run's ROBOT_INFO. Another run has another session.
  void take_info(const io::LogReader& event) {
    auto info = event.decode<pmg_msgs::robot_info_t>();
    if (!info) return;
    const bool another =
        run_ && run_->info && (info->session != run_->info->session || info->robot != run_->info->robot);
    // Lockstep runs have no session; their clocks begin anew.
    if (another || (run_ && event.stamp_ns() < last_ns_)) end_run();
    if (!run_) begin_run(event.stamp_ns());
    run_->info = std::move(info);
  }

  void take_tick(const io::LogReader& event) {
    const auto tick = event.decode<pmg_msgs::tick_input_t>();
    if (!tick) return;
    ++run_->ticks;
    if (!next_tick_) run_->from_the_start = tick->tick == 0;
    if (next_tick_ && tick->tick > *next_tick_) run_->lost_ticks += tick->tick - *next_tick_;
    next_tick_ = tick->tick + 1;
  }

  void take_status(const io::LogReader& event) {
    const auto status = event.decode<pmg_msgs::status_t>();
    if (!status) return;
    if (!driver_.empty()) run_->driven_s[driver_] += static_cast<double>(event.stamp_ns() - status_ns_) * 1e-9;
    driver_ = status->driving_source;
    status_ns_ = event.stamp_ns();
    std::string mode = mode_name(status->mode) + (status->hanging ? ", hanging" : "");
    if (run_->modes.empty() && status->fault_code != 0) begin_in_fault(*status, event.stamp_ns());
    if (!run_->modes.empty() && run_->modes.back().text == mode) return;
    run_->modes.push_back({seconds(event.stamp_ns()), std::move(mode)});
  }

  /// The FAULT message of a fault that was latched before the log's first tick is in an earlier file.
  void begin_in_fault(const pmg_msgs::status_t& status, std::int64_t stamp_ns) {
    if (!told_faults_.empty()) return;
    latched_before_ = status.fault_code;
    run_->faults.push_back({seconds(stamp_ns), "latched before this log: " + status.fault});
  }

  void take_fault(const io::LogReader& event) {
    const auto fault = event.decode<pmg_msgs::fault_t>();
    if (!fault || !told_faults_.emplace(fault->code, fault->stamp_ns).second) return;
    // Latched in the log's first tick: its message follows that tick's STATUS.
    if (std::exchange(latched_before_, 0) == fault->code && run_->ticks <= 1) run_->faults.pop_back();
    // The message's own stamp: a flight recorder's file begins with its fault.
    run_->faults.push_back({seconds(fault->stamp_ns), fault->text});
  }

  void take_timing(const io::LogReader& event) {
    const auto timing = event.decode<pmg_msgs::timing_t>();
    if (!timing) return;
    run_->missed_ticks = timing->missed_ticks;
    run_->missed_bus_cycles = timing->bus_missed_cycles;
    for (std::size_t i = 0; i < kTimings.size(); ++i) {
      const std::int64_t value_ns = (*timing).*kTimings[i].second;
      if (value_ns != 0) timings_ns_[i].push_back(value_ns);  // 0: the stage didn't run
    }
  }

  std::vector<RunSummary> runs_;
  std::optional<RunSummary> run_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::optional<std::int64_t> next_tick_;
  std::string driver_;  // at status_ns_; empty: none
  std::int64_t status_ns_ = 0;
  std::set<std::pair<std::int32_t, std::int64_t>> told_faults_;
  std::int32_t latched_before_ = 0;  // fault code of the log's first STATUS, until a FAULT names it
  std::array<std::vector<std::int64_t>, kTimings.size()> timings_ns_;
};

}  // namespace

LogSummary summarise_logs(const std::vector<std::filesystem::path>& files) {
  io::LogSeries events(files);
  Summariser summariser;
  while (events.next()) summariser.take(events.event(), events.file());
  LogSummary summary{
      .runs = summariser.end(), .skipped_bytes = events.skipped_bytes(), .cut_short = events.cut_short()};
  if (summary.runs.empty()) throw std::runtime_error(files.front().string() + ": no LCM event in it; expected a log");
  return summary;
}

}  // namespace pmg::logs
