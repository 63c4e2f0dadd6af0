// Runs that disagree with their own repeats or with all other runs, and copies of a run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/repeats.hpp"
#include "work/threshold.hpp"

namespace pmg::bench {

inline constexpr std::string_view kServo =
    "240 conditions of a measured servo: odd runs 11 times and more, all others up to 3";
inline constexpr std::string_view kAssumed = "assumed; another measured joint with repeats would settle it";

struct OddRunOptions {
  work::Threshold times_usual{
      5.0, "",
      "repeats that differ by so many times what repeats usually do disagree; noise alone differs by two or three",
      kServo};
  work::CountThreshold fewest_conditions{3, "", "conditions that say what is usual: a median of fewer is none",
                                         kAssumed};
  work::Threshold times_nearer{
      1.2, "",
      "of two repeats another condition is nearer to one, where the other's distance is so many times as large",
      kAssumed};
  work::Threshold agreeing_share{0.75, "", "share of the other conditions that must be nearer to the same one",
                                 kAssumed};
  work::Threshold slow_share{0.5, "",
                             "a difference whose half-second means hold a smaller share of its squares oscillates: "
                             "noise, or a drive that hunts",
                             kAssumed};
  work::Threshold fast_ratio{
      0.95, "", "and both repeats move about as much: a joint that stalls in a fast motion moves less", kAssumed};
  work::Threshold times_by_chance{
      2.0, "",
      "repeats of a drive that hunts may be in step by chance, but hardly to so many times the usual difference",
      kAssumed};
  work::Threshold times_neighbours{8.0, "",
                                   "a run without repeats is odd from so many times the usual distance to neighbours "
                                   "on: the edge of a design has two or three times the distance",
                                   kAssumed};

  PMG_THRESHOLDS(times_usual, fewest_conditions, times_nearer, agreeing_share, slow_share, fast_ratio, times_by_chance,
                 times_neighbours)
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
