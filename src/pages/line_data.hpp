// (a long recording) => the few points that a picture can show => compact text.
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

/// At most two points for each column of equal width in x: each line's smallest and largest finite value in their order
/// of time, so that no peak is lost. Fewer than 2 * columns points stay as they are. A jump of x beyond longest_gap
/// becomes a gap; points with an x that isn't finite are left out. Each line of y has x.size() values and x does not
/// decrease, else std::invalid_argument.
LineData decimate(std::span<const double> x, const std::vector<std::span<const double>>& y, std::size_t columns,
                  double longest_gap);

/// {"o":offset,"s":step,"v":[...]}: value k is offset + step * (sum of v up to k); null is a gap. The step is a power
/// of ten, at most the values' range over resolution.
std::string delta_json(const std::vector<double>& values, double resolution);

}  // namespace pmg::pages
