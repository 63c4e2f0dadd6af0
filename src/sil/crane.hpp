// Works the hoist of a simulated robot. The crane holds a limp robot, sets it down once it stands, lets go when its
// feet carry it, and lifts it again on request, wherever it lies.
#pragma once

#include "hal/hoist_line.hpp"

namespace pmg::sil {

/// The crane's inputs: a person beside the robot would see or hear them.
struct CraneView {
  bool stands = false;          ///< the controller holds the standing posture, or walks; its ramp into it is over
  bool stays_up = false;        ///< somebody wants it to hang
  double carried_share = 0.0;   ///< of the robot's weight, by both feet
  double torso_height_m = 0.0;  ///< of the torso's centre of mass, above its place in the standing posture
};

/// Stands for a person with a crane, who sees the true robot. For one thread; no heap.
class Crane {
 public:
  static constexpr double kLift_m = 0.20;       ///< feet well clear of the ground, toes pointing down included
  static constexpr double kSlack_m = 0.15;      ///< of a rope that carries nothing: the robot may bend its knees
  static constexpr double kLower_m_s = 0.12;    ///< about two seconds from there to the ground
  static constexpr double kRaise_m_s = 0.20;    ///< a robot that lies is up after five seconds
  static constexpr double kCatch_s = 2.0;       ///< from loose straps to tight ones, on the way up
  static constexpr double kLetGo_s = 0.5;       ///< back
  static constexpr double kCarriedShare = 0.5;  ///< the feet carry when they have more than this
  static constexpr double kCarriedFor_s = 0.5;  ///< for so long

  void step(const CraneView& view, double dt_s) noexcept;

  hal::CraneState state() const noexcept { return state_; }
  double lift_m() const noexcept { return lift_m_; }    ///< of the anchor, as sim::World::set_hoist's
  double engaged() const noexcept { return engaged_; }  ///< likewise
  bool carrying() const noexcept { return state_ != hal::CraneState::kFree; }

 private:
  void lower(const CraneView& view, double dt_s) noexcept;

  hal::CraneState state_ = hal::CraneState::kHolding;
  double lift_m_ = kLift_m, engaged_ = 1.0;
  double carried_s_ = 0.0;
};

}  // namespace pmg::sil
