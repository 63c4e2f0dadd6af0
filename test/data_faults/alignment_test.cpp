#include "data_faults/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pmg::data_faults {
namespace {

std::vector<double> wave(double late_s, double size) {
  std::vector<double> found;
  for (int k = 0; k < 500; ++k) {
    const double t_s = 0.01 * k - late_s;
    found.push_back(size * (std::sin(3.0 * t_s) + 0.5 * std::sin(7.1 * t_s)));
  }
  return found;
}

TEST(Alignment, FindsFactorSignAndLag) {
  const Alignment by = align(wave(0.0, 1.0), wave(0.06, -57.3), 0.01, 0.3, 0.3);
  ASSERT_TRUE(by.known);
  EXPECT_NEAR(by.lag_s, 0.06, 1e-9);
  EXPECT_NEAR(by.factor, -57.3, 0.1);
  EXPECT_NEAR(by.correlation, -1.0, 1e-3);
  EXPECT_LT(std::abs(by.correlation_unshifted), 0.99);
}

TEST(Alignment, LeavesOutWhatIsNoNumber) {
  std::vector<double> late = wave(0.0, 2.0);
  for (std::size_t k = 0; k < late.size(); k += 3) late[k] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(align(wave(0.0, 1.0), late, 0.01, 0.1, 0.1).factor, 2.0, 1e-9);
}

TEST(Alignment, KnowsNothingOfAColumnThatRests) {
  EXPECT_FALSE(align(wave(0.0, 1.0), std::vector<double>(500, 0.3), 0.01, 0.1, 0.1).known);
}

}  // namespace
}  // namespace pmg::data_faults
