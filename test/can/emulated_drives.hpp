// Every drive of a robot and its IMU, behind links.
#pragma once

#include <poll.h>

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
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

  const can::DriveSetup& setup_;
  std::deque<Held> held_;
  long ticks_ = 0;
  std::vector<std::unique_ptr<can::Link>> links_;
  std::vector<std::vector<std::unique_ptr<DriveEmulator>>> buses_;
  model::RobotState sensed_;
};

}  // namespace pmg::test
