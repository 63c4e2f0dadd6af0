// A simulation waits for its computer: bus and control thread take turns, one tick, then its bus cycles. A robot's
// don't.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "control/control_cycle.hpp"
#include "hal/bus_cycle.hpp"

namespace pmg::runtime {

/// The physics of a simulation stand between two bus cycles, so nothing falls while a thread is late:
/// - The bus thread runs the cycles of a tick's command (control::ControlCycle::kBusCycles), no sooner than their time
///   and no more; then it leaves cycles out until the next tick has given its command. What it slept through of the
///   turn it makes up for at once.
/// - The control thread begins a tick when the cycles of the last one are done.
/// Who waits for kPatience_cycles gives up until the other one is back: a thread that hangs is the fault that it is on
/// a robot. Cycles are counted, not time, as the bus guard does: a computer that stops both threads is no hang.
/// Wait-free: two threads, no lock, no heap. Plain arithmetic, so tests give the times.
class Turns {
 public:
  static constexpr int kPatience_cycles = 250;  ///< 0.5 s of a bus thread that is on time
  /// How often a waiting control thread looks, and how many looks are as long as the bus thread's patience.
  static constexpr std::int64_t kLook_ns = 250'000;
  static constexpr int kPatience_looks = static_cast<int>(kPatience_cycles * hal::BusCycle::kPeriod_ns / kLook_ns);

  /// The bus thread, when it wakes: the cycles to run now, at most those of one turn.
  int due(std::int64_t now_ns) noexcept {
    const std::int64_t turn_ns = turn_ns_.load(std::memory_order_acquire);
    if (turn_ns == 0) return 1;  // no tick yet: the robot is limp
    if (turn_ns != seen_ns_) {
      if (seen_ns_ == 0) first_ns_ = now_ns;
      seen_ns_ = turn_ns;
      ran_ = waited_ = 0;
    }
    int cycles = 0;
    if (ran_ < kTurn) {
      const std::int64_t by_now = (now_ns - turn_ns) / hal::BusCycle::kPeriod_ns + 1;
      cycles = static_cast<int>(std::clamp<std::int64_t>(by_now, ran_, kTurn)) - ran_;
    } else if (waited_ < kPatience_cycles) {
      ++waited_;
    } else {
      cycles = 1;
    }
    ran_ = std::min(ran_ + cycles, kTurn);
    simulated_ns_ += cycles * hal::BusCycle::kPeriod_ns;
    passed_.store(now_ns - first_ns_, std::memory_order_relaxed);
    lost_.store(std::max<std::int64_t>(now_ns - first_ns_ - simulated_ns_, 0), std::memory_order_relaxed);
    return cycles;
  }
  /// The bus thread, after these cycles.
  void ran() noexcept {
    if (ran_ == kTurn) done_ns_.store(seen_ns_, std::memory_order_release);
  }

  /// The control thread, before a tick, every kLook_ns: false while it should wait.
  bool may_tick() noexcept {
    if (begun_ns_ == 0 || done_ns_.load(std::memory_order_acquire) == begun_ns_) {
      looks_ = 0;
      return true;
    }
    looks_ = std::min(looks_ + 1, kPatience_looks);
    return looks_ == kPatience_looks;
  }
  /// The control thread, after a tick. planned_ns: when the tick was to begin; another one each time.
  void ticked(std::int64_t planned_ns) noexcept {
    begun_ns_ = planned_ns;
    turn_ns_.store(planned_ns, std::memory_order_release);
  }

  std::int64_t passed_ns() const noexcept { return passed_.load(std::memory_order_relaxed); }  ///< since the first tick
  /// Of these, the time that the simulation did not go on; a few bus cycles are none of it. Any thread.
  std::int64_t lost_ns() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  static constexpr int kTurn = control::ControlCycle::kBusCycles;

  std::atomic<std::int64_t> turn_ns_{0};  // of the newest command
  std::atomic<std::int64_t> done_ns_{0};  // of the last turn whose cycles are done
  std::atomic<std::int64_t> passed_{0}, lost_{0};
  // the bus thread's
  std::int64_t seen_ns_ = 0, first_ns_ = 0, simulated_ns_ = 0;
  int ran_ = 0, waited_ = 0;
  // the control thread's
  std::int64_t begun_ns_ = 0;
  int looks_ = 0;
};

}  // namespace pmg::runtime
