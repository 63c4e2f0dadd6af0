// Takes a robot from any mode to Stand or Walk, once. A robot on a hoist is set down first.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"

namespace pmg::ops {

/// Asks for each mode once. If another operator stops the robot meanwhile, the climb fails and asks for nothing more.
class Climb {
 public:
  /// A hoist sends its state ten times a second. After this time without one there is no hoist.
  static constexpr std::int64_t kLook_ns = 250'000'000;

  /// Only a simulated robot has a hoist, and a simulation waits for its computer: on one that was five times too slow,
  /// 8.8 of 11.2 s passed so. While the hoist works and says so, it gets this much of a part's time.
  static constexpr double kSlowSimulation = 6.0;

  /// Keeps a reference. to: kStand or kWalk; for kWalk the caller sends commands meanwhile. timeout_s: for each part.
  Climb(OperatorSource& source, std::string robot, Goal to, double timeout_s);

  /// Call after each link.receive().
  Progress step();
  const std::string& text() const noexcept {
    return text_;
  }  ///< for people: the event that it waits for, or why it failed
  /// The source whose lease must end first: it drove, fell silent and did not let go. Empty: none.
  std::string waits_for() const { return wish_ ? wish_->waits_for() : std::string(); }

 private:
  enum class Part { kLooking, kStanding, kSetDown, kLast, kFailed };

  void enter(Part part);
  Progress follow_wish();
  Progress wait_for_ground();
  Progress fail(const std::string& text);
  double in_part_s() const;

  OperatorSource& source_;
  std::string robot_;
  Goal to_;
  double timeout_s_;
  Part part_ = Part::kLooking;
  std::int64_t part_since_ns_ = 0;
  std::optional<ModeWish> wish_;
  std::string text_;
};

/// The hoist's state while it sends and carries the robot.
std::optional<pmg_msgs::hoist_state_t> carrying_hoist(const OperatorSource& source, const std::string& robot);

}  // namespace pmg::ops
