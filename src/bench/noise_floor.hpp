// Noise floor: how much recordings of the same experiment differ. No model can predict better.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/odd_runs.hpp"

namespace pmg::bench {

/// A robust estimate. Of each condition: the median over its pairs of repeats, odd runs and copies left out. Then the
/// median over the conditions. So neither bad runs nor copies of runs move it as long as less than half of the
/// conditions have them. For Gaussian noise a pair's rms difference is sqrt(2) deviations (its mean absolute one is
/// 2 / sqrt(pi) of them): no factor as of a median absolute deviation is needed, because the squares are averaged
/// within a run, where noise differs between rest and motion, and only then ranked.
struct NoiseFloor {
  std::vector<RunPair> pairs;    ///< those behind the floor; empty without repeats
  std::vector<OddRun> odd_runs;  ///< in the order of the runs
  /// Difference of two repeats: the error of a model that reproduces one repeat exactly and is scored on the other.
  double difference_mean_absolute_rad = 0.0, difference_rms_rad = 0.0;
  /// Deviation of one recording from the mean of its repeats: the difference over sqrt(2), because both repeats deviate
  /// equally and independently. No model that does not know the repeat has a lower error.
  double mean_absolute_rad = 0.0, rms_rad = 0.0;
  /// 95 % interval of mean_absolute_rad, by a bootstrap over conditions, because pairs of a condition share recordings.
  /// With a single condition both ends equal the value.
  double mean_absolute_low_rad = 0.0, mean_absolute_high_rad = 0.0;
};

/// (runs) => (noise floor). Readings are compared at the times of the first repeat; dropouts are left out.
NoiseFloor noise_floor(const std::vector<const BenchRun*>& runs, const OddRunOptions& options = {});

/// Standard deviation of the sensor's noise, median(|D|) / (0.6745 sqrt(924)) with the sixth differences D of the
/// readings. A smooth motion has almost none, white noise 924 times its variance; the median ignores impacts. Without
/// repeats this is a lower bound of any model's error: disturbances of the joint itself are not in it.
double sensor_noise_rad(const Recording& recording);

}  // namespace pmg::bench
