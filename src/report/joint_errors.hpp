// (states and references of ticks) => how well each joint followed.
#pragma once

#include <cstdint>
#include <vector>

#include "report/run_series.hpp"

namespace pmg::report {

class JointErrors {
 public:
  void state(double t_s, const std::vector<double>& q_rad, const std::vector<double>& torque_Nm);
  void reference(double t_s, const std::vector<double>& q_ref_rad);
  void status(bool holds);  ///< holds: the drives follow the reference (stand or walk). Ends a tick

  /// One for each joint. If the log has no status, the drives count as following all the time.
  std::vector<JointTracking> finish(std::size_t joints);

 private:
  void end_tick();

  std::vector<double> q_rad_, q_ref_rad_, square_sum_, torque_max_Nm_;
  std::vector<std::int64_t> ticks_;
  double state_s_ = -1.0, reference_s_ = -2.0;  ///< of the newest; equal: of one tick
  bool holds_ = true, has_status_ = false;
};

}  // namespace pmg::report
