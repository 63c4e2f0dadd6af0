// What no model can foresee: how recordings of the same thing differ.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/bench.hpp"

namespace pmg::bench {

/// Two runs of one design (same trajectory, gains, load and commands, different repeat), by their place in the list.
struct RepeatPair {
  std::size_t first = 0, second = 0;
  double mean_absolute_rad = 0.0, mean_square_rad2 = 0.0;  ///< of the difference between the two readings
  std::size_t samples = 0;
};

struct NoiseFloor {
  std::vector<RepeatPair> pairs;  ///< every pair of every design; none where nothing was repeated
  /// Over all samples of all pairs: of the difference between two repeats. A model that is scored on one repeat and
  /// knows the other by heart misses by that.
  double difference_mean_absolute_rad = 0.0, difference_rms_rad = 0.0;
  /// Of one recording about what its repeats have in common: the differences over sqrt(2), as both repeats of a pair
  /// stray alike and independently. The lowest error of a model that doesn't know which repeat it is asked for.
  double mean_absolute_rad = 0.0, rms_rad = 0.0;
  /// 95 % interval of mean_absolute_rad: bootstrap over designs, whose pairs share recordings; equal to it for one
  /// design.
  double mean_absolute_low_rad = 0.0, mean_absolute_high_rad = 0.0;
};

/// Dropped-out samples count nowhere; readings are compared at the first repeat's times.
NoiseFloor noise_floor(const std::vector<const BenchRun*>& runs);

/// Standard deviation of the sensor's own noise: of sixth differences, in which a smooth motion leaves nothing and
/// white noise 924 times its variance; by their median, so that impacts don't count. Where nothing was repeated this is
/// the least that any model misses by; disturbances of the joint itself come on top, unseen.
double sensor_noise_rad(const Recording& recording);

}  // namespace pmg::bench
