// From whatever mode a robot is in to Stand or Walk, once: by way of the ground when it hangs on a hoist.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/mode_wish.hpp"
#include "operator/operator_source.hpp"

namespace pmg::ops {

/// Asks for each mode once. When somebody stops the robot meanwhile, the climb has failed and asks for nothing more.
class Climb {
 public:
  /// A hoist says ten times a second what it does: one that was not heard in this time is not there.
  static constexpr std::int64_t kLook_ns = 250'000'000;

  /// Keeps a reference. to: kStand or kWalk; whoever wants Walk sends commands meanwhile. timeout_s: for each part.
  Climb(OperatorSource& source, std::string robot, Goal to, double timeout_s);

  /// To be called after every link.receive().
  Progress step();
  const std::string& text() const noexcept { return text_; }  ///< for people: what it waits for, or why it failed
  /// The source whose lease is waited for: it drove, fell silent and did not let go. Empty: none.
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

/// The hoist's state, while it is heard and carries the robot.
std::optional<pmg_msgs::hoist_state_t> carrying_hoist(const OperatorSource& source, const std::string& robot);

}  // namespace pmg::ops
