// A smooth way from the posture measured at a mode's start to the posture that the mode commands.
#pragma once

#include "pmg/types.hpp"

namespace pmg::control {

struct EntryRampOptions {
  double speed_rad_s = 0.5;  ///< mean speed of the joint with the longest way
  double shortest_s = 0.5;
  double longest_s = 5.0;
};

class EntryRamp {
 public:
  explicit EntryRamp(const EntryRampOptions& options) : options_(options) {}

  void start(const JointVector& measured_rad, const JointVector& wanted_rad) noexcept;
  /// (q_des) => (q_des on the ramp), and the ramp goes on by dt_s:
  /// q = q_measured + s (q_des - q_measured), s = t^2 (3 - 2 t), t = elapsed / duration [rad].
  /// The duration is the longest way over speed_rad_s, between shortest_s and longest_s.
  void apply(double dt_s, JointVector& q_des) noexcept;
  void finish() noexcept { elapsed_s_ = duration_s_; }  ///< skips the rest of the ramp
  bool done() const noexcept { return elapsed_s_ >= duration_s_; }
  double duration_s() const noexcept { return duration_s_; }

 private:
  EntryRampOptions options_;
  JointVector from_;
  double elapsed_s_ = 0.0, duration_s_ = 0.0;
};

}  // namespace pmg::control
