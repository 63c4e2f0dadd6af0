// The tour behind emulated drives beside the same tour in process.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "can/robot_stage.hpp"
#include "folders.hpp"

namespace pmg::sil {

/// Tracking errors of five seeds' tours. more: of the stage's constructor, after the seed and `true`.
template <typename AnyStage, typename... More>
void expect_the_tour_tracked_as_in_process(More... more) {
  const Scenario tour = load_scenario(pmg::test::project_folder() + "/config/scenarios/tour.yaml");
  std::array<double, 5> sums_bus{}, sums_sil{};
  constexpr int kSeeds = 5;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    AnyStage behind(static_cast<std::uint64_t>(seed), true, more...),
        in_process(static_cast<std::uint64_t>(seed), false);
    const RunOutcome over_bus = behind.run(tour), sil = in_process.run(tour);
    EXPECT_FALSE(over_bus.fell) << seed;
    EXPECT_TRUE(over_bus.faults.empty()) << seed;
    fmt::print("seed {}\n  {}\n  {}\n", seed, line("bus", over_bus.tracking), line("sil", sil.tracking));
    const auto add = [](std::array<double, 5>& sums, const TrackingSummary& t) {
      const std::array<double, 5> values = {t.lin_vel_mae_m_s, t.yaw_vel_mae_rad_s, t.pitch_mae_rad, t.roll_mae_rad,
                                            t.height_mae_m};
      for (std::size_t i = 0; i < values.size(); ++i) sums[i] += values[i];
    };
    add(sums_bus, over_bus.tracking);
    add(sums_sil, sil.tracking);
  }
  for (std::size_t i = 0; i < sums_bus.size(); ++i) {
    fmt::print("metric {}: bus / sil = {:.4f}\n", i, sums_bus[i] / sums_sil[i]);
    EXPECT_LT(std::abs(sums_bus[i] / sums_sil[i] - 1.0), 0.05) << i;
  }
}

}  // namespace pmg::sil
