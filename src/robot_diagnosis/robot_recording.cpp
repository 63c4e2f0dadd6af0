#include "robot_diagnosis/robot_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "io/log_series.hpp"
#include "io/log_writer.hpp"
#include "model/constants.hpp"
#include "pmg_msgs/motor_command_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "recording/run_info.hpp"
#include "recording/tick_messages.hpp"
#include "sil/lockstep.hpp"

namespace pmg::robot_diagnosis {

namespace {

constexpr double kShortest_s = 1.0;
constexpr const char* kState = "STATE";
constexpr const char* kCommand = "MOTOR_COMMAND";

bool finite(const model::RobotState& state) {
  return state.q.allFinite() && state.dq.allFinite() && state.gyro_rad_s.allFinite() &&
         state.acceleration_m_s2.allFinite() && state.orientation_WI.coeffs().allFinite();
}

bool finite(const model::JointCommand& command) {
  return command.q.allFinite() && command.dq.allFinite() && command.kp.allFinite() && command.kd.allFinite() &&
         command.tau_ff.allFinite();
}

bool take(const std::vector<double>& from, int joints, JointVector& to) {
  if (std::ssize(from) != joints) return false;
  to = Eigen::Map<const Eigen::VectorXd>(from.data(), joints);
  return true;
}

bool joint_command(const pmg_msgs::motor_command_t& message, int joints, model::JointCommand& command) {
  command.bus_sample = static_cast<std::uint64_t>(message.bus_sample);
  return take(message.q_rad, joints, command.q) && take(message.dq_rad_s, joints, command.dq) &&
         take(message.kp_Nm_per_rad, joints, command.kp) && take(message.kd_Nm_s_per_rad, joints, command.kd) &&
         take(message.torque_ff_Nm, joints, command.tau_ff);
}

class LogTicks {
 public:
  LogTicks(const std::filesystem::path& log, const model::RobotModel& robot)
      : robot_(robot), name_(log.filename().string()), series_(io::log_files({log})) {
    if (name_.empty()) name_ = log.parent_path().filename().string();
  }

  std::vector<RobotRecording> read() {
    while (series_.next()) {
      const io::LogReader& event = series_.event();
      if (event.channel() == "ROBOT_INFO") check_robot(event);
      if (event.channel() == kState) take_state(event);
      if (event.channel() == kCommand) take_command(event);
    }
    finish();
    if (!any_tick_) fail("no STATE and MOTOR_COMMAND messages; expected the log of a controller");
    if (recordings_.empty()) fail(fmt::format("no {} s without a gap", kShortest_s));
    return std::move(recordings_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(fmt::format("{}: {}", series_.file().string(), what));
  }

  void check_robot(const io::LogReader& event) {
    const auto info = event.decode<pmg_msgs::robot_info_t>();
    if (!info) return;
    try {
      drive_ = drive_sampling(info->backend, info->options, robot_.joint_index);
    } catch (const std::runtime_error& error) {
      fail(error.what());
    }
    source_ = recording_source(info->backend, info->options);
    if (info->joint_names == robot_.joint_index.names()) return;
    fail(fmt::format("of the robot {} with {} joints; expected the joints of {}", info->model, info->joint_count,
                     robot_.name));
  }

  void take_state(const io::LogReader& event) {
    state_.reset();
    const auto message = event.decode<pmg_msgs::robot_state_t>();
    model::RobotState state;
    if (!message) return;
    if (!recording::robot_state(*message, robot_.joint_index.size(), state))
      fail(fmt::format("a STATE with {} joints; expected the {} of {}", message->joint_count, robot_.joint_index.size(),
                       robot_.name));
    if (!finite(state))
      fail(fmt::format("a STATE that isn't finite at {} s; leave that stretch out",
                       static_cast<double>(state.stamp_ns) * 1e-9));
    state_ = state;
  }

  void take_command(const io::LogReader& event) {
    const auto message = event.decode<pmg_msgs::motor_command_t>();
    if (!message || !state_) return;
    RobotTick tick{.t_s = static_cast<double>(state_->stamp_ns) * 1e-9, .state = *state_, .command = {}};
    state_.reset();
    if (!joint_command(*message, robot_.joint_index.size(), tick.command))
      fail(fmt::format("a MOTOR_COMMAND with {} joints; expected {}", message->joint_count, robot_.joint_index.size()));
    if (!finite(tick.command)) fail(fmt::format("a MOTOR_COMMAND that isn't finite at {} s", tick.t_s));
    any_tick_ = true;
    const bool follows = !current_.ticks.empty() && std::abs(tick.t_s - current_.ticks.back().t_s -
                                                             model::kControlPeriod_s) < 0.3 * model::kControlPeriod_s;
    if (!follows) finish();
    current_.ticks.push_back(std::move(tick));
  }

  void finish() {
    if (static_cast<double>(current_.ticks.size()) * model::kControlPeriod_s > kShortest_s) {
      current_.name = name_;
      current_.period_s = model::kControlPeriod_s;
      current_.drive = drive_;
      current_.source = source_;
      recordings_.push_back(std::move(current_));
    }
    current_ = {};
  }

  const model::RobotModel& robot_;
  std::string name_;
  io::LogSeries series_;
  std::optional<model::RobotState> state_;
  DriveSampling drive_ = drive_sampling("unknown", "", {});
  RecordingSource source_;
  RobotRecording current_;
  std::vector<RobotRecording> recordings_;
  bool any_tick_ = false;
};

}  // namespace

RecordingSource recording_source(const std::string& backend, const std::string& options) {
  const nlohmann::json json = nlohmann::json::parse(options, nullptr, false);
  RecordingSource source{.backend = backend, .simulated = backend == "sil"};
  if (!json.is_object() || !json.contains("set_on_simulator") || !json["set_on_simulator"].is_array()) return source;
  source.simulated = true;
  std::vector<std::string>& set = source.set_on_simulator.emplace();
  for (const nlohmann::json& line : json["set_on_simulator"]) {
    if (line.is_string()) set.push_back(line.get<std::string>());
  }
  return source;
}

std::string source_text(const RecordingSource& source) {
  if (source.backend.empty() && !source.simulated) return "unknown: the log doesn't say which backend made it";
  if (!source.simulated)
    return fmt::format("hardware (backend {}): nothing was set, what is found is the robot's own", source.backend);
  if (!source.set_on_simulator) return "a simulation; the log doesn't say what was set on it";
  if (source.set_on_simulator->empty()) return "a simulation on which nothing was set: the robot as its files say";
  return fmt::format("a simulation on which was set: {}", fmt::join(*source.set_on_simulator, "; "));
}

std::vector<RobotRecording> read_robot_logs(const std::vector<std::filesystem::path>& logs,
                                            const model::RobotModel& robot) {
  std::vector<RobotRecording> all;
  for (const auto& log : logs) {
    for (RobotRecording& recording : LogTicks(log, robot).read()) all.push_back(std::move(recording));
  }
  return all;
}

namespace {

std::vector<std::string> names(const std::vector<int>& joints, const model::RobotModel& robot) {
  std::vector<std::string> names;
  for (const int joint : joints) names.push_back(robot.joint_index.name(joint));
  return names;
}

void write_ticks(const RobotRecording& recording, const model::RobotModel& robot, const std::filesystem::path& file) {
  io::LogWriter writer(file);
  recording::RunInfo run;
  run.robot = robot.name;
  nlohmann::json options = {{"drive_sampling_s", recording.drive.step_s},
                            {"command_delay_s", recording.drive.command_delay_s}};
  options["older_joints"] = names(recording.drive.older_joints, robot);
  options["older_imu"] = recording.drive.older_imu;
  options["older_by_s"] = recording.drive.older_by_s;
  options["closed_by_bus"] = names(recording.drive.closed_by_bus, robot);
  options["bus_loop_age_s"] = recording.drive.bus_loop_age_s;
  if (recording.source.set_on_simulator) options["set_on_simulator"] = *recording.source.set_on_simulator;
  run.backend = recording.source.backend;
  run.options = options.dump();
  pmg_msgs::robot_info_t info;
  recording::fill(run, robot, 1.0 / recording.period_s, 0, info);
  writer.write("ROBOT_INFO", 0, info);
  const int joints = robot.joint_index.size();
  control::TickRecord record{};
  pmg_msgs::robot_state_t state;
  pmg_msgs::motor_command_t command;
  state.robot = command.robot = robot.name;
  for (const RobotTick& tick : recording.ticks) {
    record.now_ns = tick.state.stamp_ns;
    record.state = tick.state;
    record.result.command = tick.command;
    recording::fill(record, joints, state);
    recording::fill(record, joints, command);
    writer.write(kState, record.now_ns, state);
    writer.write(kCommand, record.now_ns, command);
  }
  writer.flush();
}

}  // namespace

void write_robot_log(const RobotRecording& recording, const model::RobotModel& robot,
                     const std::filesystem::path& file) {
  std::filesystem::path beside = file;
  beside += ".part";
  try {
    write_ticks(recording, robot, beside);
    std::filesystem::rename(beside, file);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw;
  }
}

RobotRecording play(sim::World& world, std::span<const model::JointCommand> commands, const std::string& name,
                    const work::Progress& progress) {
  constexpr std::size_t kTicksPerReport = 100;
  RobotRecording recording{.name = name,
                           .source = {.backend = "sil", .simulated = true, .set_on_simulator = world.set_values()},
                           .period_s = model::kControlPeriod_s,
                           .drive = {.step_s = model::kBusPeriod_s,
                                     .known_from = "the simulation that was recorded",
                                     .command_delay_s = 0.0,
                                     .delay_known_from = "the same"}};
  recording.ticks.reserve(commands.size());
  for (const model::JointCommand& command : commands) {
    RobotTick tick;
    world.read(tick.state);
    tick.t_s = world.time_s();
    tick.command = command;
    tick.command.bus_sample = tick.state.bus_sample;
    recording.ticks.push_back(tick);
    sil::hold_for_one_tick(world, tick.command);
    if (world.diverged()) throw std::runtime_error(fmt::format("{}: the simulation diverged at {} s", name, tick.t_s));
    const std::size_t done = recording.ticks.size();
    if (done % kTicksPerReport == 0)
      progress.report_or_throw(static_cast<double>(done) / static_cast<double>(commands.size()), name + " excitation");
  }
  return recording;
}

}  // namespace pmg::robot_diagnosis
