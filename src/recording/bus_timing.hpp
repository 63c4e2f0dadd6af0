// Times of the bus cycles between two ticks, for TIMING.
#pragma once

#include <cstdint>

#include "control/controller_outbox.hpp"
#include "control/tick_record.hpp"

namespace pmg::recording {

/// Number and worst times of these cycles.
struct BusTiming {
  std::int32_t cycles = 0;
  std::int64_t wake_max_ns = 0, exchange_max_ns = 0;
  std::int64_t missed = 0;  ///< since the start

  void add(const control::CycleTiming& cycle) noexcept;
  void start_anew() noexcept;  ///< sets everything but missed to zero
};

/// Takes the bus cycles out of the outbox, tick by tick. One reader.
class BusCycleReader {
 public:
  explicit BusCycleReader(control::ControllerOutbox& outbox) : outbox_(outbox) {}

  /// Adds the cycles that had ended by then; younger ones stay for a later call.
  void take_until(std::int64_t until_ns, BusTiming& into) noexcept;

 private:
  control::ControllerOutbox& outbox_;
  control::CycleTiming cycle_;  // taken out of the queue, but too young
  bool held_ = false;
};

}  // namespace pmg::recording
