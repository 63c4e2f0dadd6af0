// A logged run measured again by the measure of a live run (sil/run_measure.hpp), so that the report's errors and slip
// equal those of summary.json.
#pragma once

#include <map>
#include <string>

#include "pmg_msgs/command_t.hpp"
#include "pmg_msgs/ground_truth_t.hpp"
#include "pmg_msgs/reference_t.hpp"
#include "pmg_msgs/status_t.hpp"
#include "sil/run_measure.hpp"

namespace pmg::report {

class RunJudgement {
 public:
  explicit RunJudgement(double standing_height_m);

  // (messages of a tick, in the log's order) => one tick of the measure; STATUS ends the tick, GROUND_TRUTH follows it.
  void command(const pmg_msgs::command_t& message);
  void reference(const pmg_msgs::reference_t& message);
  void status(const pmg_msgs::status_t& message);
  void truth(const pmg_msgs::ground_truth_t& message);

  /// The outcome of the ticks so far. Without GROUND_TRUTH followed_s is 0; without REFERENCE the slip is 0.
  sil::RunOutcome outcome() const { return measure_.outcome(); }

 private:
  /// The driving source's command; in a fault that of the last driving source; zero without a source.
  Command asked() const;

  sil::RunMeasure measure_;
  control::TickResult tick_;  ///< only the parts that the measure reads
  std::int64_t reference_ns_ = -1;
  std::string driving_, last_driving_;
  std::map<std::string, Command> commands_;  ///< newest command of each source
  bool has_status_ = false;
};

/// Mean errors between two sums of one run; foot_slip_mean_m_s stays 0.
sil::TrackingSummary errors_between(const sil::TrackingSummary& before, const sil::TrackingSummary& after);

}  // namespace pmg::report
