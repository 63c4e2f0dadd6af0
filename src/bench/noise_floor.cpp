#include "bench/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "fitting/statistics.hpp"

namespace pmg::bench {

namespace {

constexpr int kResamples = 400;
constexpr unsigned kSeed = 1;

void add_interval(const std::vector<double>& differences_rad, NoiseFloor& floor) {
  std::mt19937 random(kSeed);
  std::vector<double> medians;
  for (int i = 0; i < kResamples; ++i) {
    std::vector<double> drawn;
    for (std::size_t k = 0; k < differences_rad.size(); ++k)
      drawn.push_back(differences_rad[random() % differences_rad.size()]);
    medians.push_back(fitting::median(std::move(drawn)) / std::numbers::sqrt2);
  }
  std::sort(medians.begin(), medians.end());
  floor.mean_absolute_low_rad = medians[kResamples / 40];
  floor.mean_absolute_high_rad = medians[kResamples - 1 - kResamples / 40];
}

}  // namespace

NoiseFloor noise_floor(const std::vector<const BenchRun*>& runs, const OddRunOptions& options) {
  const std::vector<Condition> all = conditions(runs);
  NoiseFloor floor;
  floor.odd_runs = odd_runs(runs, all, options);
  const auto left_out = [&](std::size_t run) {
    return std::any_of(floor.odd_runs.begin(), floor.odd_runs.end(),
                       [&](const OddRun& odd) { return odd.index == run && odd.left_out; });
  };
  std::vector<double> absolutes_rad, squares_rad2;  // of each condition
  for (const Condition& condition : all) {
    std::vector<double> of_pairs_rad, of_pairs_rad2;
    for (const RunPair& pair : condition.pairs) {
      if (pair.identical || left_out(pair.first) || left_out(pair.second)) continue;
      of_pairs_rad.push_back(pair.mean_absolute_rad);
      of_pairs_rad2.push_back(pair.mean_square_rad2);
      floor.pairs.push_back(pair);
    }
    if (of_pairs_rad.empty()) continue;
    absolutes_rad.push_back(fitting::median(std::move(of_pairs_rad)));
    squares_rad2.push_back(fitting::median(std::move(of_pairs_rad2)));
  }
  if (floor.pairs.empty()) return floor;
  floor.difference_mean_absolute_rad = fitting::median(absolutes_rad);
  floor.difference_rms_rad = std::sqrt(fitting::median(std::move(squares_rad2)));
  floor.mean_absolute_rad = floor.difference_mean_absolute_rad / std::numbers::sqrt2;
  floor.rms_rad = floor.difference_rms_rad / std::numbers::sqrt2;
  add_interval(absolutes_rad, floor);
  return floor;
}

double sensor_noise_rad(const Recording& recording) {
  constexpr double kBinomials[] = {1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0};
  constexpr double kVariance = 924.0;  // sum of the squared binomials: 2 (1 + 36 + 225) + 400
  std::vector<double> differences;
  for (std::size_t k = 0; k + std::size(kBinomials) <= recording.q_rad.size(); ++k) {
    double sum = 0.0;
    bool valid = true;
    for (std::size_t i = 0; i < std::size(kBinomials); ++i) {
      sum += kBinomials[i] * recording.q_rad[k + i];
      valid = valid && recording.valid[k + i];
    }
    if (valid && sum != 0.0)
      differences.push_back(
          std::abs(sum));  // differences of 0 come from a quantised sensor at rest, and say nothing of the noise
  }
  if (differences.empty()) return 0.0;
  return fitting::median(std::move(differences)) / fitting::kNormalMedianDeviation / std::sqrt(kVariance);
}

}  // namespace pmg::bench
