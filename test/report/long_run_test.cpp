// Runs that are longer than what pictures show.
#include <gtest/gtest.h>

#include <algorithm>

#include "pages/page.hpp"
#include "report/run_report.hpp"
#include "report/run_series.hpp"
#include "small_log.hpp"
#include "temporary_folder.hpp"

namespace pmg::report {
namespace {

/// The longest of all lines.
std::size_t most_samples(const RunSeries& run) {
  std::size_t most = 0;
  const auto look = [&](const auto& line) { most = std::max(most, line.size()); };
  const auto look_at_each = [&](const auto& lines) { std::ranges::for_each(lines, look); };
  look_at_each(run.state.q_rad);
  look_at_each(run.state.torque_Nm);
  look_at_each(run.state.temperature_degC);
  look_at_each(run.reference.q_ref_rad);
  look_at_each(run.reference.user);
  look_at_each(run.reference.command);
  look_at_each(run.reference.optimised);
  look_at_each(run.reference.slip_before_m_s);
  look_at_each(run.reference.slip_after_m_s);
  look_at_each(run.truth.measured);
  look_at_each(run.truth.foot_slip_m_s);
  for (const auto* line : {&run.state.t_s, &run.reference.t_s, &run.status.t_s, &run.truth.t_s,
                           &run.status.limited_position, &run.status.limited_rate, &run.status.limited_torque})
    look(*line);
  return most;
}

TEST(LongRun, NeedsNoMoreMemoryAndItsFiguresCountEveryTick) {
  constexpr int kTicks = 140'000;  // the lines' bound is a quarter of it, the distributions' half
  const test::TemporaryFolder folder;
  test::SmallLog{.ticks = kTicks, .fault_at = kTicks - 100}.write(folder.path() / "log.lcm");
  const RunSeries run = read_run(folder.path() / "log.lcm");
  EXPECT_LE(most_samples(run), Thinning::kMost);
  EXPECT_NO_THROW(run_report({run})) << "each line is thinned with its times";
  for (const Sampled* times : {&run.timing.wake_us, &run.timing.tick_us, &run.timing.bus_wake_us})
    EXPECT_LE(times->values().size(), Sampled::kMost);
  EXPECT_EQ(run.status.ticks, kTicks);
  EXPECT_EQ(run.timing.ticks, kTicks);
  EXPECT_EQ(run.status.rate_ticks, 10);
  EXPECT_NEAR(run.joint_tracking[0].error_rms_rad, 0.1, 1e-9);
  EXPECT_NEAR(run.reference_slip.before_mean_m_s, 0.08, 1e-9);
  EXPECT_NEAR(run.tracking.followed_s, 0.01 * kTicks, 0.05);
  EXPECT_NEAR(run.duration_s, 0.01 * (kTicks - 1), 1e-6);
  EXPECT_NEAR(run.state.t_s.back(), run.duration_s, 1e-6) << "the end is not lost";
  EXPECT_GT(std::ranges::count(run.status.limited_rate, 1.0), 0) << "nor is a tenth of a second";
  EXPECT_EQ(run.limited[0].reasons(), "speed in 10 ticks");
}

}  // namespace
}  // namespace pmg::report
