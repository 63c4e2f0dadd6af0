// Foot slip of the reference over a run, before and after the optimisation: reference_slip in summary.json.
#pragma once

#include <cstdint>
#include <vector>

#include "gco/ground_aware_command.hpp"
#include "pmg/reference.hpp"

namespace pmg::gco {

/// Speeds [m/s] of the stance feet's contact points, only while the gait runs, because standing would dilute them.
/// Heights [m] of their lowest points in every tick. Zero without samples.
struct SlipSummary {
  double before_mean_m_s = 0.0;          ///< all stance feet, base moving by the user's command
  double after_mean_m_s = 0.0;           ///< the same feet with the optimised command
  double single_support_max_m_s = 0.0;   ///< with the optimised command
  double double_support_mean_m_s = 0.0;  ///< with the optimised command, both feet
  double double_support_p95_m_s = 0.0;   ///< the same, nearest rank, to 0.1 mm/s
  double lower_foot_height_max_m = 0.0;  ///< largest |height| of the lower stance foot
  double other_foot_height_max_m = 0.0;  ///< largest |height| of the higher stance foot in double support
  std::int64_t single_support_ticks = 0, double_support_ticks = 0;  ///< while the gait runs
  std::int64_t not_converged_ticks = 0;                             ///< excluded from all other figures
};

/// Accumulates ticks. Support phases are those of Reference::contact.
class SlipStatistics {
 public:
  SlipStatistics();  ///< allocates; nothing else does

  void add(const Reference& reference, const Result& result) noexcept;
  SlipSummary summary() const noexcept;

 private:
  void add_heights(bool left, bool right, const Result& result) noexcept;
  double p95_m_s() const noexcept;

  SlipSummary extremes_;
  double before_sum_m_s_ = 0.0, after_sum_m_s_ = 0.0, double_support_sum_m_s_ = 0.0;
  std::int64_t stance_samples_ = 0, double_support_samples_ = 0;
  double double_support_max_m_s_ = 0.0;
  std::vector<std::int64_t> double_support_histogram_;  ///< the last bin counts all faster samples
};

}  // namespace pmg::gco
