// From the posture that was measured when a mode was entered to the posture that the mode wants.
#pragma once

#include "pmg/types.hpp"

namespace pmg::control {

struct EntryRampOptions {
  double speed_rad_s = 0.5;  ///< mean speed of the joint that has farthest to go
  double shortest_s = 0.5;
  double longest_s = 5.0;
};

class EntryRamp {
 public:
  explicit EntryRamp(const EntryRampOptions& options) : options_(options) {}

  void start(const JointVector& measured_rad, const JointVector& wanted_rad) noexcept;
  /// Moves q_des towards the measured posture by what is left of the ramp, and the ramp on by dt_s.
  void apply(double dt_s, JointVector& q_des) noexcept;
  void finish() noexcept { elapsed_s_ = duration_s_; }  ///< the rest of the way at once
  bool done() const noexcept { return elapsed_s_ >= duration_s_; }
  double duration_s() const noexcept { return duration_s_; }

 private:
  EntryRampOptions options_;
  JointVector from_;
  double elapsed_s_ = 0.0, duration_s_ = 0.0;
};

}  // namespace pmg::control
