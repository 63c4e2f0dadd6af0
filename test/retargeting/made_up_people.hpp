// People whose walk is known: proportions, speed and sides by choice.
#pragma once

#include <gtest/gtest.h>

#include "mocap/gait_cycle.hpp"
#include "mocap/synthetic_gait.hpp"

namespace pmg::retargeting::test {

/// The best cycle of a made-up walk.
inline mocap::GaitCycle cycle_of(const mocap::Recording& recording) {
  const auto cycle = mocap::best_cycle(recording, mocap::find_steps(recording), 0.0, recording.duration_s());
  EXPECT_TRUE(cycle.has_value());
  return cycle.value_or(mocap::GaitCycle{});
}

}  // namespace pmg::retargeting::test
