// The residual, simulated minus measured reading, and its dependence on velocity, position, load and frequency.
#pragma once

#include <string>
#include <vector>

#include "calib/single_joint.hpp"
#include "evidence/signature_options.hpp"
#include "evidence/verdict.hpp"

namespace pmg::diagnosis {

/// A quantity that a residual may depend on: one value per sample over all runs, NaN if unknown.
struct Circumstance {
  std::string name;  ///< velocity, position, load, drive, temperature, time since the command changed, time
  std::string unit;
  std::vector<double> values;
};

/// Valid samples of all runs, concatenated. Samples of one block (half a second of one run) are correlated: a block
/// counts as one observation.
struct ResidualSamples {
  std::vector<double> residual_rad;
  std::vector<std::size_t> run, block;  ///< of each sample; blocks are numbered over all runs
  std::size_t blocks = 0;
  std::vector<Circumstance> circumstances;  ///< those that the bench recorded
};

/// (bench, runs, model) => (samples, evenly thinned to at most `most`). Does not depend on the number of threads.
ResidualSamples residual_samples(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                                 const calib::JointModel& model, unsigned threads,
                                 const evidence::StepOptions& steps = {}, std::size_t most = 200000);

/// Mean residual over one range of a circumstance, with its 95 % interval (cluster-robust over blocks).
struct ResidualBin {
  double at = 0.0;  ///< mean of the circumstance
  evidence::Interval mean_rad;
  std::size_t samples = 0, blocks = 0;
};

/// The residual's dependence on one circumstance.
struct Dependence {
  std::string name, unit;
  std::vector<ResidualBin> bins;  ///< with equal numbers of samples
  /// Cross-validated share of the squares explained by bin means, 1 - sum (r - m)^2 / sum r^2 with the means m of the
  /// other half of the data. 0 or below if the residual does not depend on the circumstance.
  evidence::Interval explained_share;
  bool significant() const { return explained_share.low > 0.0; }
};

/// (samples) => (dependences, the strongest first). Leaves out bins with samples from fewer than three blocks.
std::vector<Dependence> dependences(const ResidualSamples& samples, std::size_t bins = 16);
/// Names of those that are significant.
std::vector<std::string> significant_dependences(const ResidualSamples& samples);

/// Power spectral densities of residual and command, and their coherence (0..1, the share of the residual that is
/// linear in the command), by Welch's method (P. D. Welch, IEEE Trans. Audio Electroacoust. 15:70, 1967) with Hann
/// windows that overlap by half.
struct ResidualSpectrum {
  std::vector<double> frequency_Hz;
  std::vector<double> residual_rad2_per_Hz, command_rad2_per_Hz;  ///< one-sided power spectral densities
  std::vector<double> coherence;
  std::size_t windows = 0;
};

/// (runs, model) => (spectrum; empty if no run is as long as a window). A dropped-out sample repeats the one before.
ResidualSpectrum residual_spectrum(const std::vector<calib::SingleJoint>& runs, const calib::JointModel& model,
                                   double window_s = 2.0);

}  // namespace pmg::diagnosis
