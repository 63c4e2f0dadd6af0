// A wait-free single-slot mailbox between two threads: the reader gets the newest value, older ones are lost.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace pmg::io {

/// One writer thread, one reader thread. Three slots: one belongs to the writer, one to the reader, and the third
/// changes hands by a single atomic exchange, so neither side ever waits, retries or sees half a value. T's assignment
/// must neither allocate nor throw (fixed-capacity Eigen types keep that, though they don't declare it).
template <typename T>
class Mailbox {
 public:
  /// Writer only.
  void put(const T& value) noexcept {
    slots_[writing_] = value;
    writing_ = shared_.exchange(writing_ | kFresh, std::memory_order_acq_rel) & kSlot;
  }

  /// Reader only. False, and value untouched, when nothing was put since the last take.
  bool take(T& value) noexcept {
    if ((shared_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reading_ = shared_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    value = slots_[reading_];
    return true;
  }

 private:
  static constexpr std::uint8_t kSlot = 3, kFresh = 4;

  std::array<T, 3> slots_{};
  alignas(64) std::uint8_t writing_ = 0;  // a cache line each, so that the threads don't slow each other down
  alignas(64) std::uint8_t reading_ = 1;
  alignas(64) std::atomic<std::uint8_t> shared_{2};
};

}  // namespace pmg::io
