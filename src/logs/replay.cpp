#include "logs/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>

#include "control/control_setup.hpp"
#include "files/config_error.hpp"
#include "io/log_series.hpp"
#include "logs/replay_setup.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "recording/tick_messages.hpp"
#include "runtime/robot_excitation_session.hpp"
#include "topics/message_fields.hpp"

namespace pmg::logs {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double kNotANumber = std::numeric_limits<double>::infinity();
constexpr int kTicksAProgress = 100;

/// Equal bits: -0 differs from 0, and a NaN equals the same NaN.
bool same(const topics::Field::Value& a, const topics::Field::Value& b) {
  if (std::holds_alternative<double>(a) && std::holds_alternative<double>(b)) {
    return std::bit_cast<std::uint64_t>(std::get<double>(a)) == std::bit_cast<std::uint64_t>(std::get<double>(b));
  }
  return a == b;
}

double distance(const topics::Field::Value& a, const topics::Field::Value& b) {
  const auto number = [](const topics::Field::Value& value) {
    if (const auto* real = std::get_if<double>(&value)) return *real;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1.0 : 0.0;
    return std::numeric_limits<double>::quiet_NaN();
  };
  const double gap = std::abs(number(a) - number(b));
  return std::isfinite(gap) ? gap : kNotANumber;
}

class Replay {
 public:
  Replay(const ReplayOptions& options, const work::Progress& progress) : options_(options), progress_(progress) {}

  void take(const io::LogReader& event) {
    if (!first_ns_) first_ns_ = event.stamp_ns();
    const std::string& channel = event.channel();
    if (channel == "ROBOT_INFO") {
      take_info(event);
    } else if (channel == "STATE") {
      take_state(event);
    } else if (channel == "COMMAND") {
      take_message(event, commands_);
    } else if (channel == "MODE") {
      take_message(event, requests_);
    } else if (channel == "ARMS") {
      take_message(event, arms_);
    } else if (channel == "ARMS_INPUT") {
      arms_input_ = decoded<pmg_msgs::arms_input_t>(event);
    } else if (channel == "TICK") {
      take_tick(event);
    } else if (channel == "REFERENCE") {
      compare(event, reference_);
    } else if (channel == "MOTOR_COMMAND") {
      compare(event, motor_command_);
    } else if (channel == "STATUS") {
      compare_status(event);
    } else if (channel == "ARMS_STATE") {
      compare(event, arms_state_);
    }
  }

  ReplayReport end() {
    if (report_.ticks == 0) throw std::runtime_error("no tick to replay in it; expected a log of a run");
    return std::move(report_);
  }

 private:
  template <typename Message>
  Message decoded(const io::LogReader& event) const {
    auto message = event.decode<Message>();
    if (!message) {
      throw std::runtime_error(fmt::format("{} at {:.2f} s is no message that this program knows (another version?)",
                                           event.channel(), seconds(event)));
    }
    return std::move(*message);
  }
  double seconds(const io::LogReader& event) const {
    return static_cast<double>(event.stamp_ns() - first_ns_.value_or(0)) * 1e-9;
  }

  void take_info(const io::LogReader& event) {
    const auto info = decoded<pmg_msgs::robot_info_t>(event);
    if (tick_) {  // a later file of a rotated log
      if (info.session == run_.session && info.robot == run_.robot && event.stamp_ns() >= last_ns_) return;
      throw std::runtime_error("these logs are of more than one run; name the files of one");
    }
    const ordered_json logged = ordered_json::parse(info.options, nullptr, false);
    const control::ControlSetup setup = replay_setup(info, logged, options_);
    loaded_ = control::load_control(setup);
    if (loaded_.robot.joint_index.names() != info.joint_names) {
      throw std::runtime_error(
          fmt::format("the log's robot {} has other joints than {}", info.model, loaded_.robot.directory.string()));
    }
    note_files(info, loaded_, report_.notes);
    if (info.software != recording::software_version()) {
      report_.notes.push_back(
          fmt::format("this is software {}; the log is of {}", recording::software_version(), info.software));
    }
    note_options(logged, control::control_json(loaded_), report_.notes);
    control::restore_options(logged, loaded_.options);
    if (logged.contains("bench")) take_excitation(logged["bench"]);
    if (logged.contains("excite")) {
      loaded_.options.robot_excitation =
          runtime::robot_excitation_plan(option_text(logged["excite"], "name", ""), loaded_.robot, loaded_.library,
                                         loaded_.options.guard, logged.value("own_gains", std::vector<std::string>{}));
    }
    run_.robot = reference_.robot = motor_command_.robot = info.robot;
    run_.session = info.session;
    joint_count_ = loaded_.robot.joint_index.size();
    tick_ = control::make_tick(loaded_, stopwatch_);
  }

  void take_excitation(const ordered_json& bench) {
    const std::string joint = option_text(bench, "joint", ""), folder = option_text(bench, "excitation", "");
    if (!options_.excitation) {
      throw std::runtime_error(fmt::format(
          "this run played the excitation in {} on {}; this replay has no reader for excitations", folder, joint));
    }
    PlayedExcitation played = options_.excitation(loaded_.robot, joint, folder);
    if (played.sha256 != option_text(bench, "sha256", "")) {
      report_.notes.push_back(fmt::format("the excitation of {} is not the one that the log was made with", joint));
    }
    loaded_.options.excitation = std::move(played.plan);
  }

  void take_state(const io::LogReader& event) {
    require_tick();
    const auto state = decoded<pmg_msgs::robot_state_t>(event);
    if (!recording::robot_state(state, joint_count_, record_.state))
      throw std::runtime_error("STATE has another number of joints than the robot");
    commands_.clear();
    requests_.clear();
    arms_.clear();
    arms_input_ = {};
    has_state_ = true;
  }

  template <typename Message>
  void take_message(const io::LogReader& event, std::vector<Message>& messages) {
    messages.push_back(decoded<Message>(event));
  }

  void take_tick(const io::LogReader& event) {
    require_tick();
    const auto input = decoded<pmg_msgs::tick_input_t>(event);
    last_ns_ = event.stamp_ns();
    check_whole(input);
    record_.tick = input.tick;
    record_.now_ns = input.stamp_ns;
    record_.bus = static_cast<hal::BusStatus>(input.bus);
    record_.guard_trip = static_cast<hal::TripCause>(input.guard_trip);
    record_.stop = input.stop != 0;
    record_.late_ns = input.late_ns;
    record_.policy_late = input.policy_late != 0;
    record_.drive_count = commands_.size();
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      record_.drives[i] = recording::drive_message(commands_[i], input.command_received_ns[i]);
    }
    record_.request_count = requests_.size();
    for (std::size_t i = 0; i < requests_.size(); ++i) {
      record_.requests[i] = recording::mode_request(requests_[i], input.request_received_ns[i]);
      record_.requests[i].heard_ns = input.request_heard_ns[i];
    }
    record_.arms_count = arms_.size();
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      record_.arms[i] = recording::arms_message(arms_[i], arms_input_.received_ns[i]);
    }
    record_.result = tick_->step(record_.input());
    has_state_ = false;
    ++report_.ticks;
    report_.duration_s = seconds(event);
    if (progress_.report && report_.ticks % kTicksAProgress == 0)
      progress_.report(work::kUnknownShare, fmt::format("{:8.1f} s replayed", report_.duration_s));
  }

  void require_tick() const {
    if (!tick_)
      throw std::runtime_error("the log doesn't begin with ROBOT_INFO, which names the robot, its files and options");
  }

  /// Checks that all inputs of this tick are there and that every tick before it was replayed.
  void check_whole(const pmg_msgs::tick_input_t& input) const {
    const std::int64_t expected = report_.ticks;
    if (input.tick != expected && expected == 0) {
      throw std::runtime_error(
          fmt::format("the log begins with tick {}: the ticks before, which set the controller's state, are missing "
                      "(rotated away, or "
                      "this is a flight recorder's log). Only a log from the controller's start can be replayed",
                      input.tick));
    }
    if (input.tick != expected) {
      throw std::runtime_error(
          fmt::format("ticks {} to {} are missing in the log: it can't be replayed beyond {:.2f} s", expected,
                      input.tick - 1, report_.duration_s));
    }
    const bool whole = has_state_ && commands_.size() == input.command_received_ns.size() &&
                       requests_.size() == input.request_received_ns.size() &&
                       arms_.size() == arms_input_.received_ns.size() && commands_.size() <= control::kMaxDrives &&
                       requests_.size() <= control::kMaxRequests && arms_.size() <= control::kMaxArms;
    if (!whole) throw std::runtime_error(fmt::format("the messages before tick {} are not all in the log", input.tick));
  }

  void compare_status(const io::LogReader& event) {
    // Only the threads around the tick know this value, so the log's is taken.
    run_.realtime = decoded<pmg_msgs::status_t>(event).realtime != 0;
    compare(event, status_);
  }

  void fill_message(pmg_msgs::reference_t& message) { recording::fill(record_, joint_count_, message); }
  void fill_message(pmg_msgs::motor_command_t& message) { recording::fill(record_, joint_count_, message); }
  void fill_message(pmg_msgs::arms_state_t& message) { recording::fill(record_, run_, message); }
  void fill_message(pmg_msgs::status_t& message) { recording::fill(record_, run_, loaded_.robot, message); }

  template <typename Message>
  void compare(const io::LogReader& event, Message& replayed) {
    require_tick();
    if (report_.ticks == 0) return;
    fill_message(replayed);
    ++report_.compared_messages;
    bytes_.resize(static_cast<std::size_t>(replayed.getEncodedSize()));
    replayed.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
    if (bytes_ == event.data()) return;
    ++report_.different_messages;
    note_differences(event);
  }

  /// Compares field by field a message whose bytes differ from bytes_.
  void note_differences(const io::LogReader& event) {
    if (!read_fields(event.channel(), event.data(), loaded_.robot.joint_index.names(), logged_fields_))
      throw std::runtime_error(event.channel() + " is no message that this program knows (another version?)");
    read_fields(event.channel(), bytes_, loaded_.robot.joint_index.names(), replayed_fields_);
    if (logged_fields_.size() != replayed_fields_.size())
      throw std::runtime_error(event.channel() + " has vectors of another length than this robot");
    for (std::size_t i = 0; i < logged_fields_.size(); ++i) {
      const topics::Field& logged = logged_fields_[i];
      const topics::Field& replayed = replayed_fields_[i];
      if (same(logged.value, replayed.value)) continue;
      double& largest = report_.largest[event.channel() + " " + logged.name];
      largest = std::max(largest, distance(logged.value, replayed.value));
      if (report_.first) continue;
      report_.first = Difference{.time_s = seconds(event),
                                 .tick = record_.tick,
                                 .channel = event.channel(),
                                 .field = logged.path(),
                                 .logged = topics::to_text(logged.value),
                                 .replayed = topics::to_text(replayed.value)};
    }
  }

  const ReplayOptions& options_;
  const work::Progress& progress_;
  const io::SimulationClock stopwatch_;  // a replay measures no times
  control::LoadedControl loaded_;
  recording::RunInfo run_;
  std::unique_ptr<control::Tick> tick_;
  int joint_count_ = 0;
  std::optional<std::int64_t> first_ns_;
  std::int64_t last_ns_ = 0;
  bool has_state_ = false;
  std::vector<pmg_msgs::command_t> commands_;
  std::vector<pmg_msgs::mode_t> requests_;
  std::vector<pmg_msgs::arms_t> arms_;
  pmg_msgs::arms_input_t arms_input_{};
  control::TickRecord record_;
  pmg_msgs::reference_t reference_;
  pmg_msgs::motor_command_t motor_command_;
  pmg_msgs::status_t status_;
  pmg_msgs::arms_state_t arms_state_{};
  std::vector<std::uint8_t> bytes_;
  std::vector<topics::Field> logged_fields_, replayed_fields_;
  ReplayReport report_;
};

/// Says of which log an error speaks. Errors of configuration name their own file.
template <typename Action>
auto of_file(const fs::path& file, Action&& action) {
  try {
    return action();
  } catch (const files::ConfigError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace

double ReplayReport::largest_difference() const {
  double all = 0.0;
  for (const auto& [field, value] : largest) all = std::max(all, value);
  return all;
}

ReplayReport replay(const std::vector<fs::path>& files, const ReplayOptions& options, const work::Progress& progress) {
  io::LogSeries events(files);
  auto run = std::make_unique<Replay>(options, progress);  // records are large
  while (events.next()) of_file(events.file(), [&] { run->take(events.event()); });
  ReplayReport report = of_file(events.file(), [&] { return run->end(); });
  report.cut_short = events.cut_short();
  return report;
}

}  // namespace pmg::logs
