// Simulated minus measured, and what it hangs together with.
#pragma once

#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "evidence/verdict.hpp"

namespace pmg::diagnosis {

/// Everything that a residual may depend on, sample by sample over all runs; NaN where it isn't known.
struct Circumstance {
  std::string name;  ///< velocity, position, load, drive, temperature, time since the command changed, time
  std::string unit;
  std::vector<double> values;
};

/// Valid samples of all runs in a row. Samples of one block (half a second of one run) hang together and count as one
/// observation.
struct ResidualSamples {
  std::vector<double> residual_rad;
  std::vector<std::size_t> run, block;  ///< of each sample; blocks are numbered over all runs
  std::size_t blocks = 0;
  std::vector<Circumstance> circumstances;  ///< those that the bench has
};

/// At most so many samples in all, evenly thinned. The same whatever the number of threads.
ResidualSamples residual_samples(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                                 const calib::JointModel& model, unsigned threads, std::size_t most = 200000);

/// Mean residual over one range of a circumstance, with its 95 % interval (cluster-robust over blocks).
struct ResidualBin {
  double at = 0.0;  ///< mean of the circumstance
  evidence::Interval mean_rad;
  std::size_t samples = 0, blocks = 0;
};

/// How the residual goes with one circumstance.
struct Dependence {
  std::string name, unit;
  std::vector<ResidualBin> bins;  ///< equally many samples each
  /// Of the residual's mean square, what bin means of the other half of the data explain: 0 or below by chance alone.
  evidence::Interval explained_share;
  bool significant() const { return explained_share.low > 0.0; }
};

/// The strongest first. Bins with samples of fewer than three blocks are left out.
std::vector<Dependence> dependences(const ResidualSamples& samples, std::size_t bins = 16);

/// Over frequency: mean amplitude of the residual, and how much of it goes linearly with the command (coherence 0..1),
/// by Welch's method (P. D. Welch, IEEE Trans. Audio Electroacoust. 15:70, 1967), Hann windows that overlap by half.
struct ResidualSpectrum {
  std::vector<double> frequency_Hz;
  std::vector<double> residual_rad2_per_Hz, command_rad2_per_Hz;  ///< one-sided power spectral densities
  std::vector<double> coherence;
  std::size_t windows = 0;
};

/// Nothing is in it where no run is as long as a window. A dropped-out sample takes the place of the one before.
ResidualSpectrum residual_spectrum(const std::vector<calib::SingleJoint>& runs, const calib::JointModel& model,
                                   double window_s = 2.0);

}  // namespace pmg::diagnosis
