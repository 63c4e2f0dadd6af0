// Thresholds of a residual torque's fit.
#pragma once

#include <string_view>
#include <vector>

#include "work/threshold.hpp"

namespace pmg::residual_torque {

// docs/explanation/hidden-plants.md
inline constexpr std::string_view kPlants = "plants off the catalogue, even seeds 0 to 1100";
inline constexpr std::string_view kAssumed = "assumed; measured joints that no effect explains would settle it";
inline constexpr std::string_view kCost = "time of a diagnosis";

struct Options {
  work::Threshold bound_of_peak{
      0.5, "", "no value of a residual torque exceeds this share of the largest torque that the drive nominally gave",
      kAssumed};
  work::CountThreshold curve_knots{20, "", "knots of a residual torque over one quantity", kCost};
  work::CountThreshold map_knots{8, "", "knots of each axis of one over two quantities", kCost};
  work::CountThreshold map_modes{16, "", "smooth modes that a map is made of", kCost};
  work::Threshold least_repeating{
      0.1, "",
      "a torque over the phase of a period in time is a candidate if the period explains this share of what is missing",
      kAssumed};
  work::Threshold least_repeats{3.0, "", "and repeats so often in the longest run", kAssumed};
  work::Threshold shortest_period_s{0.125, "s", "shortest period looked for: a few samples of a slow bench", kCost};
  work::CountThreshold fitted_candidates{
      3, "", "curves and maps that rollouts are fitted with: the best by the torque that the recordings ask for",
      kCost};
  work::Threshold worth_fitting{0.5, "", "share of the best one's gain from which the next is fitted to rollouts, too",
                                kCost};
  work::CountThreshold iterations{8, "", "Gauss-Newton iterations of such a fit", kCost};
  work::Threshold least_deviations{
      1.0, "",
      "a residual torque is kept if its mean gain over blocks left out (of rms errors) is so many of its standard "
      "deviations: less than a cause needs, because it names nothing",
      kPlants};
  work::Threshold least_folds_won{0.5, "", "and if it is better in this share of the folds", kPlants};

  PMG_THRESHOLDS(bound_of_peak, curve_knots, map_knots, map_modes, least_repeating, least_repeats, shortest_period_s,
                 fitted_candidates, worth_fitting, iterations, least_deviations, least_folds_won)
};

}  // namespace pmg::residual_torque
