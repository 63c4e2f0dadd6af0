// Sampling and smoothing of positions.
#include "mocap/signals.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pmg::mocap {
namespace {

TEST(Signals, AreRefinedToTheWantedRateTwentyfoldAtMost) {
  EXPECT_EQ(finer_factor(30.0, 200.0), 7);
  EXPECT_EQ(finer_factor(240.0, 200.0), 1);
  EXPECT_EQ(finer_factor(0.1, 200.0), 20);
}

TEST(Signals, FinerSamplesLieOnACubicsCurve) {
  Positions parabola;
  for (int i = 0; i < 10; ++i) parabola.emplace_back(i, i * i, 0.0);
  const Positions fine = finer(parabola, 4);
  ASSERT_EQ(fine.size(), 37U);
  for (std::size_t i = 4; i < 33; ++i) {  // the ends are point reflections, which a parabola isn't
    const double t = static_cast<double>(i) / 4.0;
    EXPECT_NEAR(fine[i].x(), t, 1e-12);
    EXPECT_NEAR(fine[i].y(), t * t, 1e-12);
  }
}

TEST(Signals, SmoothingKeepsALineAndFadesNoise) {
  std::vector<double> line, wave;
  for (int i = 0; i < 200; ++i) {
    line.push_back(0.5 * i);
    wave.push_back(std::sin(2.0 * M_PI * 10.0 * i / 200.0));
  }
  const auto line_after = smoothed(line, 200.0, 0.0132), wave_after = smoothed(wave, 200.0, 0.0132);
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_NEAR(line_after[i], line[i], 1e-9);
  // -3 dB at 10 Hz: exp(-(2 pi 10 Hz sigma)^2 / 2).
  EXPECT_NEAR(wave_after[105] / wave[105], 0.709, 0.005);
}

}  // namespace
}  // namespace pmg::mocap
