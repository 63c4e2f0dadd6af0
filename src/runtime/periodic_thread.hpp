// One real-time thread that calls one function at absolute times of the monotonic clock, io::WallClock's.
#pragma once

#include <pthread.h>
#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <semaphore>
#include <string>
#include <vector>

#include "runtime/cycle_statistics.hpp"
#include "runtime/realtime.hpp"

namespace pmg::runtime {

class PeriodicThread {
 public:
  /// Called once a period; must not throw: the process would end. timing.done_ns is not known yet.
  using Cycle = std::function<void(const control::CycleTiming& timing)>;

  /// Makes the thread, scheduled as wanted as far as the system allows, and lets it wait for start(). Throws
  /// std::system_error when the system refuses a thread altogether.
  /// shift_ns: by how much the cycles' grid is moved in all, read after each cycle; outlives the thread. Null: never.
  PeriodicThread(const ThreadSchedule& schedule, std::int64_t period_ns, Cycle cycle,
                 const std::atomic<std::int64_t>* shift_ns = nullptr);
  ~PeriodicThread();  ///< stops
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

  /// First cycle at this time of the clock, then one a period. Once.
  void start(std::int64_t first_ns);
  /// Ends the thread after the cycle that runs now. Returns when the thread has ended; may be called again.
  void stop() noexcept;

  const std::vector<std::string>& refused() const noexcept { return refused_; }
  pid_t id() const noexcept { return id_; }  ///< the kernel's
  /// To be read only after the thread has been stopped.
  const CycleStatistics& statistics() const noexcept { return statistics_; }

 private:
  static void* enter(void* self);
  void prepare();
  void loop() noexcept;

  ThreadSchedule schedule_;
  std::int64_t period_ns_;
  Cycle cycle_;
  const std::atomic<std::int64_t>* shift_ns_;
  CycleStatistics statistics_;
  std::vector<std::string> refused_;
  pid_t id_ = 0;
  std::int64_t first_ns_ = 0;
  std::binary_semaphore prepared_{0};
  std::counting_semaphore<2> started_{0};  // released by start() and by stop()
  std::atomic<bool> stopping_{false};
  bool joined_ = false;
  pthread_t thread_{};
};

}  // namespace pmg::runtime
