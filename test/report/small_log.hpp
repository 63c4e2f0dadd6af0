// A short log of a synthetic robot, written message by message, for tests that damage logs or leave things out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "io/log_writer.hpp"
#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/fault_t.hpp"
#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/limited_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"
#include "pmg_msgs/scenario_step_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "pmg_msgs/tick_input_t.hpp"
#include "pmg_msgs/timing_t.hpp"

namespace pmg::test {

/// Two joints at 100 Hz: stand for a second, then walk at 0.5 m/s; the left joint lags its reference by 0.1 rad.
struct SmallLog {
  std::string robot = "tiny";
  std::vector<std::string> joints = {"left_joint", "right_joint"};
  int ticks = 300;
  int fault_at = -1;  ///< first tick with a fault
  std::string fault_text = "tilt: the IMU's link leans 1.20 rad from upright, limit 1.00 rad";
  bool announced = false;  ///< the fault is also at the log's beginning, as in a flight recorder's
  int falls_at = -1;
  std::int64_t first_tick = 0;       ///< number of the first tick
  std::set<std::string> left_out{};  ///< channels
  double measured_vx_m_s = 0.5;
  double beyond_vx_m_s = 0.0;  ///< asked from the second second on, beyond the 0.5 m/s that are admitted; 0: nothing is
  std::int64_t start_ns = 5'000'000'000;

  static constexpr std::int64_t kTick_ns = 10'000'000;

  void write(const std::filesystem::path& file) const {
    io::LogWriter log(file);
    const auto put = [&](const char* channel, std::int64_t stamp_ns, const auto& message) {
      if (!left_out.contains(channel)) log.write(channel, stamp_ns, message);
    };
    put("ROBOT_INFO", start_ns, info());
    if (announced) put("FAULT", start_ns, fault(start_ns + fault_at * kTick_ns));
    for (int tick = 0; tick < ticks; ++tick) {
      const std::int64_t now_ns = start_ns + tick * kTick_ns;
      if (tick % 100 == 0) put("SCENARIO", now_ns, step(tick / 100, now_ns));
      put("STATE", now_ns, state(now_ns));
      put("COMMAND", now_ns, command(tick, now_ns));
      put("TICK", now_ns, input(tick, now_ns));
      put("REFERENCE", now_ns, reference(tick, now_ns));
      put("STATUS", now_ns, status(tick, now_ns));
      if (is_limited(tick)) put("LIMITED", now_ns, limited(now_ns));
      if (tick == fault_at) put("FAULT", now_ns, fault(now_ns));
      put("TIMING", now_ns, timing(tick, now_ns));
      put("GROUND_TRUTH", now_ns, truth(tick, now_ns));
    }
    log.flush();
  }

 private:
  std::int32_t joint_count() const { return static_cast<std::int32_t>(joints.size()); }

  pmg_msgs::robot_info_t info() const {
    pmg_msgs::robot_info_t message{};
    message.robot = message.model = robot;
    message.policy = "none";
    message.bundle = "0123456789abcdef";
    message.joint_count = joint_count();
    message.joint_names = joints;
    message.lower_rad.assign(joints.size(), -1.0);
    message.upper_rad.assign(joints.size(), 1.0);
    message.stand_rad.assign(joints.size(), 0.0);
    message.standing_height_m = 0.8;
    message.control_rate_hz = 100.0;
    return message;
  }
  pmg_msgs::robot_state_t state(std::int64_t now_ns) const {
    pmg_msgs::robot_state_t message{};
    message.stamp_ns = now_ns - 3'000'000;
    message.joint_count = joint_count();
    message.q_rad.assign(joints.size(), 0.2);
    message.dq_rad_s.assign(joints.size(), 0.0);
    message.torque_Nm.assign(joints.size(), -12.5);
    message.temperature_degC.assign(joints.size(), 40.0);
    return message;
  }
  pmg_msgs::reference_t reference(int tick, std::int64_t now_ns) const {
    pmg_msgs::reference_t message{};
    message.stamp_ns = now_ns;
    message.joint_count = joint_count();
    message.q_ref_rad.assign(joints.size(), 0.2);
    message.q_ref_rad.front() = 0.3;
    message.dq_ref_rad_s.assign(joints.size(), 0.0);
    message.phase_rate_per_s = 2.0;
    message.contact[0] = tick % 50 < 30;
    message.contact[1] = tick % 50 >= 20;
    message.user[0] = message.command[0] = 0.5;
    if (beyond_vx_m_s != 0.0 && tick >= 100) {
      message.user[0] = beyond_vx_m_s;
      message.command_limited = 1;
    }
    message.optimised[0] = 0.48;
    if (tick >= 100) {
      message.gain = 0.5;
      message.slip_before_m_s[0] = message.slip_before_m_s[1] = 0.08;
      message.slip_after_m_s[0] = message.slip_after_m_s[1] = 0.02;
    }
    return message;
  }
  pmg_msgs::status_t status(int tick, std::int64_t now_ns) const {
    const bool fault = fault_at >= 0 && tick >= fault_at;
    pmg_msgs::status_t message{};
    message.stamp_ns = now_ns;
    message.robot = robot;
    message.mode = fault ? pmg_msgs::mode_t::FAULT : tick < 100 ? pmg_msgs::mode_t::STAND : pmg_msgs::mode_t::WALK;
    if (fault) message.fault = fault_text;
    message.driving_source = "tester";
    message.limited_rate = is_limited(tick) ? 1 : 0;
    return message;
  }
  static bool is_limited(int tick) { return tick >= 150 && tick < 160; }
  pmg_msgs::limited_t limited(std::int64_t now_ns) const {
    pmg_msgs::limited_t message{};
    message.stamp_ns = now_ns;
    message.count = 1;
    message.joint = {1};
    message.by = {pmg_msgs::limited_t::SPEED};
    return message;
  }
  /// No command in the first second, 0.5 m/s afterwards.
  pmg_msgs::scenario_step_t step(int index, std::int64_t now_ns) const {
    pmg_msgs::scenario_step_t message{};
    message.stamp_ns = now_ns;
    message.scenario = "small";
    message.number = index + 1;
    message.step_count = (ticks + 99) / 100;
    message.duration_s = 1.0;
    message.text = index == 0 ? "stand" : "walk forward";
    message.mode = index == 0 ? pmg_msgs::mode_t::STAND : pmg_msgs::mode_t::WALK;
    message.command[0] = index == 0 ? 0.0 : 0.5;
    return message;
  }
  pmg_msgs::command_t command(int tick, std::int64_t now_ns) const {
    pmg_msgs::command_t message{};
    message.version = pmg_msgs::command_t::VERSION;
    message.robot = robot;
    message.stamp_ns = now_ns;
    message.source = "tester";
    message.sequence = tick;
    message.lease_s = 0.5;
    message.vx_m_s = tick < 100 ? 0.0 : 0.5;
    return message;
  }
  pmg_msgs::fault_t fault(std::int64_t now_ns) const {
    pmg_msgs::fault_t message{};
    message.robot = robot;
    message.stamp_ns = now_ns;
    message.text = fault_text;
    return message;
  }
  pmg_msgs::tick_input_t input(int tick, std::int64_t now_ns) const {
    pmg_msgs::tick_input_t message{};
    message.stamp_ns = now_ns;
    message.tick = first_tick + tick;
    return message;
  }
  pmg_msgs::timing_t timing(int tick, std::int64_t now_ns) const {
    pmg_msgs::timing_t message{};
    message.stamp_ns = now_ns;
    message.wake_ns = tick == 200 ? 3'500'000 : 20'000 + 100 * tick;
    message.tick_ns = 50'000 + 100 * tick;
    message.bus_cycles = 5;
    return message;
  }
  pmg_msgs::ground_truth_t truth(int tick, std::int64_t now_ns) const {
    const bool lies = falls_at >= 0 && tick >= falls_at;
    pmg_msgs::ground_truth_t message{};
    message.stamp_ns = now_ns;
    message.p_WB_m[2] = lies ? 0.2 : 0.8;
    message.q_WB[0] = message.q_WT[0] = 1.0;
    message.v_WB_W_m_s[0] = measured_vx_m_s;
    message.foot_force_N[0] = 200.0;
    return message;
  }
};

}  // namespace pmg::test
