// One tick by value, inputs and result: the control thread hands it to the threads that log and publish.
#pragma once

#include <array>
#include <cstdint>

#include "control/tick.hpp"

namespace pmg::control {

/// Wall-clock times of one cycle of a periodic thread. Zero in lockstep, where logs are reproducible.
struct CycleTiming {
  std::int64_t planned_ns = 0, woke_ns = 0, done_ns = 0;
  std::int64_t missed = 0;  ///< cycles left out since the start (runtime/periodic_schedule.hpp)
};

struct TickRecord {
  std::int64_t tick = 0;  ///< counts from 0
  model::RobotState state;
  hal::BusStatus bus = hal::BusStatus::kOk;
  std::int64_t now_ns = 0;
  std::array<DriveMessage, kMaxDrives> drives;
  std::size_t drive_count = 0;
  std::array<ModeRequest, kMaxRequests> requests;
  std::size_t request_count = 0;
  std::array<ArmsMessage, kMaxArms> arms;
  std::size_t arms_count = 0;
  bool stop = false;
  hal::TripCause guard_trip = hal::TripCause::kNone;
  std::int64_t late_ns = 0;
  bool policy_late = false;
  TickResult result;
  CycleTiming timing;

  /// The tick's input; refers to this record.
  TickInput input() const noexcept {
    return {.state = state,
            .bus = bus,
            .now_ns = now_ns,
            .drives = {drives.data(), drive_count},
            .requests = {requests.data(), request_count},
            .arms = {arms.data(), arms_count},
            .stop = stop,
            .guard_trip = guard_trip,
            .late_ns = late_ns,
            .policy_late = policy_late};
  }
};

}  // namespace pmg::control
