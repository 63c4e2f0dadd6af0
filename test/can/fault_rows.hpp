// A fault while the robot walks behind emulated drives, and after how many bus cycles each drive damps.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "can/canopen_setup.hpp"
#include "can/robot_stage.hpp"
#include "drive_protocols/mit_drive.hpp"

namespace pmg::sil {

/// A row of the table in docs/reference/safety.md, section "Drives on CAN buses". least, most: bus cycles from the
/// first one with the cause, until every drive damps for good or the sit-down begins.
template <typename AnyStage>
struct FaultRowOf {
  const char* name = nullptr;
  void (*inject)(AnyStage&) = nullptr;
  int least = 0, most = 0;
  faults::FaultCode code = faults::FaultCode::kBusLost;
  bool sits_down = false;
  /// Drives that hear nothing any more: their own watchdogs stop them.
  bool (*deaf)(std::size_t bus, std::size_t motor) = nullptr;
  bool from_loss = false;  ///< cycles count from the first one in which the bus is lost
};
using FaultRow = FaultRowOf<Stage>;

/// Cycles after the last one that a deaf drive heard, until its watchdog has acted. A CANopen drive counts from the
/// last heartbeat, which came in the last cycle or some before.
inline int watchdog_cycles(const drives::MotorSetup& motor) {
  if (drives::as_mit(motor.drive) != nullptr) return test::DriveEmulator::kWatchdogCycles - 1;
  return static_cast<int>(drives::canopen::kHeartbeatTimeout_ms) / 2 - 2;
}

/// Runs one row on one robot; the fault begins in bus cycle `from`. more: of the stage's constructor, after the seed.
template <typename AnyStage, typename... More>
void expect_reaction(const FaultRowOf<AnyStage>& row, int from, More... more) {
  AnyStage stage(1, more...);
  std::vector<int> damped_since(stage.loaded.robot.joints.size(), -1);
  int sat_down = -1, lost = -1;
  stage.robot->before = [&](int cycle) {
    if (cycle == from) row.inject(stage);
  };
  stage.robot->after = [&](int cycle, hal::BusStatus status) {
    if (cycle < from) return;
    if (lost < 0 && status == hal::BusStatus::kLost) lost = cycle;
    if (sat_down < 0 && stage.sat_down) sat_down = cycle;
    for (std::size_t j = 0; j < damped_since.size(); ++j) {
      if (!stage.robot->damps(static_cast<int>(j))) {
        damped_since[j] = -1;
      } else if (damped_since[j] < 0) {
        damped_since[j] = cycle;
      }
    }
  };
  stage.run(walking(1.0, 0.8));
  EXPECT_EQ(stage.fault, row.code) << row.name;
  const int begin = row.from_loss ? lost : from;
  if (row.sits_down) {
    EXPECT_GE(sat_down - begin, row.least) << row.name;
    EXPECT_LE(sat_down - begin, row.most) << row.name;
    fmt::print("{}: sits down {} cycles after the cause\n", row.name, sat_down - begin);
    return;
  }
  int all = -1, deaf = -1;
  for (std::size_t b = 0; b < stage.setup.buses.size(); ++b) {
    const std::vector<drives::MotorSetup>& motors = stage.setup.buses[b].motors;
    for (std::size_t m = 0; m < motors.size(); ++m) {
      const int since = damped_since[static_cast<std::size_t>(motors[m].index)];
      ASSERT_GE(since, 0) << row.name << ": " << motors[m].joint << " does not damp";
      if (row.deaf != nullptr && row.deaf(b, m)) {
        EXPECT_LE(since - from, watchdog_cycles(motors[m])) << row.name << ": " << motors[m].joint;
        deaf = std::max(deaf, since - from);
      } else {
        EXPECT_LE(since - begin, row.most) << row.name << ": " << motors[m].joint;
        all = std::max(all, since - begin);
      }
    }
  }
  if (all >= 0) {
    EXPECT_GE(all, row.least) << row.name;
  }
  fmt::print("{}: all that hear damp after {} cycles, those that do not hear after {}\n", row.name, all, deaf);
}

/// Each row, the fault at different moments between two control ticks. most: moments a row; the rows begin at different
/// ones.
template <typename AnyStage, typename... More>
void expect_reactions(std::span<const FaultRowOf<AnyStage>> rows, int most, More... more) {
  constexpr int kFrom = 790, kTickCycles = 5;  // the robot has begun to walk in cycle 500
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (int k = 0; k < std::min(most, kTickCycles); ++k)
      expect_reaction(rows[r], kFrom + (static_cast<int>(r) + k) % kTickCycles, more...);
  }
}

}  // namespace pmg::sil
