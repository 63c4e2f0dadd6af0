#include "bench/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "fitting/statistics.hpp"

namespace pmg::bench {

namespace {

constexpr double kSameCommand = 1e-3;  // share of the command's range: files round
constexpr int kResamples = 400;
constexpr unsigned kSeed = 1;

using Design = std::tuple<std::string, double, double, double, double>;

Design design(const BenchRun& run) {
  return {run.trajectory, run.kp, run.kd, run.load.inertia_kg_m2, run.load.gravity_Nm};
}

/// True if two commands agree in more than two thirds of their common samples. A jump may come one sample earlier or
/// later.
bool same_command(const Recording& a, const Recording& b) {
  const std::size_t count = std::min(a.q_cmd_rad.size(), b.q_cmd_rad.size());
  const auto [low, high] = std::minmax_element(a.q_cmd_rad.begin(), a.q_cmd_rad.end());
  const double most_rad = kSameCommand * (*high - *low);
  std::size_t apart = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto near = [&](std::size_t other) { return std::abs(a.q_cmd_rad[k] - b.q_cmd_rad[other]) <= most_rad; };
    if (!near(k) && !(k > 0 && near(k - 1)) && !(k + 1 < count && near(k + 1))) ++apart;
  }
  return 3 * apart < count;  // clocks of hosts drift by a few samples; a different command differs nearly everywhere
}

RepeatPair compare(const Recording& a, const Recording& b) {
  RepeatPair pair;
  std::size_t later = 1;
  for (std::size_t k = 0; k < a.t_s.size(); ++k) {
    const double t_s = a.t_s[k] - a.t_s.front() + b.t_s.front();
    while (later + 1 < b.t_s.size() && b.t_s[later] < t_s) ++later;
    if (t_s > b.t_s.back() || !a.valid[k] || !b.valid[later] || !b.valid[later - 1]) continue;
    const double share = std::clamp((t_s - b.t_s[later - 1]) / (b.t_s[later] - b.t_s[later - 1]), 0.0, 1.0);
    const double there_rad = b.q_rad[later - 1] + share * (b.q_rad[later] - b.q_rad[later - 1]);
    const double apart_rad = a.q_rad[k] - there_rad;
    pair.mean_absolute_rad += std::abs(apart_rad);
    pair.mean_square_rad2 += apart_rad * apart_rad;
    ++pair.samples;
  }
  if (pair.samples == 0) return pair;
  pair.mean_absolute_rad /= static_cast<double>(pair.samples);
  pair.mean_square_rad2 /= static_cast<double>(pair.samples);
  return pair;
}

struct Sum {
  double absolutes = 0.0, samples = 0.0;
};

void add_interval(const std::map<Design, Sum>& designs, NoiseFloor& floor) {
  std::vector<Sum> sums;
  for (const auto& [key, sum] : designs) sums.push_back(sum);
  std::mt19937 random(kSeed);
  std::vector<double> means;
  for (int i = 0; i < kResamples; ++i) {
    Sum drawn;
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const Sum& sum = sums[random() % sums.size()];
      drawn.absolutes += sum.absolutes;
      drawn.samples += sum.samples;
    }
    means.push_back(drawn.absolutes / drawn.samples / std::numbers::sqrt2);
  }
  std::sort(means.begin(), means.end());
  floor.mean_absolute_low_rad = means[kResamples / 40];
  floor.mean_absolute_high_rad = means[kResamples - 1 - kResamples / 40];
}

}  // namespace

NoiseFloor noise_floor(const std::vector<const BenchRun*>& runs) {
  std::map<Design, std::vector<std::size_t>> designs;
  for (std::size_t i = 0; i < runs.size(); ++i) designs[design(*runs[i])].push_back(i);
  NoiseFloor floor;
  std::map<Design, Sum> sums;
  double absolutes = 0.0, squares = 0.0, samples = 0.0;
  for (const auto& [key, members] : designs) {
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (std::size_t j = i + 1; j < members.size(); ++j) {
        const BenchRun &a = *runs[members[i]], &b = *runs[members[j]];
        if (a.repeat == b.repeat || !same_command(a.recording, b.recording)) continue;
        RepeatPair pair = compare(a.recording, b.recording);
        if (pair.samples == 0) continue;
        pair.first = members[i];
        pair.second = members[j];
        const auto count = static_cast<double>(pair.samples);
        absolutes += count * pair.mean_absolute_rad;
        squares += count * pair.mean_square_rad2;
        samples += count;
        sums[key].absolutes += count * pair.mean_absolute_rad;
        sums[key].samples += count;
        floor.pairs.push_back(pair);
      }
    }
  }
  if (floor.pairs.empty()) return floor;
  floor.difference_mean_absolute_rad = absolutes / samples;
  floor.difference_rms_rad = std::sqrt(squares / samples);
  floor.mean_absolute_rad = floor.difference_mean_absolute_rad / std::numbers::sqrt2;
  floor.rms_rad = floor.difference_rms_rad / std::numbers::sqrt2;
  add_interval(sums, floor);
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
