// From the real-time threads to those that log and publish: bounded, wait-free, and whatever doesn't fit is counted.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "control/mode.hpp"
#include "control/tick_record.hpp"
#include "io/mailbox.hpp"

namespace pmg::control {

struct ControllerOutbox {
  static constexpr std::size_t kRecords = 1024;    ///< ten seconds of ticks, some 8 MB
  static constexpr std::size_t kBusCycles = 8192;  ///< sixteen seconds

  boost::lockfree::spsc_queue<TickRecord> records{kRecords};                 ///< control -> recorder: every tick
  boost::lockfree::spsc_queue<CycleTiming> bus_cycles{kBusCycles};           ///< bus -> recorder: every cycle
  boost::lockfree::spsc_queue<ModeAck, boost::lockfree::capacity<64>> acks;  ///< control -> comms
  io::Mailbox<TickRecord> newest;                                            ///< control -> comms: what is published
  std::atomic<std::int64_t> dropped_records{0};  ///< ticks that found the recorder's queue full
  std::atomic<std::int64_t> dropped_bus_cycles{0};
};

}  // namespace pmg::control
