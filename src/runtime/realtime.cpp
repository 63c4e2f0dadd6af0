#include "runtime/realtime.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace pmg::runtime {

namespace {

constexpr std::size_t kLongestName = 15;             // the kernel's limit
constexpr unsigned long kSmallestTimerSlack_ns = 1;  // 0 would mean the default, 50 us

bool is_root() { return geteuid() == 0; }

std::string refusal_of_fifo(const ThreadSchedule& wanted, int error) {
  // Root is refused where a control group has no share of real-time (CONFIG_RT_GROUP_SCHED), as in some containers.
  const char* remedy = is_root()
                           ? "give the container or control group the capability CAP_SYS_NICE and a real-time budget"
                           : "run as root, or grant CAP_SYS_NICE, or rtprio in /etc/security/limits.conf";
  return fmt::format("SCHED_FIFO priority {} for thread {}: {}; {}", wanted.priority, wanted.name, std::strerror(error),
                     remedy);
}

std::string refusal_of_cpu(const ThreadSchedule& wanted, int error) {
  return fmt::format("CPU {} for thread {}: {}; this process may use CPUs {}", wanted.cpu, wanted.name,
                     std::strerror(error), fmt::join(kernel_schedule(getpid()).cpus, ", "));
}

/// Zero, or what went wrong.
int pin_to(int cpu) {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  if (cpu >= CPU_SETSIZE) return EINVAL;
  CPU_SET(static_cast<std::size_t>(cpu), &cpus);
  return sched_setaffinity(0, sizeof cpus, &cpus) == 0 ? 0 : errno;
}

}  // namespace

std::vector<std::string> lock_memory() {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  const int error = errno;
  return {fmt::format("locking memory (mlockall): {}; {}", std::strerror(error),
                      is_root()
                          ? "give the container the capability CAP_IPC_LOCK"
                          : "run as root, or grant CAP_IPC_LOCK, or memlock unlimited in /etc/security/limits.conf")};
}

std::vector<std::string> schedule_this_thread(const ThreadSchedule& wanted) {
  std::vector<std::string> refused;
  pthread_setname_np(pthread_self(), wanted.name.substr(0, kLongestName).c_str());
  if (prctl(PR_SET_TIMERSLACK, kSmallestTimerSlack_ns) != 0) {
    refused.push_back(fmt::format("timer slack of 1 ns for thread {}: {}; it wakes up to 50 us late", wanted.name,
                                  std::strerror(errno)));
  }
  if (wanted.cpu >= 0) {
    if (const int error = pin_to(wanted.cpu); error != 0) refused.push_back(refusal_of_cpu(wanted, error));
  }
  if (wanted.priority > 0) {
    const sched_param parameters{.sched_priority = wanted.priority};
    // Children that a library might fork stay ordinary.
    if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) != 0) {
      refused.push_back(refusal_of_fifo(wanted, errno));
    }
  }
  return refused;
}

[[gnu::noinline]] void prefault_stack() noexcept {
  constexpr std::size_t kSmallestPage_bytes = 4096;
  unsigned char pages[256 * 1024];
  volatile unsigned char* touched = pages;
  for (std::size_t offset = 0; offset < sizeof pages; offset += kSmallestPage_bytes) touched[offset] = 0;
}

KernelSchedule kernel_schedule(pid_t thread) {
  KernelSchedule schedule;
  schedule.policy = sched_getscheduler(thread);
  if (schedule.policy < 0) throw std::system_error(errno, std::generic_category(), fmt::format("thread {}", thread));
  schedule.policy &= ~SCHED_RESET_ON_FORK;
  sched_param parameters{};
  sched_getparam(thread, &parameters);
  schedule.priority = parameters.sched_priority;
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  sched_getaffinity(thread, sizeof cpus, &cpus);
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &cpus)) schedule.cpus.push_back(cpu);
  }
  return schedule;
}

}  // namespace pmg::runtime
