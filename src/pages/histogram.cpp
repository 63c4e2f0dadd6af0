#include "pages/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pmg::pages {

std::int64_t Bins::total() const { return std::accumulate(counts.begin(), counts.end(), below + above + not_finite); }

void Bins::multiply(double each) {
  const auto grow = [each](std::int64_t& n) { n = std::llround(static_cast<double>(n) * each); };
  for (std::int64_t* n : {&below, &above, &not_finite}) grow(*n);
  for (std::int64_t& n : counts) grow(n);
}

Bins count(std::span<const double> values, double from, double to, int bins) {
  Bins result;
  result.from = from;
  result.width = to > from ? (to - from) / bins : 1.0;
  result.counts.resize(static_cast<std::size_t>(bins));
  for (const double value : values) {
    if (!std::isfinite(value)) {
      ++result.not_finite;
    } else if (value < from) {
      ++result.below;
    } else if (value > to) {
      ++result.above;
    } else {
      const auto bin = static_cast<std::size_t>((value - from) / result.width);
      ++result.counts[std::min(bin, result.counts.size() - 1)];
    }
  }
  return result;
}

double percentile(std::span<const double> values, double share) {
  std::vector<double> finite;
  std::ranges::copy_if(values, std::back_inserter(finite), [](double value) { return std::isfinite(value); });
  if (finite.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(finite.size())));
  const auto place = finite.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::ranges::nth_element(finite, place);
  return *place;
}

}  // namespace pmg::pages
