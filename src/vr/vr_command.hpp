// The mapping of a headset: head and controllers => a command and the palms' wishes. Grip to drive, trigger to lead an
// arm.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "arms_operator/arms_board.hpp"
#include "io/transit.hpp"
#include "operator/device.hpp"
#include "vr/head_motion.hpp"
#include "vr/palm_lead.hpp"

namespace pmg::vr {

/// For one headset at a time, and for one thread. Whatever is lost or unsure holds: the velocity goes to zero, posture
/// and palms stay. Nothing jumps, and nothing goes back by itself.
///
/// - Squeezing a grip with the head near its centre drives; posture is counted from there, on top of the one that is
/// held.
/// - Late messages count only as what they end, old and repeated ones as nothing. A page without the eyes, a head that
/// isn't
///   tracked or that jumps, and a new centre end the drive.
class VrCommand : public ops::Device {
 public:
  static constexpr double kHeadJump_m = 0.10,
                          kHeadFastest_m_s = 4.0;  ///< largest step: kHeadJump_m + kHeadFastest_m_s dt
  static constexpr double kShortestSpan_m = 0.8, kLongestSpan_m = 2.4;  ///< of people's arms
  static constexpr double kSmallestScale = 0.3, kLargestScale = 1.5;

  /// id: of its hold, another one than other devices' of the same program.
  explicit VrCommand(std::int32_t id) { hold_.id = id; }

  /// From palm to palm with arms stretched sideways [m]; 0: not known, and the scale stays 1.
  void set_robot_span(double span_m) noexcept { robot_span_m_ = span_m; }

  /// A headset has come, or another one: nothing that was is known of it.
  void begin(std::int64_t now_ns);
  void end(std::int64_t now_ns);  ///< it is gone
  bool present() const noexcept { return present_; }
  void take(const VrNews& news, std::int64_t now_ns);
  /// What the robot says of its arms; null: nothing.
  void learn(const ops::HeardArms* arms);

  ops::DeviceManner manner() const override;
  void set_limits(const CommandLimits& limits) noexcept override { limits_ = limits; }
  std::span<const ops::Hold> holds(std::int64_t now_ns) noexcept override;
  Command command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept override;
  ops::Requests take_requests() noexcept override { return {}; }  // its page asks as every page does
  const PerFoot<ops::PalmWish>* palms() const noexcept override { return led_ ? &wishes_ : nullptr; }
  void rest() noexcept override;
  void upright() noexcept override;

  bool driving() const noexcept { return driving_; }
  double scale() const noexcept { return scale_; }
  const std::string& note() const noexcept { return note_; }  ///< why it doesn't drive; empty: nothing is wrong

 private:
  bool take_buttons(const VrNews& news);
  void take_head(const VrNews& news, bool recentre, std::int64_t now_ns);
  void take_hands(const VrNews& news, std::int64_t now_ns);
  void measure_span(const VrNews& news);
  void take_late(const VrNews& news);
  void lose(const char* why, std::int64_t now_ns);
  void hold_palms();

  struct Seen {  // counts of the newest message; -1: none came
    std::int64_t number = -1, presses = -1, recentres = -1, spans = -1, uprights = -1;
  };

  double robot_span_m_ = 0.0, scale_ = 1.0;
  CommandLimits limits_;  // zero until they are known: then every command is zero
  bool present_ = false, driving_ = false, led_ = false, steady_ = false, loss_told_ = true;
  io::Transit transit_;
  Seen seen_;
  std::optional<Centre> centre_;
  std::optional<Pose> head_;
  std::int64_t head_ns_ = 0, now_ns_ = 0;
  HeadAsks asks_{};
  ops::Hold hold_{}, shown_{};
  std::array<double, kChannels> posture_{}, base_{};  // what is commanded; what it was when the grip was squeezed
  PerFoot<PalmLead> leads_;
  PerFoot<std::optional<PalmLead::Palm>> robot_palms_;
  PerFoot<ops::PalmWish> wishes_;
  std::string note_;
};

}  // namespace pmg::vr
