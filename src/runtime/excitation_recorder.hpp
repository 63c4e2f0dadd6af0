// (records of ticks) => (the recorded runs of an excited joint).
#pragma once

#include <vector>

#include "control/tick_record.hpp"

namespace pmg::runtime {

/// Columns of one run. q_cmd is the commanded position from that moment on, limits included.
struct RecordedRun {
  int run = -1;  ///< of the plan
  std::vector<double> t_s, q_cmd_rad, q_rad, dq_rad_s, torque_Nm, temp_C;
};

class ExcitationRecorder {
 public:
  /// samples_of_run: how many commands each run of the plan has.
  ExcitationRecorder(int joint, std::vector<std::size_t> samples_of_run);

  void add(const control::TickRecord& record);

  /// Runs that were recorded from their first to their last sample without a hole. A hole is a missing tick, a tick
  /// without a new bus sample, or a pause of the host of more than 0.05 s.
  const std::vector<RecordedRun>& complete() const { return complete_; }
  const control::ExcitationProgress& progress() const { return progress_; }

 private:
  int joint_;
  std::vector<std::size_t> samples_of_run_;
  RecordedRun current_;
  std::int64_t start_ns_ = 0;
  std::vector<RecordedRun> complete_;
  control::ExcitationProgress progress_;
};

}  // namespace pmg::runtime
