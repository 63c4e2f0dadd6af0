// (what a device holds) => whether the robot may move: the deadman's rule, one for all devices.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>

#include "operator/device.hpp"

namespace pmg::ops {

/// Driving is armed by a press that was seen to begin while what it drives by was neutral, and by nothing else. It ends
/// when the hold is let go, is lost or is gone, when the device or this program paused, and by disarm(). One hold
/// drives at a time. A press while another one drives doesn't count later.
class HoldToDrive {
 public:
  static constexpr std::int64_t kDeaf_ns =
      300'000'000;  ///< a device or a program that paused so long must not drive on

  /// Call at least every 10 ms, with every hold.
  void step(std::span<const Hold> holds, std::int64_t now_ns);
  /// Also: presses that the next step tells of were before this, and don't count.
  void disarm() noexcept;

  std::optional<std::int32_t> armed() const noexcept { return armed_; }
  bool pressed() const noexcept { return pressed_; }  ///< a press counted in this step, also one that is over already
  /// The hold is down, but was not neutral when it was pressed.
  bool refused(std::int32_t id) const noexcept { return refused_.contains(id); }

 private:
  bool counts(const Hold& hold, std::int64_t now_ns) const noexcept;

  std::optional<std::int32_t> armed_;
  std::set<std::int32_t> refused_;
  std::int64_t stepped_ns_ = -1;
  bool pressed_ = false, forget_presses_ = false;
};

}  // namespace pmg::ops
