// The clock as an argument: the wall clock on the robot, the simulation's clock in lockstep.
#pragma once

#include <chrono>
#include <cstdint>

namespace pmg::io {

/// Truncated towards zero.
constexpr std::int64_t nanoseconds(double seconds) noexcept { return static_cast<std::int64_t>(seconds * 1e9); }

class Clock {
 public:
  virtual ~Clock() = default;
  /// Nanoseconds since an arbitrary start, never decreasing.
  virtual std::int64_t now_ns() const noexcept = 0;
};

class WallClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
};

/// The simulation's clock. It moves only by advance_to().
class SimulationClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void advance_to(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }

 private:
  std::int64_t now_ns_ = 0;
};

/// Time since its construction.
class Lap {
 public:
  explicit Lap(const Clock& stopwatch) noexcept : stopwatch_(stopwatch), start_ns_(stopwatch.now_ns()) {}
  std::int64_t elapsed_ns() const noexcept { return stopwatch_.now_ns() - start_ns_; }

 private:
  const Clock& stopwatch_;
  std::int64_t start_ns_;
};

}  // namespace pmg::io
