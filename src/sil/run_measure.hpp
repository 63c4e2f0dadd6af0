// (tick results, ground truth) => (outcome of a simulated run), in lockstep and in real time alike.
#pragma once

#include <cstdint>
#include <vector>

#include "control/tick.hpp"
#include "gco/slip_statistics.hpp"
#include "sil/command_cut.hpp"
#include "sil/metrics.hpp"
#include "sil/scenario.hpp"
#include "sim/world.hpp"

namespace pmg::sil {

/// A run's end and its measures.
struct RunOutcome {
  double duration_s = 0.0;  ///< simulated
  double hoisted_s = 0.0;
  double hanging_s = 0.0;  ///< the feet carried nothing, so the policy was not run
  bool interrupted = false;
  bool diverged = false;  ///< the simulation blew up; the run ends there
  bool fell = false;
  double fell_at_s = -1.0;
  std::vector<faults::Fault> faults;
  TrackingSummary tracking;
  gco::SlipSummary reference_slip;
  CommandCut cut;  ///< what was asked beyond what the generator admits
};

/// The state of a run after one tick.
struct RunProgress {
  double time_s;
  double duration_s;
  const ScenarioStep& step;
  const control::TickResult& result;
};

class RunMeasure {
 public:
  explicit RunMeasure(double standing_height_m);

  /// One tick; asked: the scenario's command. Ticks on the gantry and before the first standing are not judged.
  void add(const control::TickResult& result, const model::GroundTruth& truth, bool hoisted, const Command& asked);

  /// Its two halves, for who knows no truth. Of the result the first reads mode, fault, user, reference and optimised,
  /// the second the mode.
  void add_reference(const control::TickResult& result);
  void add_truth(const control::TickResult& result, const model::GroundTruth& truth, bool hoisted,
                 const Command& asked);

  /// With everything that add() saw; interrupted and diverged are the caller's to say.
  RunOutcome outcome() const;

 private:
  Metrics metrics_;
  gco::SlipStatistics slip_;
  CommandCuts cuts_;
  double gait_period_s_;
  control::Mode last_mode_ = control::Mode::kPassive;
  std::int64_t ticks_ = 0;
  RunOutcome sums_;
};

}  // namespace pmg::sil
