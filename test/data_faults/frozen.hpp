// Readings that are lost while somebody else has the bus.
#pragma once

#include <cmath>

#include "bench/bench.hpp"

namespace pmg::test {

/// In the last share of each period the reading before stands there.
inline void freeze(bench::BenchRun& run, double share, double period_s) {
  bench::Recording& r = run.recording;
  for (std::size_t k = 1; k < r.t_s.size(); ++k) {
    const double into = r.t_s[k] / period_s - std::floor(r.t_s[k] / period_s);
    if (into > 1.0 - share) r.q_rad[k] = r.q_rad[k - 1];
  }
}

}  // namespace pmg::test
