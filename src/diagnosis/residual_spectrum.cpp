// The residual over frequency.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "diagnosis/residual.hpp"

namespace pmg::diagnosis {

namespace {

using Spectrum = std::vector<std::complex<double>>;

/// Fourier transform of one Hann window without its mean, up to half the sampling rate. Direct sums of n^2 / 2 terms
/// are fast enough: windows have a few hundred samples.
Spectrum windowed_transform(const std::vector<double>& values, std::size_t first, std::size_t count) {
  std::vector<double> window(count);
  double mean = 0.0;
  for (std::size_t k = 0; k < count; ++k) mean += values[first + k] / static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
    window[k] = (values[first + k] - mean) * 0.5 * (1.0 - std::cos(phase));
  }
  Spectrum spectrum(count / 2 + 1);
  for (std::size_t f = 0; f < spectrum.size(); ++f) {
    const std::complex<double> turn =
        std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(f) / static_cast<double>(count));
    std::complex<double> at(1.0, 0.0), sum(0.0, 0.0);
    for (const double value : window) {
      sum += value * at;
      at *= turn;
    }
    spectrum[f] = sum;
  }
  return spectrum;
}

std::vector<double> residual(const calib::SingleJoint& joint, const calib::JointModel& model) {
  const bench::Recording& r = joint.run().recording;
  std::vector<double> values = joint.rollout(model);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = r.valid[k] || k == 0 ? values[k] - r.q_rad[k] : values[k - 1];
  }
  return values;
}

}  // namespace

ResidualSpectrum residual_spectrum(const std::vector<calib::SingleJoint>& runs, const calib::JointModel& model,
                                   double window_s) {
  ResidualSpectrum found;
  if (runs.empty()) return found;
  const bench::Recording& first = runs.front().run().recording;
  const double step_s = (first.t_s.back() - first.t_s.front()) / static_cast<double>(first.t_s.size() - 1);
  const auto count = static_cast<std::size_t>(std::lround(window_s / step_s));
  if (count < 8) return found;
  const std::size_t lines = count / 2 + 1;
  std::vector<double> residual2(lines, 0.0), command2(lines, 0.0);
  Spectrum cross(lines);
  for (const calib::SingleJoint& joint : runs) {
    const std::vector<double> miss = residual(joint, model);
    for (std::size_t at = 0; at + count <= miss.size(); at += count / 2) {
      const Spectrum of_miss = windowed_transform(miss, at, count);
      const Spectrum of_command = windowed_transform(joint.run().recording.q_cmd_rad, at, count);
      for (std::size_t f = 0; f < lines; ++f) {
        residual2[f] += std::norm(of_miss[f]);
        command2[f] += std::norm(of_command[f]);
        cross[f] += std::conj(of_command[f]) * of_miss[f];
      }
      ++found.windows;
    }
  }
  if (found.windows == 0) return found;
  // The mean square of a Hann window is 3/8; the factor 2 makes the densities one-sided.
  const double scale = 2.0 * step_s / (0.375 * static_cast<double>(count) * static_cast<double>(found.windows));
  for (std::size_t f = 1; f < lines; ++f) {
    found.frequency_Hz.push_back(static_cast<double>(f) / (static_cast<double>(count) * step_s));
    found.residual_rad2_per_Hz.push_back(scale * residual2[f]);
    found.command_rad2_per_Hz.push_back(scale * command2[f]);
    const double both = residual2[f] * command2[f];
    found.coherence.push_back(both > 0.0 ? std::norm(cross[f]) / both : 0.0);
  }
  return found;
}

}  // namespace pmg::diagnosis
