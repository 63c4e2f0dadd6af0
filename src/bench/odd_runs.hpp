// Runs that disagree with their own repeats or with all other runs, and copies of a run.
#pragma once

#include <string>
#include <vector>

#include "bench/repeats.hpp"

namespace pmg::bench {

/// evidence::listed() gives the reason of each threshold.
struct OddRunOptions {
  double times_usual = 5.0, fewest_conditions = 3.0;
  double times_nearer = 1.2, agreeing_share = 0.75, slow_share = 0.5, fast_ratio = 0.95;
  double times_by_chance = 2.0;
  double times_neighbours = 8.0;
};

struct OddRun {
  std::size_t index = 0;       ///< in the list of runs
  std::string run;             ///< its file
  std::string why;             ///< one sentence for people
  double deviation_rad = 0.0;  ///< rms difference from the runs that it disagrees with; 0 for a copy
  bool left_out = false;       ///< of fits and of the noise floor. A copy only doesn't count as a repeat.
};

/// (runs, their conditions) => (odd runs, in the runs' order).
///
/// The repeats of a condition usually differ by e: the median over other conditions, of all of them or of those with
/// the same trajectory, gains or load, whichever is largest. So a trajectory or a gain that is noisy in all its
/// conditions is not odd. Repeats within times_usual e of each other agree, and so do those linked by such repeats.
///  - More than half of the repeats agree, and another one is times_usual further from them than they are from each
///    other: it is odd and left out.
///  - Two groups of equal size: the other conditions with the same command decide. The group that agreeing_share of
///    them are further from, by times_nearer, is odd and left out. Else both are named and stay.
///  - Neither: the condition is merely noisy, and no run of it is named. The same holds where groups differ as a drive
///    that hunts does: the difference oscillates (its half-second means hold less than slow_share of its squares), and
///    both move as much (fast_ratio). Repeats that agree to times_by_chance e don't hunt in step by chance, so what is
///    far from them is odd all the same.
/// A run without repeats is named, and stays, where it is times_neighbours further from the nearest conditions with the
/// same command than these usually are from theirs.
std::vector<OddRun> odd_runs(const std::vector<const BenchRun*>& runs, const std::vector<Condition>& conditions,
                             const OddRunOptions& options = {});

}  // namespace pmg::bench
