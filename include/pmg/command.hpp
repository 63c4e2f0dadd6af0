// The six-channel command u = [u_d, u_s] of the paper (III-A.2) and its limits.
#pragma once

#include <array>
#include <cstddef>

namespace pmg {

/// The channels of a command. The first three are u_d (velocity of the pelvis in its heading frame H), the last three
/// u_s (posture). Heights are deviations from the standing height, positive up; pitch is positive forward, roll
/// positive to the right, both of the torso link in H.
enum Channel : std::size_t { kVx = 0, kVy, kOmega, kPitch, kRoll, kHeight };
inline constexpr std::size_t kChannels = 6;
inline constexpr std::size_t kVelocityChannels = 3;
inline constexpr std::array<const char*, kChannels> kChannelNames = {"vx_m_s",    "vy_m_s",   "omega_rad_s",
                                                                     "pitch_rad", "roll_rad", "height_m"};

/// A command: vx, vy [m/s], omega [rad/s], pitch, roll [rad], height [m].
struct Command {
  std::array<double, kChannels> u{};

  double& operator[](Channel channel) { return u[channel]; }
  double operator[](Channel channel) const { return u[channel]; }
  friend bool operator==(const Command&, const Command&) = default;
};

/// What a command may be and how fast it may change.
struct CommandLimits {
  std::array<double, kChannels> lower{};       ///< same units as Command
  std::array<double, kChannels> upper{};       ///< same units as Command
  std::array<double, kChannels> rate_per_s{};  ///< largest |du/dt|
};

}  // namespace pmg
