// The six-channel command u = [u_d, u_s] of the paper (III-A.2) and its limits.
#pragma once

#include <array>
#include <cstddef>

namespace pmg {

/// The channels of a command. The first three are u_d, the velocity of the pelvis in its heading frame H. The last
/// three are u_s, the posture. Height is the deviation from the standing height, positive up. Pitch is positive
/// forward, roll positive to the right; both are the torso link's in H.
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

/// Range and largest rate of change of each channel.
struct CommandLimits {
  std::array<double, kChannels> lower{};       ///< same units as Command
  std::array<double, kChannels> upper{};       ///< same units as Command
  std::array<double, kChannels> rate_per_s{};  ///< largest |du/dt| [unit/s]
};

}  // namespace pmg
