#include "generator/published_gait.hpp"

#include <cmath>
#include <numbers>

#include "pmg/types.hpp"

namespace pmg::generator {

double PublishedCurve::at_rad(double phase) const {
  double value_deg = mean_deg;
  for (std::size_t k = 0; k < kHarmonics; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k + 1) * phase;
    value_deg += cosine_deg[k] * std::cos(angle) + sine_deg[k] * std::sin(angle);
  }
  return value_deg * kRadPerDegree;
}

const PublishedGait& published_gait() {
  static const PublishedGait gait{.hip_flexion = {20.16,
                                                  {19.18, -3.22, -0.45, -0.18, -0.17, 0.11, 0.04},
                                                  {-4.89, -0.17, 2.04, -0.06, 0.37, 0.08, 0.09}},
                                  .knee_flexion = {26.09,
                                                   {-4.56, -13.76, -0.94, -0.81, -0.18, 0.39, 0.14},
                                                   {-19.94, 8.65, 5.30, 1.02, 1.26, 0.35, 0.23}},
                                  .ankle_dorsiflexion = {3.57,
                                                         {-1.71, 0.75, -3.78, 1.83, -0.61, 0.64, 0.51},
                                                         {5.47, -6.26, 0.87, -0.33, -1.00, 0.52, -0.61}},
                                  .shoulder_flexion = {-9.32,
                                                       {-14.40, 0.19, -0.53, 0.34, -0.15, 0.02, 0.02},
                                                       {-0.31, -1.32, 0.48, -0.22, 0.02, 0.05, -0.02}},
                                  .elbow_flexion = {36.22,
                                                    {-12.16, 2.46, 0.08, -0.21, 0.12, 0.05, -0.01},
                                                    {-1.79, 0.27, -0.67, 0.09, -0.04, 0.01, 0.02}},
                                  .pelvic_tilt_deg = 11.4};
  return gait;
}

}  // namespace pmg::generator
