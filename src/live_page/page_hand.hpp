// One page's hand: whether a finger is on its stick, and where it pushes.
#pragma once

#include <cstdint>
#include <string>

#include "io/transit.hpp"
#include "live_page/page_message.hpp"
#include "operator/device.hpp"
#include "operator/stick_shape.hpp"

namespace pmg::live_page {

/// For one thread. A finger that was on the stick when the page came has not pressed it.
class PageHand {
 public:
  static constexpr ops::StickShape kStick = {.dead_zone = 0.15, .full_at = 1.0, .expo = 0.3};

  PageHand(std::int32_t page, std::string name) : name_(std::move(name)) { hold_.id = page; }

  /// A message that is old, repeated or late counts only as letting go.
  void take(const HandNews& news, std::int64_t now_ns) noexcept;
  ops::Hold take_hold() noexcept;  ///< a press is told once
  double forwards() const noexcept { return main_[0]; }
  double turn() const noexcept { return main_[1]; }
  double left() const noexcept { return side_; }

  const std::string& name() const noexcept { return name_; }
  bool held() const noexcept { return hold_.down; }
  bool late() const noexcept { return late_; }  ///< the newest message was
  void note(std::string text) { note_ = std::move(text); }
  const std::string& note() const noexcept { return note_; }  ///< why its last request was refused; may be empty

 private:
  std::string name_, note_;
  io::Transit transit_;
  ops::Hold hold_;
  std::array<double, 2> main_{};
  double side_ = 0.0;
  std::int64_t number_ = -1, presses_ = -1;
  bool late_ = false;
};

}  // namespace pmg::live_page
