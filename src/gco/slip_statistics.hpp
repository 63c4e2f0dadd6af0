// Foot slip of the reference over a run, before and after the optimisation: what summary.json reports as
// reference_slip.
#pragma once

#include <cstdint>
#include <vector>

#include "gco/ground_aware_command.hpp"
#include "pmg/reference.hpp"

namespace pmg::gco {

/// Speeds [m/s] of stance feet's contact points while the gait runs (standing would only dilute them), heights [m] of
/// their lowest points in every tick. Zero where there was no sample.
struct SlipSummary {
  double before_mean_m_s = 0.0;          ///< all stance feet, base moving by the user's command
  double after_mean_m_s = 0.0;           ///< the same feet, optimised
  double single_support_max_m_s = 0.0;   ///< optimised
  double double_support_mean_m_s = 0.0;  ///< optimised, both feet
  double double_support_p95_m_s = 0.0;   ///< the same, nearest rank, to 0.1 mm/s
  double lower_foot_height_max_m = 0.0;  ///< largest |height| of the lower stance foot
  double other_foot_height_max_m = 0.0;  ///< largest |height| of the higher one in double support
  std::int64_t single_support_ticks = 0, double_support_ticks = 0;  ///< while the gait runs
  std::int64_t not_converged_ticks = 0;                             ///< left out of everything above
};

/// Accumulates ticks. Support phases are those of Reference::contact.
class SlipStatistics {
 public:
  SlipStatistics();  ///< the only place that allocates

  void add(const Reference& reference, const Result& result) noexcept;
  SlipSummary summary() const noexcept;

 private:
  void add_heights(bool left, bool right, const Result& result) noexcept;
  double p95_m_s() const noexcept;

  SlipSummary extremes_;
  double before_sum_m_s_ = 0.0, after_sum_m_s_ = 0.0, double_support_sum_m_s_ = 0.0;
  std::int64_t stance_samples_ = 0, double_support_samples_ = 0;
  double double_support_max_m_s_ = 0.0;
  std::vector<std::int64_t> double_support_histogram_;  ///< the last bin takes everything faster
};

}  // namespace pmg::gco
