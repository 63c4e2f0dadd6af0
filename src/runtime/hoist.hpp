// Takes a robot up with the gantry and sets it down again, smoothly.
#pragma once

#include <algorithm>

namespace pmg::runtime {

class Hoist {
 public:
  static constexpr double kLift_m = 0.20;       ///< feet well clear of the ground, toes pointing down included
  static constexpr double kTravel_s = 2.0;      ///< up or down
  static constexpr double kEngageShare = 0.25;  ///< of the travel: straps are tightened before the lift

  /// One tick towards carrying or not.
  void step(bool carry, double dt_s) {
    const double change = dt_s / kTravel_s;
    level_ = carry ? std::min(level_ + change, 1.0) : std::max(level_ - change, 0.0);
  }
  double engaged() const { return std::min(level_ / kEngageShare, 1.0); }
  double lift_m() const {
    const double t = std::max(level_ - kEngageShare, 0.0) / (1.0 - kEngageShare);
    return kLift_m * t * t * (3.0 - 2.0 * t);
  }
  bool carrying() const { return level_ > 0.0; }

 private:
  double level_ = 0.0;
};

}  // namespace pmg::runtime
