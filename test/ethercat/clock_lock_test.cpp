// The bus thread follows the slaves' clock: a loop of plain numbers.
#include "ethercat/clock_lock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pmg::ethercat {
namespace {

constexpr std::int64_t kPeriod_ns = 2'000'000, kWanted_ns = 500'000;

/// A bus thread that wakes late by chance, beside slaves whose clock runs faster by ppm.
struct Loop {
  void run(int cycles) {
    for (int k = 0; k < cycles; ++k) {
      planned_ns += kPeriod_ns + shift_ns;
      const auto woke_ns = static_cast<double>(planned_ns) + late_ns(random);
      shift_ns = lock.update(static_cast<std::int64_t>(woke_ns * (1.0 + 1e-6 * ppm)) + offset_ns,
                             static_cast<std::int64_t>(woke_ns));
      most_shift_ns = std::max(most_shift_ns, std::abs(shift_ns));
    }
  }
  double ppm = 0.0;
  std::int64_t offset_ns = 0, planned_ns = 0, shift_ns = 0, most_shift_ns = 0;
  std::exponential_distribution<double> late_ns{1.0 / 20'000.0};  // 20 us in the mean, as threads here do
  std::mt19937_64 random{1};
  ClockLock lock{kPeriod_ns, kWanted_ns};
};

TEST(ClockLock, FollowsEveryCrystalFromEveryPhaseWithinThreeSeconds) {
  for (const double ppm : {-100.0, 0.0, 100.0}) {
    for (const std::int64_t offset_ns : {0LL, 400'000LL, 900'000LL, 1'499'999LL, 1'500'001LL}) {
      Loop loop;
      loop.ppm = ppm;
      loop.offset_ns = offset_ns;
      loop.run(1500);
      double sum = 0.0, most = 0.0;
      for (int k = 0; k < 1000; ++k) {
        loop.run(1);
        sum += static_cast<double>(loop.lock.error_ns());
        most = std::max(most, std::abs(static_cast<double>(loop.lock.error_ns())));
      }
      EXPECT_LT(std::abs(sum / 1000), 3'000.0)
          << ppm << " " << offset_ns << ": a mean of 1000 with 20 us each is off by 0.6";
      EXPECT_LT(most, 250'000.0) << "lateness of the thread itself";
      EXPECT_NEAR(loop.lock.drift_ns(), -2.0 * ppm, 60.0) << "ns a cycle";
      EXPECT_FALSE(loop.lock.runs_away());
    }
  }
}

TEST(ClockLock, ShiftsByOnePercentOfThePeriodAtMost) {
  Loop loop;
  loop.offset_ns = 1'400'000;
  loop.run(3000);
  EXPECT_LE(loop.most_shift_ns, ClockLock::kMostShift_ns);
}

TEST(ClockLock, OneLateWakeUpMovesItByLittle) {
  Loop loop;
  loop.late_ns = std::exponential_distribution<double>(1.0);
  loop.run(3000);
  const std::int64_t held_up = loop.lock.update(loop.planned_ns + 900'000, loop.planned_ns + 900'000);
  EXPECT_LT(std::abs(held_up), 2'000) << "1.4 % of the 100 us that count";
}

TEST(ClockLock, AClockThatNoCrystalHasRunsAway) {
  for (const double ppm : {-2000.0, 600.0, 2000.0}) {
    Loop loop;
    loop.run(3000);
    const std::int64_t now_ns = loop.planned_ns;
    loop.ppm = ppm;
    loop.offset_ns -= static_cast<std::int64_t>(1e-6 * ppm * static_cast<double>(now_ns));
    loop.run(ClockLock::kSpanCycles);
    EXPECT_FALSE(loop.lock.runs_away()) << ppm;
    loop.run(2 * ClockLock::kSpanCycles);
    EXPECT_TRUE(loop.lock.runs_away()) << ppm;
  }
}

TEST(ClockLock, APhaseThatNeverComesBindsItsIntegratorToWhatACrystalCanBe) {
  ClockLock lock(2'000'000, 500'000);
  for (std::int64_t k = 0; k < 5'000; ++k) lock.update(1'400'000 + 2'000'000 * k, 2'000'000 * k);
  EXPECT_EQ(lock.drift_ns(), -ClockLock::kMostDrift_ns);
}

TEST(ClockLock, OneJumpOfAClockIsNotOneThatRunsAway) {
  ClockLock lock(2'000'000, 500'000);
  for (std::int64_t k = 0; k < 5'000; ++k) {
    lock.update((k < 1'200 ? 500'000 : 2'500'000) + 2'000'000 * k, 2'000'000 * k);
    ASSERT_FALSE(lock.runs_away()) << k;
  }
}

}  // namespace
}  // namespace pmg::ethercat
