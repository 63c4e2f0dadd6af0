// A periodic thread keeps its grid, and the kernel confirms its scheduling.
#include "runtime/periodic_thread.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <thread>
#include <vector>

#include "io/clock.hpp"
#include "runtime/threaded_controller.hpp"

namespace pmg::runtime {
namespace {

using test::eventually;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kPeriod_ns = 2'000'000;
const io::WallClock kWall;

TEST(PeriodicThread, WhatTheKernelSaysIsWhatWasGranted) {
  const ThreadSchedule wanted{.name = "punctual", .priority = 50, .cpu = kernel_schedule(getpid()).cpus.front()};
  PeriodicThread thread(wanted, kPeriod_ns, [](const control::CycleTiming&) {});
  const KernelSchedule granted = kernel_schedule(thread.id());
  if (thread.refused().empty()) {
    EXPECT_EQ(granted.policy, SCHED_FIFO);
    EXPECT_EQ(granted.priority, 50);
    EXPECT_THAT(granted.cpus, ElementsAre(wanted.cpu));
  } else {
    EXPECT_EQ(granted.policy, SCHED_OTHER);
    EXPECT_THAT(thread.refused()[0], HasSubstr("SCHED_FIFO priority 50 for thread punctual"));
  }
}

TEST(PeriodicThread, WithoutAWishItIsScheduledOrdinarily) {
  PeriodicThread thread({.name = "ordinary"}, kPeriod_ns, [](const control::CycleTiming&) {});
  EXPECT_TRUE(thread.refused().empty());
  EXPECT_EQ(kernel_schedule(thread.id()).policy, SCHED_OTHER);
  EXPECT_EQ(kernel_schedule(thread.id()).cpus, kernel_schedule(getpid()).cpus);
}

TEST(PeriodicThread, ACpuThatIsNotThereIsNamedAndTheThreadRunsOn) {
  std::atomic<int> cycles{0};
  PeriodicThread thread({.name = "lost", .cpu = 1023}, kPeriod_ns, [&](const control::CycleTiming&) { ++cycles; });
  ASSERT_EQ(thread.refused().size(), 1u);
  EXPECT_THAT(thread.refused()[0], HasSubstr("CPU 1023 for thread lost"));
  EXPECT_THAT(thread.refused()[0], HasSubstr("may use CPUs"));
  thread.start(kWall.now_ns());
  EXPECT_TRUE(eventually([&] { return cycles > 3; }));
}

TEST(PeriodicThread, ItsGridFollowsTheShift) {
  constexpr std::int64_t kShift_ns = 15'000;
  std::atomic<std::int64_t> shift_ns{0};
  std::vector<std::int64_t> planned_ns;
  planned_ns.reserve(10'000);
  std::atomic<int> cycles{0};
  PeriodicThread thread(
      {.name = "drawn"}, kPeriod_ns,
      [&](const control::CycleTiming& timing) {
        if (planned_ns.size() < planned_ns.capacity()) planned_ns.push_back(timing.planned_ns);
        shift_ns.fetch_add(kShift_ns);
        ++cycles;
      },
      &shift_ns);
  thread.start(kWall.now_ns());
  EXPECT_TRUE(eventually([&] { return cycles > 20; }));
  thread.stop();
  for (std::size_t k = 1; k < planned_ns.size(); ++k)
    EXPECT_EQ((planned_ns[k] - planned_ns[k - 1] - kShift_ns) % kPeriod_ns, 0) << k << ": on the moved grid";
}

/// Runs without any privilege, in a process of its own; the exit code names the broken promise.
int run_without_privilege() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_RTPRIO, &none);
  const rlimit little{64 * 1024, 64 * 1024};
  setrlimit(RLIMIT_MEMLOCK, &little);
  constexpr uid_t kNobody = 65534;
  if (geteuid() == 0 && setresuid(kNobody, kNobody, kNobody) != 0) return 1;
  const std::vector<std::string> memory = lock_memory();
  if (memory.size() != 1 || memory[0].find("mlockall") == std::string::npos ||
      memory[0].find("CAP_IPC_LOCK") == std::string::npos) {
    return 2;
  }
  std::atomic<int> cycles{0};
  PeriodicThread thread({.name = "poor", .priority = 80}, kPeriod_ns, [&](const control::CycleTiming&) { ++cycles; });
  if (thread.refused().size() != 1) return 3;
  const std::string& sentence = thread.refused()[0];
  std::fprintf(stderr, "%s\n%s\n", memory[0].c_str(), sentence.c_str());
  for (const char* part :
       {"SCHED_FIFO priority 80 for thread poor", "Operation not permitted", "CAP_SYS_NICE", "rtprio"}) {
    if (sentence.find(part) == std::string::npos) return 4;
  }
  if (kernel_schedule(thread.id()).policy != SCHED_OTHER) return 5;
  thread.start(kWall.now_ns());
  return eventually([&] { return cycles > 3; }) ? 0 : 6;
}

TEST(PeriodicThread, WhatTheSystemRefusesIsSaidAndTheThreadRunsOn) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "sanitizers lock no memory, and don't follow a fork into threads";
#endif
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) _exit(run_without_privilege());
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(PeriodicThread, CyclesStayOnTheirGridAndMissedOnesAreCountedNotMadeUpFor) {
  std::vector<control::CycleTiming> cycles;
  const std::int64_t first_ns = kWall.now_ns() + kPeriod_ns;
  PeriodicThread thread({.name = "grid"}, kPeriod_ns, [&](const control::CycleTiming& timing) {
    cycles.push_back(timing);
    if (cycles.size() == 5) {  // one cycle takes ten periods
      while (kWall.now_ns() < timing.planned_ns + 10 * kPeriod_ns) std::this_thread::yield();
    }
  });
  thread.start(first_ns);
  ASSERT_TRUE(eventually([&] { return kWall.now_ns() > first_ns + 40 * kPeriod_ns; }));
  thread.stop();
  ASSERT_GT(cycles.size(), 6u);
  EXPECT_EQ(cycles.front().planned_ns, first_ns);
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    EXPECT_GE(cycles[i].woke_ns, cycles[i].planned_ns) << i;
    const auto ran = static_cast<std::int64_t>(i);
    EXPECT_EQ(cycles[i].planned_ns, first_ns + (ran + cycles[i].missed) * kPeriod_ns) << i;
  }
  // Nine of the ten periods are lost; the tenth may still be on time.
  EXPECT_GE(cycles[5].missed - cycles[4].missed, 9);
  EXPECT_EQ(thread.statistics().cycles(), static_cast<std::int64_t>(cycles.size()));
  EXPECT_GE(thread.statistics().overruns(), 1);
}

TEST(PeriodicThread, StopsWithoutEverHavingStarted) {
  std::atomic<int> cycles{0};
  {
    PeriodicThread thread({.name = "idle"}, kPeriod_ns, [&](const control::CycleTiming&) { ++cycles; });
    thread.stop();
    thread.stop();
  }
  EXPECT_EQ(cycles, 0);
}

}  // namespace
}  // namespace pmg::runtime
