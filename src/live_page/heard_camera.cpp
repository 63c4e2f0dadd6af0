#include "live_page/heard_camera.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace pmg::live_page {

namespace {

/// A JPEG file of an allowed size, by its first and last bytes; a browser judges the rest.
bool is_picture(const pmg_msgs::camera_t& message) {
  constexpr std::array<std::uint8_t, 3> kBegin = {0xff, 0xd8, 0xff};
  constexpr std::array<std::uint8_t, 2> kEnd = {0xff, 0xd9};
  const auto& jpeg = message.jpeg;
  return jpeg.size() > kBegin.size() + kEnd.size() &&
         jpeg.size() <= static_cast<std::size_t>(pmg_msgs::camera_t::MOST_BYTES) &&
         std::equal(kBegin.begin(), kBegin.end(), jpeg.begin()) &&
         std::equal(kEnd.rbegin(), kEnd.rend(), jpeg.rbegin());
}

}  // namespace

HeardCamera::HeardCamera(io::LcmLink& link, const io::Clock& clock) : clock_(clock) {
  link.subscribe("CAMERA", [this](io::Bytes message) { hear(message); });
}

void HeardCamera::follow(const std::string& robot) {
  if (robot == robot_) return;
  robot_ = robot;
  waiting_.clear();
  any_ = false;
}

std::optional<std::string> HeardCamera::take() {
  if (waiting_.empty()) return std::nullopt;
  return std::exchange(waiting_, {});
}

std::optional<HeardCamera::Newest> HeardCamera::newest() const noexcept {
  if (!any_) return std::nullopt;
  return Newest{.number = number_, .age_s = static_cast<double>(clock_.now_ns() - heard_ns_ + travelled_ns_) * 1e-9};
}

bool HeardCamera::newer(const pmg_msgs::camera_t& picture) const noexcept {
  if (!any_) return true;
  if (picture.session == session_) return picture.sequence > sequence_;
  return clock_.now_ns() - heard_ns_ > kSilent_ns;
}

void HeardCamera::hear(io::Bytes bytes) {
  if (robot_.empty()) return;
  const auto picture = io::decode_message<pmg_msgs::camera_t>(bytes);
  if (!picture || picture->robot != robot_ || !is_picture(*picture) || !newer(*picture)) return;
  if (!any_ || picture->session != session_) transit_ = {};
  any_ = true;
  session_ = picture->session;
  sequence_ = picture->sequence;
  heard_ns_ = clock_.now_ns();
  travelled_ns_ = transit_.take(picture->stamp_ns, heard_ns_);
  ++number_;
  waiting_.assign(picture->jpeg.begin(), picture->jpeg.end());
}

}  // namespace pmg::live_page
