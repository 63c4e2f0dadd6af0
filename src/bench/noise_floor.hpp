// Noise floor: how much recordings of the same experiment differ. No model can predict better.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::bench {

/// Two runs of one design: same trajectory, gains, load and commands, different repeat. Indices into the list of runs.
struct RepeatPair {
  std::size_t first = 0, second = 0;
  double mean_absolute_rad = 0.0, mean_square_rad2 = 0.0;  ///< of the difference of their readings
  std::size_t samples = 0;
};

struct NoiseFloor {
  std::vector<RepeatPair> pairs;  ///< every pair of every design; empty without repeats
  /// Difference of two repeats, over all samples of all pairs: the error of a model that reproduces one repeat exactly
  /// and is scored on the other.
  double difference_mean_absolute_rad = 0.0, difference_rms_rad = 0.0;
  /// Deviation of one recording from the mean of its repeats: the difference over sqrt(2), because both repeats deviate
  /// equally and independently. No model that does not know the repeat has a lower error.
  double mean_absolute_rad = 0.0, rms_rad = 0.0;
  /// 95 % interval of mean_absolute_rad, by a bootstrap over designs, because pairs of a design share recordings. With
  /// a single design both ends equal the value.
  double mean_absolute_low_rad = 0.0, mean_absolute_high_rad = 0.0;
};

/// (runs) => (noise floor). Readings are compared at the times of the first repeat; dropouts are left out.
NoiseFloor noise_floor(const std::vector<const BenchRun*>& runs);

/// Standard deviation of the sensor's noise, median(|D|) / (0.6745 sqrt(924)) with the sixth differences D of the
/// readings. A smooth motion has almost none, white noise 924 times its variance; the median ignores impacts. Without
/// repeats this is a lower bound of any model's error: disturbances of the joint itself are not in it.
double sensor_noise_rad(const Recording& recording);

}  // namespace pmg::bench
