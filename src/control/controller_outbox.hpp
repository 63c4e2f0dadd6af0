// Queues from the real-time threads to the threads that log and publish: bounded and wait-free. Items that don't fit
// are counted.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "control/mode.hpp"
#include "control/tick_record.hpp"
#include "io/mailbox.hpp"

namespace pmg::control {

/// Items that found their queue full since the start.
struct DroppedItems {
  std::int64_t records = 0;     ///< ticks, for the recorder
  std::int64_t bus_cycles = 0;  ///< times of bus cycles, for the recorder
  std::int64_t acks = 0;        ///< answers to operators' requests, for the network
};

class ControllerOutbox {
 public:
  static constexpr std::size_t kRecords = 1024;    ///< ten seconds of ticks, some 11 MB
  static constexpr std::size_t kBusCycles = 8192;  ///< sixteen seconds

  boost::lockfree::spsc_queue<TickRecord> records{kRecords};                 ///< control -> recorder: every tick
  boost::lockfree::spsc_queue<CycleTiming> bus_cycles{kBusCycles};           ///< bus -> recorder: every cycle
  boost::lockfree::spsc_queue<ModeAck, boost::lockfree::capacity<64>> acks;  ///< control -> comms
  io::Mailbox<TickRecord> newest;                                            ///< control -> comms: what is published

  /// Control thread: hands on one tick and its answers.
  void put(const TickRecord& record) noexcept {
    push(records, record, dropped_records_);
    publish(record);
  }
  /// The same where nobody records.
  void publish(const TickRecord& record) noexcept {
    for (std::size_t i = 0; i < record.result.ack_count; ++i) push(acks, record.result.acks[i], dropped_acks_);
    newest.put(record);
  }
  /// Bus thread: hands on the times of one cycle.
  void put(const CycleTiming& cycle) noexcept { push(bus_cycles, cycle, dropped_bus_cycles_); }

  DroppedItems dropped() const noexcept {
    return {.records = dropped_records_.load(std::memory_order_relaxed),
            .bus_cycles = dropped_bus_cycles_.load(std::memory_order_relaxed),
            .acks = dropped_acks_.load(std::memory_order_relaxed)};
  }

 private:
  template <typename Queue, typename Item>
  static void push(Queue& queue, const Item& item, std::atomic<std::int64_t>& dropped) noexcept {
    if (!queue.push(item)) dropped.fetch_add(1, std::memory_order_relaxed);
  }

  std::atomic<std::int64_t> dropped_records_{0}, dropped_bus_cycles_{0}, dropped_acks_{0};
};

}  // namespace pmg::control
