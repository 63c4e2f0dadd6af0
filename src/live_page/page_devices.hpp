// What pages hold in their hands, as one device: fingers on sticks, and one headset.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "arms_operator/arms_board.hpp"
#include "live_page/page_hands.hpp"
#include "operator/joined_devices.hpp"
#include "vr/vr_command.hpp"

namespace pmg::live_page {

/// For one thread. One headset at a time: the first whose page tells poses, until that page is gone.
class PageDevices {
 public:
  PageDevices();
  PageDevices(const PageDevices&) = delete;
  PageDevices& operator=(const PageDevices&) = delete;
  ~PageDevices() = default;

  /// The pages that are open. Call in each turn, before take().
  void look(std::span<const web::Page> open, std::int64_t now_ns);
  void take(const web::Said& said, std::int64_t now_ns);
  /// What the robot says of its arms; null: nothing.
  void learn(const ops::HeardArms* arms) { headset_.learn(arms); }
  void set_robot_span(double span_m) noexcept { headset_.set_robot_span(span_m); }

  ops::Device& device() noexcept { return joined_; }
  const PageHands& hands() const noexcept { return hands_; }
  bool drives(std::int32_t page) const noexcept;
  /// Why nothing that this page holds drives; empty: it does, or it holds nothing.
  std::string note(const web::Page& page) const;

 private:
  static constexpr std::int32_t kHeadset = -1;  // its hold; pages count from 1

  PageHands hands_;
  vr::VrCommand headset_{kHeadset};
  ops::JoinedDevices joined_;
  web::Page headset_page_{};  // id 0: none
};

}  // namespace pmg::live_page
