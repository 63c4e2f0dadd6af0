#include "report/run_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>

#include "control/mode.hpp"
#include "io/log_series.hpp"
#include "io/plain_text.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/scenario_step_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/timing_t.hpp"
#include "report/joint_errors.hpp"
#include "report/measured_command.hpp"
#include "report/run_judgement.hpp"
#include "report/series_samples.hpp"
#include "report/thinning.hpp"
#include "report/timing_csv.hpp"

namespace pmg::report {

namespace fs = std::filesystem;

namespace {

/// The names of folder and file: many logs are called log.lcm.
std::string short_name(const fs::path& log) {
  const fs::path path = fs::weakly_canonical(log);
  return fs::is_directory(path) ? path.filename().string() : (path.parent_path().filename() / path.filename()).string();
}

template <typename... Groups>
auto pointers(Groups&... groups) {
  std::vector<std::common_type_t<decltype(groups.data())...>> all;
  (std::ranges::transform(groups, std::back_inserter(all), [](auto& line) { return &line; }), ...);
  return all;
}

/// Gathers the events of one run. If the log holds several runs, the last one remains.
class Gathering {
 public:
  explicit Gathering(std::string name) { run_.name = std::move(name); }

  void add(const io::LogReader& event) {
    const std::string& channel = event.channel();
    if (channel == "ROBOT_INFO") return take_info(event);
    if (!first_ns_) first_ns_ = beginning(event.stamp_ns());
    t_s_ = static_cast<double>(event.stamp_ns() - *first_ns_) * 1e-9;
    double& channel_t_s = newest_s_.try_emplace(channel, t_s_).first->second;
    if (t_s_ < channel_t_s) {
      ++back_in_time_;
      return;
    }
    channel_t_s = t_s_;
    run_.duration_s = std::max(run_.duration_s, t_s_);
    newest_ns_ = std::max(newest_ns_, event.stamp_ns());
    if (channel == "STATE") return with(event, &Gathering::state);
    if (channel == "REFERENCE") return with(event, &Gathering::reference);
    if (channel == "STATUS") return with(event, &Gathering::status);
    if (channel == "COMMAND") return with(event, &Gathering::command);
    if (channel == "SCENARIO") return with(event, &Gathering::step);
    if (channel == "LIMITED") return with(event, &Gathering::limited);
    if (channel == "GROUND_TRUTH") return with(event, &Gathering::truth);
    if (channel == "TIMING") return with(event, &Gathering::timing);
    if (channel == "TICK") return with(event, &Gathering::tick);
    if (channel == "FAULT") return with(event, &Gathering::fault);
  }

  /// The complete run. Call once, at the end.
  RunSeries finish() {
    for (auto* stretches : {&run_.modes, &run_.sources, &run_.hoisted, &run_.hanging}) {
      std::erase_if(*stretches, [](const auto& stretch) { return stretch.text.empty(); });
    }
    // If the log begins in a fault, or its FAULT is lost, each status still holds the fault's text.
    for (const RunSeries::Event& fault : latched_) {
      if (!is_known(fault)) run_.faults.push_back(fault);
    }
    std::ranges::sort(run_.faults, {}, &RunSeries::Event::t_s);
    end_step();
    run_.joint_tracking = joint_errors_.finish(run_.joint_names.size());
    for (const Thinning* thinned : {&thin_state_, &thin_reference_, &thin_status_, &thin_truth_})
      run_.longest_gap_s = std::max(run_.longest_gap_s, 1.5 * thinned->widest_pair_s());
    run_.limited = limited_.most_first();
    std::erase_if(run_.limited, [this](const LimitedJoint& one) { return one.joint >= run_.joint_names.size(); });
    if (judgement_) {
      const sil::RunOutcome outcome = judgement_->outcome();
      run_.tracking = outcome.tracking;
      run_.reference_slip = outcome.reference_slip;
      run_.cut = outcome.cut;
    }
    if (!run_.identified) run_.problems.push_back("no ROBOT_INFO: who ran what is unknown, joints have numbers");
    const auto tell = [this](std::int64_t count, const char* what) {
      if (count > 0) run_.problems.push_back(fmt::format("{} {}", count, what));
    };
    tell(unreadable_, "messages of another type or another robot were skipped");
    tell(back_in_time_, "messages run back in time and were skipped");
    tell(run_.lost_ticks, "ticks are missing in the log");
    tell(earlier_runs_, "earlier runs in the same log are not shown: the last one is");
    return std::move(run_);
  }

 private:
  /// Time zero: ROBOT_INFO's stamp if it is at most a second before the first tick, so that a simulation's times stay
  /// unchanged; else the first event's.
  std::int64_t beginning(std::int64_t first_event_ns) const {
    constexpr std::int64_t kSoon_ns = 1'000'000'000;
    const std::int64_t ahead_ns = info_ns_ ? first_event_ns - *info_ns_ : -1;
    return ahead_ns >= 0 && ahead_ns < kSoon_ns ? *info_ns_ : first_event_ns;
  }

  template <typename Message>
  void with(const io::LogReader& event, bool (Gathering::*take)(const Message&)) {
    static thread_local Message message;  // the memory of its vectors is reused
    if (!event.decode_into(message) || !(this->*take)(message)) ++unreadable_;
  }

  /// A rotated file repeats its run's ROBOT_INFO. Another run has another session, or in lockstep, where there is none,
  /// a clock that starts again.
  void take_info(const io::LogReader& event) {
    auto info = event.decode<pmg_msgs::robot_info_t>();
    if (!info) {
      ++unreadable_;
      return;
    }
    const bool another =
        run_.identified && (info->session != run_.info.session || io::plain_text(info->robot) != run_.info.robot);
    if (first_ns_ && (another || event.stamp_ns() < newest_ns_)) begin_anew();
    if (run_.identified) return;
    if (!first_ns_) info_ns_ = event.stamp_ns();
    if (!run_.joint_names.empty() && info->joint_count != static_cast<int>(run_.joint_names.size())) {
      ++unreadable_;
      return;
    }
    run_.identified = true;
    run_.info = plain(std::move(*info));
    run_.joint_names = run_.info.joint_names;
    judgement_.emplace(run_.info.standing_height_m);
    make_joints();
  }

  void begin_anew() {
    Gathering next(run_.name);
    next.earlier_runs_ = earlier_runs_ + 1;
    *this = std::move(next);
  }

  /// Whether a message has as many joints as the run. Without ROBOT_INFO the first message decides.
  bool fits(std::int32_t joint_count) {
    if (run_.joint_names.empty()) {
      for (std::int32_t i = 0; i < joint_count; ++i) run_.joint_names.push_back(fmt::format("joint {}", i));
      make_joints();
    }
    return joint_count == static_cast<std::int32_t>(run_.joint_names.size());
  }
  void make_joints() {
    for (auto* joints :
         {&run_.state.q_rad, &run_.state.torque_Nm, &run_.state.temperature_degC, &run_.reference.q_ref_rad})
      joints->resize(run_.joint_names.size());
  }

  bool state(const pmg_msgs::robot_state_t& message) {
    if (!fits(message.joint_count)) return false;
    append(message, t_s_, run_);
    run_.timing.state_age_us.add(1e-3 * static_cast<double>(newest_ns_ - message.stamp_ns));
    thin_state_.appended({.t_s = &run_.state.t_s,
                          .wide = {},
                          .narrow = pointers(run_.state.q_rad, run_.state.torque_Nm, run_.state.temperature_degC)},
                         kLongestGap_s);
    joint_errors_.state(t_s_, message.q_rad, message.torque_Nm);
    return true;
  }

  bool command(const pmg_msgs::command_t& message) {
    if (judgement_) judgement_->command(message);
    return true;
  }

  bool step(const pmg_msgs::scenario_step_t& message) {
    end_step();
    run_.scenario = io::plain_text(message.scenario);
    const std::string text = io::plain_text(message.text);
    RunSeries::Step step{
        .from_s = t_s_, .to_s = t_s_, .number = message.number, .text = text, .asked = {}, .tracking = {}};
    std::ranges::copy(message.command, step.asked.begin());
    run_.steps.push_back(std::move(step));
    if (judgement_) before_step_ = judgement_->outcome().tracking;
    return true;
  }

  void end_step() {
    if (run_.steps.empty()) return;
    run_.steps.back().to_s = t_s_;
    if (judgement_) run_.steps.back().tracking = errors_between(before_step_, judgement_->outcome().tracking);
  }

  bool limited(const pmg_msgs::limited_t& message) {
    limited_.add(t_s_, message);
    return true;
  }

  bool reference(const pmg_msgs::reference_t& message) {
    if (!fits(message.joint_count)) return false;
    if (judgement_) judgement_->reference(message);
    append(message, t_s_, run_);
    auto& to = run_.reference;
    thin_reference_.appended(
        {.t_s = &to.t_s,
         .wide = pointers(to.user, to.command, to.optimised, to.slip_before_m_s, to.slip_after_m_s),
         .narrow = pointers(to.q_ref_rad)},
        kLongestGap_s);
    joint_errors_.reference(t_s_, message.q_ref_rad);
    if (message.phase_rate_per_s > 0.0) gait_period_s_ = 1.0 / message.phase_rate_per_s;
    return true;
  }

  bool status(const pmg_msgs::status_t& message) {
    if (message.mode < 0 || message.mode > pmg_msgs::mode_t::FAULT) return false;
    const auto mode = static_cast<control::Mode>(message.mode);
    const bool was_fault = !run_.modes.empty() && run_.modes.back().text == to_string(control::Mode::kFault);
    if (mode == control::Mode::kFault && !was_fault) {
      latched_.push_back({t_s_, message.fault.empty() ? fmt::format("fault code {}", message.fault_code)
                                                      : io::plain_text(message.fault)});
    }
    if (judgement_) judgement_->status(message);
    append(message, t_s_, run_);
    auto& to = run_.status;
    thin_status_.appended(
        {.t_s = &to.t_s, .wide = {&to.limited_position, &to.limited_rate, &to.limited_torque}, .narrow = {}},
        kLongestGap_s);
    joint_errors_.status(mode == control::Mode::kStand || mode == control::Mode::kWalk);
    return true;
  }

  bool truth(const pmg_msgs::ground_truth_t& message) {
    if (judgement_) judgement_->truth(message);
    const double standing_height_m = run_.info.standing_height_m;
    append(message, measured_command_.add(message, gait_period_s_, standing_height_m), t_s_, run_);
    auto& to = run_.truth;
    thin_truth_.appended({.t_s = &to.t_s, .wide = pointers(to.measured, to.foot_slip_m_s), .narrow = {}},
                         kLongestGap_s);
    if (!run_.fell && fallen(message, standing_height_m)) {
      run_.fell = true;
      run_.fell_at_s = t_s_;
    }
    return true;
  }

  bool timing(const pmg_msgs::timing_t& message) {
    append(message, t_s_, run_);
    return true;
  }

  bool tick(const pmg_msgs::tick_input_t& message) {
    if (last_tick_ && message.tick > *last_tick_ + 1) run_.lost_ticks += message.tick - *last_tick_ - 1;
    last_tick_ = message.tick;
    append(message, t_s_, run_);
    return true;
  }

  /// The message's stamp is the time of the latching. A flight recorder's log holds its fault twice: at the beginning
  /// and in its place.
  bool fault(const pmg_msgs::fault_t& message) {
    const double latched_s = static_cast<double>(message.stamp_ns - *first_ns_) * 1e-9;
    const RunSeries::Event told{latched_s >= 0.0 ? latched_s : t_s_, io::plain_text(message.text)};
    if (!is_known(told)) run_.faults.push_back(told);
    return true;
  }

  bool is_known(const RunSeries::Event& fault) const {
    constexpr double kSame_s = 0.05;  // a fault latches in one tick and is logged in the next
    return std::ranges::any_of(
        run_.faults, [&](const RunSeries::Event& known) { return std::abs(known.t_s - fault.t_s) < kSame_s; });
  }

  RunSeries run_;
  Thinning thin_state_, thin_reference_, thin_status_, thin_truth_;
  JointErrors joint_errors_;
  MeasuredCommand measured_command_;
  std::optional<RunJudgement> judgement_;  // once the robot is known
  sil::TrackingSummary before_step_;
  LimitedJoints limited_;
  std::optional<std::int64_t> info_ns_, first_ns_, last_tick_;
  double t_s_ = 0.0, gait_period_s_ = 1.0;
  std::map<std::string, double> newest_s_;  // newest time of each channel
  std::vector<RunSeries::Event> latched_;
  std::int64_t newest_ns_ = 0;
  std::int64_t unreadable_ = 0, back_in_time_ = 0, earlier_runs_ = 0;
};

}  // namespace

RunSeries read_run(const fs::path& log, const work::Progress& progress) {
  const std::vector<fs::path> files = io::log_files({log});
  double total_bytes = 0.0, read_bytes = 0.0;
  for (const fs::path& file : files) total_bytes += static_cast<double>(fs::file_size(file));

  constexpr std::size_t kEventHeader_bytes = 28;
  constexpr int kEventsPerCall = 2000;
  Gathering gathering(short_name(log));
  io::LogSeries series(files);
  bool interrupted = false;
  for (int events = 1; !interrupted && series.next(); ++events) {
    const io::LogReader& event = series.event();
    gathering.add(event);
    read_bytes += static_cast<double>(kEventHeader_bytes + event.channel().size() + event.data().size());
    if (events % kEventsPerCall == 0) interrupted = !progress(std::min(1.0, read_bytes / total_bytes));
  }
  RunSeries run = gathering.finish();
  if (series.cut_short()) {
    run.problems.push_back("a log file ends in the middle of an event: its end is missing");
  } else if (series.skipped_bytes() > 0) {
    run.problems.push_back(fmt::format("{} damaged bytes were skipped", series.skipped_bytes()));
  }
  run.interrupted = interrupted;
  if (run.state.t_s.empty() && run.status.t_s.empty() && run.reference.t_s.empty() && !interrupted) {
    const std::filesystem::path meant = log.parent_path() / "log.lcm";
    throw std::runtime_error(log.string() + ": no log of a run: it has no STATE, REFERENCE or STATUS that can be read" +
                             (log.filename() != meant.filename() && std::filesystem::exists(meant)
                                  ? "; did you mean " + meant.string() + "?"
                                  : "; expected a log of pmg_controller or pmg_sil"));
  }
  if (run.timing.ticks == 0) {
    read_timing_csv((fs::is_directory(log) ? log : log.parent_path()) / "timing.csv", run);
  }
  return run;
}

}  // namespace pmg::report
