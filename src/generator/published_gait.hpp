// Published means of adult gait as Fourier coefficients. The forward clip is made from them.
#pragma once

#include <array>
#include <cstddef>

namespace pmg::generator {

/// A mean curve over the gait cycle [deg]; phi = 0 is initial contact of the same side:
///   mean + sum over k of cosine[k-1] cos(2 pi k phi) + sine[k-1] sin(2 pi k phi).
struct PublishedCurve {
  static constexpr std::size_t kHarmonics = 7;
  double mean_deg;
  std::array<double, kHarmonics> cosine_deg, sine_deg;

  double at_rad(double phase) const;
};

/// CGM2.3 reference set, adults at spontaneous speed: F. Leboeuf et al., "The conventional gait model, an open-source
/// implementation that reproduces the past but prepares for the future", Gait & Posture 69:235-241, 2019 (pyCGM2). We
/// fitted the coefficients to the published means. Flexion, dorsiflexion and anterior pelvic tilt are positive.
struct PublishedGait {
  PublishedCurve hip_flexion{}, knee_flexion{}, ankle_dorsiflexion{}, shoulder_flexion{}, elbow_flexion{};
  double pelvic_tilt_deg = 0.0;  ///< mean; it varies by less than a degree
  /// One standard deviation between people, RMS over the cycle.
  double hip_deviation_deg = 6.1, knee_deviation_deg = 5.1, ankle_deviation_deg = 3.8;
};
const PublishedGait& published_gait();

}  // namespace pmg::generator
