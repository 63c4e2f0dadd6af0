// Two columns of one recording against each other: factor, sign, and time between them.
#pragma once

#include <vector>

namespace pmg::data_faults {

/// y(t + lag) = offset + factor x(t), at the lag with the largest |correlation|.
struct Alignment {
  double factor = 0.0;
  double correlation = 0.0;            ///< at the lag
  double correlation_unshifted = 0.0;  ///< at lag 0
  double lag_s = 0.0;                  ///< positive: y is later than x
  bool known = false;                  ///< false where a column hardly changes or too few samples are left
};

/// Samples where x or y is NaN don't count. Lags from -before_s to after_s are tried.
Alignment align(const std::vector<double>& x, const std::vector<double>& y, double sample_s, double before_s,
                double after_s);

}  // namespace pmg::data_faults
