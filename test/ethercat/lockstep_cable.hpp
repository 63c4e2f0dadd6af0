// A robot behind emulated slaves and its host, in lockstep: each frame has passed the slaves when the next one is sent.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "../sim/robots.hpp"
#include "ethercat/cabled_drives.hpp"

namespace pmg::test {

using hal::BusStatus;

/// A cable of this form, and its host in lockstep.
class LockstepCable {
 public:
  explicit LockstepCable(const CableForm& form = {}) : cabled(z1(), form) {
    truth.q = z1().q_stand();
    truth.dq = truth.tau = JointVector::Zero(truth.q.size());
    truth.acceleration_m_s2 = Eigen::Vector3d(0.0, 0.0, 9.81);
    standing = limp = acting = standing_command(z1());
    limp.kp.setZero();
    limp.kd.setZero();
    cabled.feel(truth);
  }
  void connect() {
    hal.emplace(
        cabled.cable, cabled.setup, z1(), clock, cabled.wire,
        [this] {
          cabled.feel(truth);
          cabled.drives->serve();
        },
        std::function<bool()>());
  }
  std::string refusal() {
    try {
      connect();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "connected";
  }
  BusStatus cycle(const model::JointCommand& command) {
    cabled.feel(truth);
    const BusStatus status = hal->exchange(command, state);
    cabled.drives->serve();
    cabled.drives->tick(acting);
    cabled.tick_slaves();
    return status;
  }
  void stand() {
    connect();
    for (int k = 0; k < 20; ++k) cycle(limp);
    for (int k = 0; k < 5; ++k) ASSERT_EQ(cycle(standing), BusStatus::kOk) << hal->take_news();
    hal->take_news();
  }
  int cycles_until(BusStatus wanted, const model::JointCommand& command) {
    for (int k = 1; k < 50; ++k) {
      if (cycle(command) == wanted) return k;
    }
    return -1;
  }

  CabledDrives cabled;
  io::SimulationClock clock;
  std::optional<ethercat::EthercatHal> hal;
  model::RobotState truth, state;
  model::JointCommand standing, limp, acting;
};

}  // namespace pmg::test
