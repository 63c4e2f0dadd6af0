// Takes a robot up with the gantry and sets it down again, smoothly.
#pragma once

#include <algorithm>

namespace pmg::sil {

/// What the gantry does for a robot that nobody balances.
enum class Support {
  kNone,
  kSteady,  ///< straps keep the torso upright and in place, the legs carry all of the weight
  kLifted,  ///< feet clear of the ground
};

class Hoist {
 public:
  static constexpr double kLift_m = 0.20;       ///< feet well clear of the ground, toes pointing down included
  static constexpr double kTravel_s = 2.0;      ///< up or down
  static constexpr double kEngageShare = 0.25;  ///< of the travel: straps are tightened before the lift
  static constexpr double kSlack_m = 0.25;      ///< of the rope of a steadied robot: it may squat

  /// One tick towards this support.
  void step(Support support, double dt_s) {
    const double change = dt_s / kTravel_s;
    const double level = support == Support::kLifted ? 1.0 : support == Support::kSteady ? kEngageShare : 0.0;
    const bool slackens = support == Support::kSteady && level_ == level;
    slack_ = slackens ? std::min(slack_ + change, 1.0) : std::max(slack_ - change, 0.0);
    if (support == Support::kLifted && slack_ > 0.0) return;  // the rope tightens first
    level_ = level_ < level ? std::min(level_ + change, level) : std::max(level_ - change, level);
  }
  double engaged() const { return std::min(level_ / kEngageShare, 1.0); }
  double lift_m() const {
    const double t = std::max(level_ - kEngageShare, 0.0) / (1.0 - kEngageShare);
    return kLift_m * smooth(t) - kSlack_m * smooth(slack_);
  }
  bool carrying() const { return level_ > 0.0; }

 private:
  static double smooth(double t) { return t * t * (3.0 - 2.0 * t); }
  double level_ = 0.0, slack_ = 0.0;
};

}  // namespace pmg::sil
