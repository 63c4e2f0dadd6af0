// What the robot's camera shows (CAMERA), for pages: the newest picture, and its age.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/clock.hpp"
#include "io/lcm_link.hpp"
#include "io/transit.hpp"
#include "pmg_msgs/camera_t.hpp"

namespace pmg::live_page {

/// For one thread. Receives only within link.receive().
class HeardCamera {
 public:
  /// Another start of the robot's camera is heard when the present one has been silent for so long.
  static constexpr std::int64_t kSilent_ns = 500'000'000;

  /// Keeps references.
  HeardCamera(io::LcmLink& link, const io::Clock& clock);
  HeardCamera(const HeardCamera&) = delete;
  HeardCamera& operator=(const HeardCamera&) = delete;
  ~HeardCamera() = default;

  /// Call in each turn: from now on the pictures of this robot count; empty: none.
  void follow(const std::string& robot);

  /// The newest picture, a JPEG file, once; nothing: there is no newer one.
  std::optional<std::string> take();

  struct Newest {
    std::int64_t number = 0;  ///< increases with each picture, whichever robot's
    double age_s = 0.0;       ///< since it came, and how much longer it travelled than the fastest
  };
  std::optional<Newest> newest() const noexcept;  ///< nothing: none of this robot has come

 private:
  void hear(io::Bytes message);
  bool newer(const pmg_msgs::camera_t& picture) const noexcept;

  const io::Clock& clock_;
  std::string robot_, waiting_;
  bool any_ = false;  // has come of this robot
  std::int64_t number_ = 0, session_ = 0, sequence_ = 0, heard_ns_ = 0, travelled_ns_ = 0;
  io::Transit transit_;
};

}  // namespace pmg::live_page
