// The generator's output of one tick.
#pragma once

#include <array>
#include <cstddef>

#include "pmg/command.hpp"
#include "pmg/types.hpp"

namespace pmg {

struct Reference {
  JointVector q;                     ///< q_ref [rad]
  JointVector dq;                    ///< dq_ref [rad/s], time derivative of q_ref as command and phase change
  double phase = 0.0;                ///< phi in [0, 1)
  double phase_rate_per_s = 0.0;     ///< d phi / dt; 0 when frozen at rest
  double gain = 0.0;                 ///< sum of the velocity gains g_i, 0 at rest, at most 1
  PerFoot<double> contact_center{};  ///< mu
  PerFoot<double> duty_factor{};     ///< r; 1 at rest
  PerFoot<bool> contact{};           ///< |wrap(phi - mu)| <= r / 2
  PerFoot<double> contact_weight{};  ///< contact with cosine edges inside the stance, in [0, 1]
  Command command;                   ///< the admissible, rate-limited command that q_ref realises
  Command command_rate;              ///< backward difference of command [unit/s]
  /// What Generator::set_correction() has added to command's velocities [m/s, m/s, rad/s]; without it command is the
  /// user's.
  std::array<double, kVelocityChannels> correction{};
  bool command_limited = false;  ///< the user's command was outside the admissible set
  bool joint_clamped = false;    ///< the last guard clamped a joint (joint_clamp.hpp)
};

/// What is taken of the user's command: Reference::command without the correction.
inline Command user_command(const Reference& reference) noexcept {
  Command command = reference.command;
  for (std::size_t c = 0; c < kVelocityChannels; ++c) command.u[c] -= reference.correction[c];
  return command;
}

}  // namespace pmg
