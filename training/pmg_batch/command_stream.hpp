// Random commands as from an operator, for training.
#pragma once

#include <cstdint>
#include <random>

#include "pmg/command.hpp"

namespace pmg::training {

/// Piecewise constant commands: each channel alone, pairs, all six, postures at rest, pauses, fast changes, and from
/// time to time five seconds of jumps between the ends of the ranges. The ranges are larger than the robot's, so that
/// training covers the edges of the evaluated ranges.
class CommandStream {
 public:
  static constexpr double kRangeStretch = 1.15;

  CommandStream(const CommandLimits& limits, std::uint64_t seed) : limits_(limits), random_(seed) {}

  const Command& step(double dt_s);

 private:
  void draw();
  void jump();
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double value(std::size_t channel);

  CommandLimits limits_;
  std::mt19937_64 random_;
  Command command_;
  double left_s_ = 0.0;
  int jumps_left_ = 0;
  bool slow_ = false;
  bool postures_jump_ = false;
};

}  // namespace pmg::training
