// What an excited joint did, run by run, out of the ticks' records.
#pragma once

#include <vector>

#include "control/tick_record.hpp"

namespace pmg::runtime {

/// Columns of one run. q_cmd is what the drives were told from that moment on, limits included.
struct RecordedRun {
  int run = -1;  ///< of the plan
  std::vector<double> t_s, q_cmd_rad, q_rad, dq_rad_s, torque_Nm, temp_C;
};

class ExcitationRecorder {
 public:
  /// samples_of_run: how many commands each run of the plan has.
  ExcitationRecorder(int joint, std::vector<std::size_t> samples_of_run);

  void add(const control::TickRecord& record);

  /// Runs that were recorded from their first to their last sample; one that was cut off, or that has a hole (a tick is
  /// missing, the bus gave nothing new, the host stopped for more than 0.05 s), isn't among them.
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
