// Asks the system for real-time scheduling, and says in plain words what the system refuses.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

namespace pmg::runtime {

/// The scheduling that one thread asks for.
struct ThreadSchedule {
  std::string name;  ///< as the kernel shows it: at most 15 characters
  int priority = 0;  ///< SCHED_FIFO, 1 to 99; 0: ordinary scheduling
  int cpu = -1;      ///< the one CPU that it may run on; -1: any
};

/// The scheduling that a thread has, by the kernel's word.
struct KernelSchedule {
  int policy = 0;         ///< SCHED_FIFO, SCHED_OTHER, ...
  int priority = 0;       ///< of SCHED_FIFO
  std::vector<int> cpus;  ///< that it may run on
};

/// Every function below returns what the system refused: a sentence each with what, why and how to grant it; empty when
/// all was granted. A refusal is never fatal: the controller runs on, later than it should.

/// Locks all pages of this process in memory, future ones included: a page fault would cost milliseconds.
std::vector<std::string> lock_memory();

/// Names and schedules the calling thread, and lets its timers fire without slack.
std::vector<std::string> schedule_this_thread(const ThreadSchedule& wanted);

/// Stack of a real-time thread: little enough to be locked, room enough for thread-local data, of which
/// ThreadSanitizer alone puts 0.8 MB there.
inline constexpr std::size_t kRealtimeStack_bytes = 2 * 1024 * 1024;

/// Touches the next 256 KiB of the calling thread's stack, far more than a cycle uses, so that no cycle is the first to
/// use a page of it. Needed where locking memory is refused.
void prefault_stack() noexcept;

/// Throws std::system_error when there is no such thread.
KernelSchedule kernel_schedule(pid_t thread);

}  // namespace pmg::runtime
