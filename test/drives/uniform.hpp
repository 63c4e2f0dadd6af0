// Numbers for random tests, the same on every system.
#pragma once

#include <random>

namespace pmg::test {

inline double uniform(std::mt19937_64& random, double lower, double upper) {
  return lower + (upper - lower) * static_cast<double>(random() >> 11) * 0x1p-53;
}

}  // namespace pmg::test
