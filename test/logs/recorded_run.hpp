// A short run with every input of a tick, recorded as by pmg_sil and pmg_controller: noisy states, two operators,
// broken and repeated messages, a stop, a fault and its reset.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "control/control_rig.hpp"
#include "control/control_setup.hpp"
#include "io/log_writer.hpp"
#include "recording/run_info.hpp"
#include "recording/tick_log.hpp"

namespace pmg::test {

/// Relative to the source root, where tests run: the committed log contains no folder of its computer.
inline constexpr const char* kRecordedRobot = "test/data/robots/biped";
inline constexpr double kRecorded_s = 2.6;
inline constexpr double kRecordedFault_s = 1.6;  // time at which a drive gets hot
inline constexpr std::int64_t kRecordedSession = 1;

inline recording::RunInfo recorded_run_info() {
  control::ControlSetup setup;
  setup.robot = kRecordedRobot;
  const control::LoadedControl loaded = control::load_control(setup);
  recording::RunInfo run;
  run.robot = "biped-7";
  run.session = kRecordedSession;
  run.options = control::control_json(loaded).dump();
  run.bundle = loaded.bundle;
  run.files = loaded.files;
  return run;
}

/// after_tick gets the elapsed seconds and may redirect the log into another file.
inline void record_run(io::LogWriter& writer, const std::function<void(recording::TickLog&, double)>& after_tick = {}) {
  const model::RobotModel robot = model::load_robot(kRecordedRobot);
  ControlRig rig(robot, false);
  recording::TickLog log(writer, robot, recorded_run_info(), 100.0);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 4e-4);
  bool hot = false;
  rig.bus.spoil = [&](model::RobotState& state) {
    for (Eigen::Index i = 0; i < state.q.size(); ++i) state.q[i] += noise(random);
    for (Eigen::Index i = 0; i < state.dq.size(); ++i) state.dq[i] += 10.0 * noise(random);
    if (hot) state.temperature_degC[2] = 95.0;
  };
  const control::Source stranger = control::Source::make("stranger", 3);
  const auto at = [](int tick, double time_s) { return tick == std::lround(time_s * 100.0); };

  rig.drive.command[kVx] = 0.3;
  for (int tick = 0; tick < static_cast<int>(kRecorded_s * 100.0); ++tick) {
    if (at(tick, 0.05)) rig.ask(control::Mode::kWalk);
    if (at(tick, 0.90)) rig.drive.command[kVy] = std::numeric_limits<double>::quiet_NaN();
    if (at(tick, 0.93)) rig.drive.command = {.u = {0.2, -0.05, 0.3, 0.05, 0.02, -0.02}};
    if (at(tick, 1.10)) rig.ask(stranger, control::Mode::kWalk, false);
    if (at(tick, 1.20)) rig.silent = true;
    if (at(tick, 1.30)) rig.silent = false;
    if (at(tick, 1.40)) rig.drive.sequence -= 20;  // repeats old ones
    hot = tick >= 160 && tick < 170;
    if (at(tick, 1.80)) rig.reset();
    if (at(tick, 1.90)) rig.ask(control::Mode::kStand);
    if (at(tick, 2.50)) rig.ask(stranger, control::Mode::kDamping, false);
    for (int cycle = 0; cycle < 5; ++cycle) rig.cycle();
    log.write(rig.control_cycle.record());
    if (after_tick) after_tick(log, 0.01 * (tick + 1));
  }
}

inline void record_run(const std::filesystem::path& file) {
  io::LogWriter writer(file);
  record_run(writer);
  writer.flush();
}

}  // namespace pmg::test
