// A long recording as the few points that a picture can show, and those as compact text.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace pmg::pages {

/// Lines over the same x: y[line][point]. NaN is a gap.
struct LineData {
  std::vector<double> x;
  std::vector<std::vector<double>> y;
};

/// At most two points per column of equal width in x: of every line the smallest and the largest finite value, in the
/// order in which they came, so no peak is lost. Fewer than 2 * columns points are kept as they are. Where x jumps by
/// more than longest_gap a gap is put in; points whose x isn't finite are left out. y's lines have x.size() values; x
/// doesn't decrease (throws std::invalid_argument otherwise).
LineData decimate(std::span<const double> x, const std::vector<std::span<const double>>& y, std::size_t columns,
                  double longest_gap);

/// {"o":offset,"s":step,"v":[...]}: value k is offset + step * (sum of v up to k); null is a gap. The step is a power
/// of ten, at most the values' range over resolution.
std::string delta_json(const std::vector<double>& values, double resolution);

}  // namespace pmg::pages
