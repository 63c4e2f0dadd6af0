// Pairs of shapes that an arm could bring too close within one tick.
#pragma once

#include <vector>

#include "arms/arm_chain.hpp"
#include "arms/obstacles.hpp"

namespace pmg::arms {

struct ClearanceOptions {
  double stop_m = 0.010;  ///< no step brings two shapes closer than this, or closer than they are
  double slow_m = 0.025;  ///< from here on the arm is pushed away: it slides along what is in its way
};

/// One pair: a shape of the arm, and another link's.
struct NearPair {
  std::size_t body = 0;
  const Shape* other = nullptr;
  double allowed_m = 0.0;     ///< least distance within this tick
  double distance_m = 0.0;    ///< at the posture that was looked at last
  ArmVector slope_m_per_rad;  ///< its derivative there
};

class NearPairs {
 public:
  /// neighbours: pairs that touch by design. touching(body, other) is asked once for every pair.
  /// largest_step: of each joint in one tick [rad].
  NearPairs(const ArmChain& chain, const ArmVector& largest_step_rad, std::size_t others,
            const ClearanceOptions& options);

  /// This pair is left out from now on: its links are neighbours, or touch as the robot stands.
  void leave_out(std::size_t body, std::size_t other) { left_out_[body * others_ + other] = true; }

  /// At the start of a tick, the arm where it is: (shapes of all others and their balls) => the pairs that matter.
  void collect(const ArmChain& chain, const std::vector<Shape>& others, const std::vector<Ball>& balls) noexcept;

  /// The same pairs with the arm where chain says it is. False: some pair is closer than allowed.
  bool look(const ArmChain& chain) noexcept;

  std::size_t size() const noexcept { return count_; }
  NearPair& operator[](std::size_t i) noexcept { return pairs_[i]; }
  const NearPair& operator[](std::size_t i) const noexcept { return pairs_[i]; }
  double slow_m() const noexcept { return options_.slow_m; }

 private:
  ClearanceOptions options_;
  std::size_t others_;
  std::vector<double> travel_m_;  ///< of each body in one tick, at most
  std::vector<bool> left_out_;
  std::vector<NearPair> pairs_;
  std::size_t count_ = 0;
};

}  // namespace pmg::arms
