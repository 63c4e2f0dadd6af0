// A periodic thread's schedule keeps its grid, and makes up for nothing after a stall.
#include "runtime/periodic_schedule.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

namespace pmg::runtime {
namespace {

constexpr std::int64_t kGrid_ns = 10'000'000, kMillisecond_ns = 1'000'000, kTickTakes_ns = 70'000;

TEST(PeriodicSchedule, CyclesThatEndInTimeKeepTheGrid) {
  PeriodicSchedule schedule(3 * kMillisecond_ns, kGrid_ns);
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(schedule.planned_ns(), 3 * kMillisecond_ns + k * kGrid_ns);
    schedule.advance(schedule.planned_ns() + 80'000, schedule.planned_ns() + 600'000);
  }
  EXPECT_EQ(schedule.missed(), 0);
}

TEST(PeriodicSchedule, ASmallDelayCostsNoCycle) {
  PeriodicSchedule schedule(0, kGrid_ns);
  schedule.advance(4 * kMillisecond_ns, 12 * kMillisecond_ns);
  EXPECT_EQ(schedule.planned_ns(), kGrid_ns) << "it begins late, at once";
  schedule.advance(12 * kMillisecond_ns, 13 * kMillisecond_ns);
  EXPECT_EQ(schedule.planned_ns(), 2 * kGrid_ns);
  EXPECT_EQ(schedule.missed(), 0);
}

TEST(PeriodicSchedule, AShiftMovesTheGridFromTheNextCycleOn) {
  PeriodicSchedule schedule(0, kGrid_ns);
  schedule.shift(20'000);
  EXPECT_EQ(schedule.planned_ns(), 20'000);
  schedule.advance(20'000, 90'000);
  schedule.shift(-5'000);
  EXPECT_EQ(schedule.planned_ns(), kGrid_ns + 15'000);
  EXPECT_EQ(schedule.missed(), 0);
}

/// (length of a stall, its end within a cycle or before it) => (time from the end of that cycle to the next one).
std::int64_t pause_after(std::int64_t stall_ns, bool within_cycle) {
  PeriodicSchedule schedule(0, kGrid_ns);
  const std::int64_t woke_ns = within_cycle ? 50'000 : stall_ns;
  const std::int64_t done_ns = (within_cycle ? woke_ns + stall_ns : woke_ns) + kTickTakes_ns;
  schedule.advance(woke_ns, done_ns);
  EXPECT_EQ(schedule.planned_ns() % kGrid_ns, 0) << "on the grid";
  EXPECT_EQ(schedule.planned_ns(), (1 + schedule.missed()) * kGrid_ns) << "every cycle ran or was counted";
  return schedule.planned_ns() - done_ns;
}

TEST(PeriodicSchedule, AfterAStallTheNextCycleLeavesAQuarterOfAPeriodAndComesWithinOneAndAQuarter) {
  std::mt19937_64 random(5);
  for (int k = 0; k < 20'000; ++k) {
    const auto stall_ns = static_cast<std::int64_t>(kGrid_ns / 2 + random() % 10'000'000'000u);
    // Within a cycle, half a period more passes before the delay counts as a stall.
    for (const bool within_cycle : {false, true}) {
      const std::int64_t pause_ns = pause_after(stall_ns + (within_cycle ? kGrid_ns : 0), within_cycle);
      ASSERT_GE(pause_ns, kGrid_ns / 4) << stall_ns;
      ASSERT_LT(pause_ns, kGrid_ns * 5 / 4) << stall_ns;
    }
  }
}

TEST(PeriodicSchedule, ACycleThatTakesTenPeriodsIsFollowedByOneAndNotByTen) {
  PeriodicSchedule schedule(0, kGrid_ns);
  schedule.advance(0, 10 * kGrid_ns);
  EXPECT_EQ(schedule.planned_ns(), 11 * kGrid_ns);
  EXPECT_EQ(schedule.missed(), 10);
}

}  // namespace
}  // namespace pmg::runtime
