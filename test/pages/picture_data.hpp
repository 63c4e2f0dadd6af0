// Data for tests of pictures: values of real recordings, and values that recordings should not have.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pmg::pages {

struct PictureData {
  std::string name;
  std::vector<double> values;
};

inline std::vector<PictureData> picture_data() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  return {{"negative", {-3.0, -1.0, -2.5, -0.2, -1.7}},
          {"both signs", {-34.9, 12.0, 0.0, 3.3, -7.1}},
          {"constant zero", {0.0, 0.0, 0.0, 0.0, 0.0}},
          {"constant", {5.0, 5.0, 5.0, 5.0, 5.0}},
          {"negative constant", {-0.05, -0.05, -0.05, -0.05, -0.05}},
          {"nearly constant", {1.0702, 1.0709, 1.0705, 1.0711, 1.0707}},
          {"far from zero", {1000000.25, 1000000.75, 1000000.5, 1000001.5, 1000001.0}},
          {"last bits", {1.0, 1.0 + 1e-15, 1.0, 1.0 + 2e-15, 1.0}},
          {"tiny", {2.1e-9, 3.4e-9, 1.1e-9, -2.2e-9, 0.4e-9}},
          {"tinier", {2.1e-250, 3.4e-250, 1.1e-250, -2.2e-250, 0.4e-250}},
          {"huge", {1.1e12, -3.2e12, 2.4e12, 4.9e11, 1.0e12}},
          {"twenty digits", {1.1e19, -3.2e19, 2.4e19, 4.9e18, 1.0e19}},
          {"as large as is drawn", {9e298, -9e298, 3e298, 0.0, 1e298}},
          {"tiny beside huge", {1e-9, 1e9, 1.0, 2e-9, 5e8}},
          {"gaps", {kNan, 1.5, kNan, -2.0, -2.5}},
          {"infinite", {kInf, 1.5, -kInf, 2.0, std::numeric_limits<double>::max()}},
          {"nothing finite", {kNan, kInf, kNan, -kInf, kNan}},
          {"one point", {-4.2}},
          {"nothing", {}}};
}

}  // namespace pmg::pages
