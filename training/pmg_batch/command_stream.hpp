// What an operator might ask for, drawn at random: the commands that a policy is trained on.
#pragma once

#include <cstdint>
#include <random>

#include "pmg/command.hpp"

namespace pmg::training {

/// Piecewise constant commands: every channel alone, pairs, all six, standing in postures, pauses, hasty changes, and
/// now and then five seconds of jumps between the ends of the ranges.
/// Ranges are stretched, so that the edges of what is evaluated lie inside what was trained.
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
};

}  // namespace pmg::training
