// How much this process has simulated: the cost of a fit, whatever machine it runs on.
#pragma once

#include <cstdint>

namespace pmg::calib {

/// Counts since the start of the process. Differences measure the cost of what was done in between.
struct Simulated {
  std::uint64_t rollouts = 0;  ///< of single joints, each of one recording
  std::uint64_t steps = 0;     ///< of their integrator
};

/// All threads together.
Simulated simulated() noexcept;

}  // namespace pmg::calib
