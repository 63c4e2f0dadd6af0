// Every drive of a robot and its IMU, behind links.
#pragma once

#include <poll.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "can/cia402_emulator.hpp"
#include "can/link.hpp"
#include "can/mit_emulator.hpp"
#include "can/xsens_imu.hpp"
#include "drive_protocols/mit_drive.hpp"
#include "model/robot_io.hpp"

namespace pmg::test {

class EmulatedDrives {
 public:
  /// One link a bus, in the order of setup.buses. Keeps a reference to setup.
  EmulatedDrives(const can::DriveSetup& setup, std::vector<std::unique_ptr<can::Link>> links)
      : setup_(setup), links_(std::move(links)) {
    for (const can::BusSetup& bus : setup.buses) {
      auto& drives = buses_.emplace_back();
      for (const drives::MotorSetup& motor : bus.motors) {
        if (drives::as_mit(motor.drive) != nullptr) {
          drives.push_back(std::make_unique<MitEmulator>(motor));
        } else {
          drives.push_back(std::make_unique<Cia402Emulator>(motor));
        }
      }
    }
  }

  /// Answers what has arrived; the IMU speaks once.
  void serve() noexcept {
    answer();
    speak();
  }
  void answer() noexcept {
    for (; !held_.empty() && held_.front().due <= ticks_; held_.pop_front())
      links_[held_.front().bus]->send(std::span(&held_.front().frame, 1));
    for (std::size_t b = 0; b < buses_.size(); ++b) {
      std::array<drives::Message, 32> frames;
      while (const std::size_t count = links_[b]->receive(frames)) {
        for (const drives::Message& frame : std::span(frames).first(count)) {
          for (const auto& drive : buses_[b]) {
            Replies replies;
            const auto answers = static_cast<std::size_t>(drive->hear(frame, replies));
            reply(b, std::span(replies).first(answers));
          }
        }
      }
    }
  }
  void speak() noexcept {
    for (std::size_t b = 0; b < buses_.size(); ++b) {
      if (!setup_.buses[b].imu || imu_silent) continue;
      model::RobotState shown = sensed_;
      shown.orientation_WI = imu_lean * shown.orientation_WI;
      links_[b]->send(can::imu_frames(shown));
    }
  }

  /// 2 ms pass: watchdogs; the drives' commands, joint by joint.
  void tick(model::JointCommand& command) noexcept {
    ++ticks_;
    for (auto& bus : buses_) {
      for (const auto& drive : bus) {
        drive->tick();
        const drives::MotorCommand joint = drive->setup().transmission.to_joint(drive->command());
        const int index = drive->setup().index;
        command.q[index] = joint.q_rad;
        command.dq[index] = joint.dq_rad_s;
        command.kp[index] = joint.kp_Nm_per_rad;
        command.kd[index] = joint.kd_Nm_s_per_rad;
        command.tau_ff[index] = joint.torque_Nm;
      }
    }
    for (std::size_t b = 0; b < buses_.size(); ++b) {
      for (const auto& linked : setup_.buses[b].four_bars) pull_rods(b, linked, command);
      for (const auto& linked : setup_.buses[b].parallel) pull_rods(b, linked, command);
    }
  }

  void feel(const model::RobotState& state) noexcept {
    sensed_ = state;
    for (auto& bus : buses_) {
      for (const auto& drive : bus) {
        const int index = drive->setup().index;
        drive->feel(drive->setup().transmission.to_motor(
            drives::MotorReading{.q_rad = state.q[index], .dq_rad_s = state.dq[index], .torque_Nm = state.tau[index]}));
      }
    }
    for (std::size_t b = 0; b < buses_.size(); ++b) {
      for (const auto& linked : setup_.buses[b].four_bars) feel_rods(b, linked);
      for (const auto& linked : setup_.buses[b].parallel) feel_rods(b, linked);
    }
  }

  long heard() const noexcept {
    long sum = 0;
    for (const auto& bus : buses_) {
      for (const auto& drive : bus) sum += drive->heard;
    }
    return sum;
  }
  long obeyed() const noexcept {
    long sum = 0;
    for (const auto& bus : buses_) {
      for (const auto& drive : bus) sum += drive->obeyed;
    }
    return sum;
  }
  /// Waits until something arrives. False: these links have no kernel behind them, where everything is there at once.
  bool wait_ms(int most) noexcept {
    std::array<pollfd, 16> polled{};
    const std::size_t count = std::min(links_.size(), polled.size());
    for (std::size_t b = 0; b < count; ++b) polled[b] = {.fd = links_[b]->descriptor(), .events = POLLIN, .revents = 0};
    if (polled[0].fd < 0) return false;
    poll(polled.data(), count, most);
    return true;
  }

  DriveEmulator& drive(std::size_t bus, std::size_t motor) { return *buses_[bus][motor]; }
  Cia402Emulator& cia402(std::size_t bus, std::size_t motor) {
    return dynamic_cast<Cia402Emulator&>(drive(bus, motor));
  }
  can::Link& link(std::size_t bus) { return *links_[bus]; }
  std::size_t buses() const { return buses_.size(); }
  std::size_t motors(std::size_t bus) const { return buses_[bus].size(); }
  bool imu_silent = false;
  int late_cycles = 0;                                           ///< that each answer of a drive is under way
  Eigen::Quaterniond imu_lean = Eigen::Quaterniond::Identity();  ///< of the world's axes, beside the true orientation

 private:
  struct Held {
    long due;  // in ticks
    std::size_t bus;
    drives::Message frame;
  };
  void reply(std::size_t bus, std::span<const drives::Message> frames) noexcept {
    if (late_cycles == 0 && held_.empty()) {
      links_[bus]->send(frames);
    } else {
      for (const drives::Message& frame : frames) held_.push_back({ticks_ + late_cycles, bus, frame});
    }
  }

  /// The true joints of a linkage, their cranks, and how the ones turn the others.
  template <int N>
  struct Posture {
    using Angles = typename drives::RodLinkage<N>::Angles;
    Angles q_rad, dq_rad_s, torque_Nm, crank_rad;
    typename drives::RodLinkage<N>::Jacobian J;
  };
  /// Nullopt: a rod doesn't reach.
  template <int N>
  std::optional<Posture<N>> posture(std::size_t bus, const drives::LinkedMotors<N>& linked) const noexcept {
    Posture<N> at;
    for (std::size_t i = 0; i < linked.motors.size(); ++i) {
      const int joint = setup_.buses[bus].motors[linked.motors[i]].index;
      const auto row = static_cast<Eigen::Index>(i);
      at.q_rad[row] = sensed_.q[joint];
      at.dq_rad_s[row] = sensed_.dq[joint];
      at.torque_Nm[row] = sensed_.tau[joint];
    }
    const auto cranks = linked.linkage.motor_angles(at.q_rad);
    if (!cranks) return std::nullopt;
    at.crank_rad = *cranks;
    at.J = linked.linkage.jacobian(*cranks, at.q_rad);
    return at;
  }
  template <int N>
  void feel_rods(std::size_t bus, const drives::LinkedMotors<N>& linked) noexcept {
    const auto at = posture(bus, linked);
    if (!at) return;
    const typename Posture<N>::Angles rates = at->J * at->dq_rad_s,
                                      torques = at->J.transpose().inverse() * at->torque_Nm;
    for (std::size_t i = 0; i < linked.motors.size(); ++i) {
      DriveEmulator& drive = *buses_[bus][linked.motors[i]];
      const auto row = static_cast<Eigen::Index>(i);
      drive.feel(drive.setup().transmission.to_motor(
          drives::MotorReading{.q_rad = at->crank_rad[row], .dq_rad_s = rates[row], .torque_Nm = torques[row]}));
    }
  }
  /// (commands of cranks) => those of joints: torque = J^T torque_crank now, and the diagonals of J^T K J from there.
  template <int N>
  void pull_rods(std::size_t bus, const drives::LinkedMotors<N>& linked, model::JointCommand& command) const noexcept {
    const auto at = posture(bus, linked);
    if (!at) return;
    typename Posture<N>::Angles torques, kp, kd;
    const typename Posture<N>::Angles rates = at->J * at->dq_rad_s;
    for (std::size_t i = 0; i < linked.motors.size(); ++i) {
      const DriveEmulator& drive = *buses_[bus][linked.motors[i]];
      const drives::MotorCommand crank = drive.setup().transmission.to_joint(drive.command());
      const auto row = static_cast<Eigen::Index>(i);
      kp[row] = crank.kp_Nm_per_rad;
      kd[row] = crank.kd_Nm_s_per_rad;
      torques[row] =
          kp[row] * (crank.q_rad - at->crank_rad[row]) + kd[row] * (crank.dq_rad_s - rates[row]) + crank.torque_Nm;
    }
    const typename Posture<N>::Angles pulled = at->J.transpose() * torques;
    const typename drives::RodLinkage<N>::Jacobian stiffness = at->J.transpose() * kp.asDiagonal() * at->J,
                                                   damping = at->J.transpose() * kd.asDiagonal() * at->J;
    for (std::size_t i = 0; i < linked.motors.size(); ++i) {
      const int joint = setup_.buses[bus].motors[linked.motors[i]].index;
      const auto row = static_cast<Eigen::Index>(i);
      command.q[joint] = at->q_rad[row];
      command.dq[joint] = at->dq_rad_s[row];
      command.kp[joint] = stiffness(row, row);
      command.kd[joint] = damping(row, row);
      command.tau_ff[joint] = pulled[row];
    }
  }

  const can::DriveSetup& setup_;
  std::deque<Held> held_;
  long ticks_ = 0;
  std::vector<std::unique_ptr<can::Link>> links_;
  std::vector<std::vector<std::unique_ptr<DriveEmulator>>> buses_;
  model::RobotState sensed_;
};

}  // namespace pmg::test
