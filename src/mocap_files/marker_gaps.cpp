#include "mocap_files/marker_gaps.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pmg::mocap {

void fill_gaps(std::vector<Eigen::Vector3d>& positions, const std::string& name, double rate_hz,
               std::vector<std::string>& notes) {
  std::size_t missing = 0, longest = 0;
  const std::size_t frames = positions.size();
  for (std::size_t f = 0; f < frames;) {
    if (positions[f].allFinite()) {
      ++f;
      continue;
    }
    std::size_t stop = f;
    while (stop < frames && !positions[stop].allFinite()) ++stop;
    missing += stop - f;
    longest = std::max(longest, stop - f);
    for (std::size_t i = f; i < stop; ++i) {
      if (f == 0) {
        positions[i] = positions[stop];
      } else if (stop == frames) {
        positions[i] = positions[f - 1];
      } else {
        const double share = static_cast<double>(i - f + 1) / static_cast<double>(stop - f + 1);
        positions[i] = (1.0 - share) * positions[f - 1] + share * positions[stop];
      }
    }
    f = stop;
  }
  if (missing > 0) {
    notes.push_back(fmt::format("{} was not seen in {} of {} frames, {:.2f} s at a time: bridged", name, missing,
                                frames, static_cast<double>(longest) / rate_hz));
  }
}

}  // namespace pmg::mocap
