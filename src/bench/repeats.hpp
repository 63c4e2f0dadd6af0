// Conditions of a bench, and how far the repeats of each differ.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::bench {

/// Two runs and the difference of their readings at the times of the first. Indices into the list of runs.
struct RunPair {
  std::size_t first = 0, second = 0;
  double mean_absolute_rad = 0.0, mean_square_rad2 = 0.0;  ///< of the difference; dropouts are left out
  double slow_share = 0.0;  ///< of the difference's squares: the share that its half-second means hold
  double fast_ratio = 0.0;  ///< of the readings' rms about their half-second means: the smaller run's to the larger's
  std::size_t samples = 0;  ///< compared ones
  bool identical = false;   ///< every reading agrees to the last bit
};

/// Runs of one design, all with the same command: same trajectory, gains and load, and one run of each repeat. Indices
/// into the list of runs.
struct Condition {
  std::vector<std::size_t> runs;
  std::vector<RunPair> pairs;  ///< every pair of runs with common samples
};

std::vector<Condition> conditions(const std::vector<const BenchRun*>& runs);

/// (runs, two of them) => (their pair).
RunPair compared(const std::vector<const BenchRun*>& runs, std::size_t first, std::size_t second);

/// Robust scale of the differences between a condition's repeats, 50 % breakdown: of n repeats the h (h - 1) / 2-th
/// smallest difference with h = n / 2 + 1, the rank of P. J. Rousseeuw and C. Croux, JASA 88:1273, 1993. 0 without
/// repeats; copies don't count.
double usual_difference_rad(const Condition& condition);

/// True if two commands agree in more than two thirds of their common samples. A jump may come one sample earlier or
/// later: clocks of hosts drift.
bool same_command(const Recording& a, const Recording& b);

}  // namespace pmg::bench
