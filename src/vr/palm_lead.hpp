// One controller leads one palm: relative to where both were when the trigger was pulled, so nothing jumps.
#pragma once

#include <cstdint>
#include <optional>

#include "operator/arms_source.hpp"
#include "vr/vr_news.hpp"

namespace pmg::vr {

/// While it leads, with the controller's pose (c, R_c) relative to the head in the centre's heading frame, and the
/// palm's (p, R_p) in the robot's torso frame, each with 0 where the lead began:
///   p = p_0 + scale (c - c_0),  R_p = (R_c R_c0^T) R_p0.
/// A lead begins with a press of the trigger that was seen, once the palm's place is known, and ends for good with the
/// trigger, a lost controller, or a controller that jumps. Then the palm stays where it is.
class PalmLead {
 public:
  static constexpr double kJump_m = 0.10, kFastest_m_s = 6.0;  ///< a hand's largest step: kJump_m + kFastest_m_s dt
  static constexpr double kTwist_rad = 0.5, kFastest_rad_s = 20.0;  ///< likewise
  static constexpr double kFarthest_m = 2.0;                        ///< from where the lead began
  static constexpr std::int64_t kSettle_ns = 200'000'000;  ///< after an end the palm's place is believed only then

  struct Palm {
    Pose pose{};                ///< in the torso frame
    std::int64_t heard_ns = 0;  ///< when it was told
  };

  /// hand: this controller's, of a message that counts. relative: its pose relative to the head; nothing: either isn't
  /// tracked. may_lead: the robot is driven by this headset. palm: the robot's newest word; nothing: none.
  void take(const HandNews& hand, const std::optional<Pose>& relative, bool may_lead, const std::optional<Palm>& palm,
            double scale, std::int64_t now_ns) noexcept;
  /// Ends a lead: the palm stays. A trigger that is still pulled doesn't count again.
  void hold(std::int64_t now_ns) noexcept;

  bool leads() const noexcept { return start_.has_value(); }
  const ops::PalmWish& wish() const noexcept { return wish_; }

 private:
  struct Start {
    Pose hand, palm;
  };

  bool jumped(const Pose& relative, std::int64_t now_ns) const noexcept;

  ops::PalmWish wish_{};
  std::optional<Start> start_;
  std::optional<Pose> before_;
  std::int64_t before_ns_ = 0, ended_ns_ = 0, presses_ = -1, hand_backs_ = -1;
  bool pulled_ = false;  // freshly, and not yet used up
};

}  // namespace pmg::vr
