// Checks on raw readings: step onset, steady-state error, quantisation.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "bench/noise_floor.hpp"
#include "evidence/motion.hpp"
#include "evidence/signature_checks.hpp"
#include "fitting/statistics.hpp"

namespace pmg::evidence {

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr Interval kUnknown{kNoNumber, kNoNumber, kNoNumber};
constexpr double kSameReading_rad = 1e-7;  // readings that differ by less differ by rounding

/// Median with its 95 % interval: the values at ranks n / 2 +- 1.96 sqrt(n) / 2 (normal approximation of the binomial).
Interval median_interval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const double reach = 0.98 * std::sqrt(n);
  const auto rank = [&](double place) { return values[static_cast<std::size_t>(std::clamp(place, 0.0, n - 1.0))]; };
  return {fitting::median(values), rank(std::floor(0.5 * n - reach)), rank(std::ceil(0.5 * n + reach))};
}

/// Time from the step at this sample to the onset of motion; empty if the joint was not at rest or hardly moves. With
/// constant acceleration from rest, sqrt(q - q_rest) is proportional to t - t_onset: t_onset is the root of a fitted
/// line.
std::optional<double> onset_s(const bench::Recording& r, std::size_t step, double noise_rad,
                              const OnsetOptions& options) {
  const double size_rad = std::abs(r.q_cmd_rad[step] - r.q_cmd_rad[step - 1]);
  std::size_t before = step;
  while (before > 0 && r.t_s[step] - r.t_s[before - 1] < options.rest_s) --before;
  // Where samples are missing, half of the time at rest suffices.
  if (static_cast<double>(step - before) < options.fewest_rest_samples ||
      r.t_s[step] - r.t_s[before] < 0.5 * options.rest_s)
    return std::nullopt;
  double rest_rad = 0.0;
  for (std::size_t k = before; k < step; ++k) rest_rad += r.q_rad[k] / static_cast<double>(step - before);
  const double first_rad = std::max(options.first_of_noise * noise_rad, options.first_of_step * size_rad);
  for (std::size_t k = before; k < step; ++k) {
    if (!r.valid[k] ||
        std::abs(r.q_rad[k] - rest_rad) > std::max(options.rest_of_noise * noise_rad, options.rest_of_way * first_rad))
      return std::nullopt;
    if (k > before && r.q_cmd_rad[k] != r.q_cmd_rad[k - 1]) return std::nullopt;
  }
  const double sign = r.q_cmd_rad[step] > r.q_cmd_rad[step - 1] ? 1.0 : -1.0;
  double n = 0.0, t = 0.0, y = 0.0, tt = 0.0, ty = 0.0;
  for (std::size_t k = step; k < r.t_s.size() && r.q_cmd_rad[k] == r.q_cmd_rad[step]; ++k) {
    const double way_rad = sign * (r.q_rad[k] - rest_rad), after_s = r.t_s[k] - r.t_s[step];
    if (after_s > options.longest_s || !r.valid[k] || (!r.enabled.empty() && !r.enabled[k])) return std::nullopt;
    if (way_rad < first_rad) continue;
    if (way_rad > options.last_of_step * size_rad && n >= 2.0) break;
    const double root = std::sqrt(way_rad);
    n += 1.0;
    t += after_s;
    y += root;
    tt += after_s * after_s;
    ty += after_s * root;
    if (way_rad > options.last_of_step * size_rad && n >= 2.0) break;
  }
  const double bend = n * tt - t * t;
  if (n < 2.0 || !(bend > 0.0)) return std::nullopt;
  const double slope = (n * ty - t * y) / bend;
  if (!(slope > 0.0)) return std::nullopt;
  return (t - y / slope) / n;
}

/// One place where a run came to rest.
struct Rest {
  double kp, short_by_rad;  ///< steady-state error without the load's share: command - reading - G sin(q) / kp
};

/// Adds a rest for each stretch of constant command with readings constant over its last stood_s. Four fifths of that
/// time suffice where samples are missing.
void add_rests(const bench::Bench& bench, const bench::BenchRun& run, const RestOptions& options,
               std::vector<Rest>& rests) {
  const bench::Recording& r = run.recording;
  const double noise_rad = bench::sensor_noise_rad(r), kp = bench.known.drive.kp_scale * run.kp;
  std::size_t from = 0;
  for (std::size_t k = 1; k <= r.t_s.size(); ++k) {
    const bool ends = k == r.t_s.size() || r.q_cmd_rad[k] != r.q_cmd_rad[from];
    if (!ends) continue;
    std::size_t first = k - 1;
    while (first > from && r.t_s[k - 1] - r.t_s[first - 1] <= options.stood_s) --first;
    double mean_rad = 0.0, low_rad = r.q_rad[first], high_rad = low_rad;
    bool on = r.t_s[k - 1] - r.t_s[first] > 0.8 * options.stood_s && from > 0;
    for (std::size_t i = first; i < k; ++i) {
      mean_rad += r.q_rad[i] / static_cast<double>(k - first);
      low_rad = std::min(low_rad, r.q_rad[i]);
      high_rad = std::max(high_rad, r.q_rad[i]);
      on = on && r.valid[i] && (r.enabled.empty() || r.enabled[i]) && (r.tau_ff_Nm.empty() || r.tau_ff_Nm[i] == 0.0);
    }
    if (on && high_rad - low_rad <= std::max<double>(options.range_of_noise * noise_rad, options.range_rad)) {
      const double held_rad = run.load.gravity_Nm * std::sin(mean_rad) / kp;
      rests.push_back({kp, r.q_cmd_rad[from] - mean_rad - held_rad});
    }
    from = k;
  }
}

}  // namespace

Signature step_onset_check(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                           const SignatureOptions& options) {
  Signature s{"delay", "step onset", Agreement::kCannotTell, kUnknown, "s", "no steps from rest were recorded"};
  std::vector<double> onsets_s;
  for (const bench::BenchRun& run : runs) {
    const double noise_rad = bench::sensor_noise_rad(run.recording);
    for (const std::size_t step : command_steps(run.recording, options.step)) {
      if (const auto onset = onset_s(run.recording, step, noise_rad, options.onset)) onsets_s.push_back(*onset);
    }
  }
  if (static_cast<double>(onsets_s.size()) < options.onset.fewest_steps) return s;
  s.value = median_interval(onsets_s);
  const double unsure_s =
      std::max<double>(options.onset.least_delay_s, options.onset.least_delay_samples / bench.sample_rate_hz);
  if (s.value.low > unsure_s) {
    s.agreement = Agreement::kAgrees;
  } else if (s.value.high < unsure_s) {
    s.agreement = Agreement::kDisagrees;
  }
  s.sentence = fmt::format(
      "after {} steps from rest the joint sets off {:.1f} ms late ({:.1f} to {:.1f}); up to {:.1f} ms "
      "is how the command is held",
      onsets_s.size(), 1e3 * s.value.value, 1e3 * s.value.low, 1e3 * s.value.high, 1e3 * unsure_s);
  return s;
}

/// Fits |short_by| = a + b / kp: dead band a [rad], Coulomb friction b [Nm]. Deviations are heteroscedasticity-robust:
/// the rests are approached from different directions and distances.
std::vector<Signature> rest_checks(const bench::Bench& bench, const std::vector<bench::BenchRun>& runs,
                                   const SignatureOptions& options) {
  Signature band{"dead_band",
                 "rest against gain",
                 Agreement::kCannotTell,
                 kUnknown,
                 "rad",
                 "needs a position PD at two gains, half as high again, and commands that stand still"};
  if (bench.law != bench::DriveLaw::kPositionPd) return {band};
  std::vector<Rest> rests;
  for (const bench::BenchRun& run : runs) add_rests(bench, run, options.rest, rests);
  double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
  for (const Rest& rest : rests) lowest = std::min(lowest, rest.kp), highest = std::max(highest, rest.kp);
  if (static_cast<double>(rests.size()) < options.rest.fewest_rests || !(highest >= options.rest.gain_ratio * lowest))
    return {band};

  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d products = Eigen::Vector2d::Zero();
  for (const Rest& rest : rests) {
    const Eigen::Vector2d row(1.0, lowest / rest.kp);
    squares += row * row.transpose();
    products += row * std::abs(rest.short_by_rad);
  }
  const Eigen::Matrix2d inverse = squares.ldlt().solve(Eigen::Matrix2d::Identity());
  const Eigen::Vector2d fit = inverse * products;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Rest& rest : rests) {
    const Eigen::Vector2d row(1.0, lowest / rest.kp);
    const double error_rad = std::abs(rest.short_by_rad) - row.dot(fit);
    scatter += error_rad * error_rad * row * row.transpose();
  }
  const auto count = static_cast<double>(rests.size());
  const Eigen::Matrix2d covariance = inverse * scatter * inverse * (count / (count - 2.0));
  const double deviation_rad = std::sqrt(std::max(0.0, covariance(0, 0)));
  const double torque_Nm = fit[1] * lowest, deviation_Nm = lowest * std::sqrt(std::max(0.0, covariance(1, 1)));
  Signature friction{"coulomb",
                     "rest against gain",
                     Agreement::kCannotTell,
                     {torque_Nm, torque_Nm - 2.0 * deviation_Nm, torque_Nm + 2.0 * deviation_Nm},
                     "Nm",
                     ""};
  if (torque_Nm > options.sure_deviations * deviation_Nm && fit[1] > options.rest_worth_rad)
    friction.agreement = Agreement::kAgrees;
  friction.sentence = fmt::format(
      "joints at rest are short of their command by {:.2g} Nm on average (deviation {:.1g})", torque_Nm, deviation_Nm);
  band.value = {fit[0], fit[0] - 2.0 * deviation_rad, fit[0] + 2.0 * deviation_rad};
  if (fit[0] > std::max<double>(options.rest_worth_rad, options.sure_deviations * deviation_rad)) {
    band.agreement = Agreement::kAgrees;
  } else if (band.value.high < options.rest_worth_rad) {
    band.agreement = Agreement::kDisagrees;
  }
  band.sentence =
      fmt::format("joints at rest miss by {:.2g} rad at any gain (deviation {:.1g}), and by {:.2g} Nm over the gain",
                  fit[0], deviation_rad, fit[1] * lowest);
  return {band, friction};
}

/// Quantum: median of the smallest steps between distinct readings. All steps of a quantised sensor are multiples of
/// it.
Signature quantum_check(const std::vector<bench::BenchRun>& runs, const SignatureOptions& options) {
  const auto fewest = static_cast<std::size_t>(options.quantum_fewest_readings);
  Signature s{"quantisation", "multiples of one number",   Agreement::kCannotTell, kUnknown,
              "rad",          "too few different readings"};
  std::set<double> readings;
  std::size_t samples = 0;
  for (const bench::BenchRun& run : runs) {
    for (std::size_t k = 0; k < run.recording.q_rad.size(); ++k) {
      if (run.recording.valid[k]) readings.insert(run.recording.q_rad[k]), ++samples;
    }
  }
  if (readings.size() < fewest) return s;
  std::vector<double> steps_rad;
  for (auto it = std::next(readings.begin()); it != readings.end(); ++it) {
    if (*it - *std::prev(it) > kSameReading_rad) steps_rad.push_back(*it - *std::prev(it));
  }
  if (steps_rad.size() < fewest) return s;
  std::sort(steps_rad.begin(), steps_rad.end());
  const double quantum_rad =
      fitting::median({steps_rad.begin(), steps_rad.begin() + static_cast<std::ptrdiff_t>(fewest)});
  std::size_t multiples = 0;
  Interval single{quantum_rad, quantum_rad, quantum_rad};  // range of step / multiple: files round each reading
  for (const double step_rad : steps_rad) {
    const double count = step_rad / quantum_rad;
    if (std::abs(count - std::round(count)) >= options.quantum_rounding || count <= 0.5) continue;
    ++multiples;
    single.low = std::min(single.low, step_rad / std::round(count));
    single.high = std::max(single.high, step_rad / std::round(count));
  }
  const double share = static_cast<double>(multiples) / static_cast<double>(steps_rad.size());
  s.value = single;
  if (share > options.quantum_multiples_share && quantum_rad > options.quantum_coarse_rad) {
    s.agreement = Agreement::kAgrees;
    s.sentence = fmt::format("{:.0f} % of the {} different readings are {:.3g} rad apart, or multiples of it",
                             100.0 * share, readings.size(), quantum_rad);
  } else {
    s.agreement = Agreement::kDisagrees;
    s.value = kUnknown;
    s.sentence = fmt::format("{} samples have {} different readings, of no common step above {:g} rad", samples,
                             readings.size(), options.quantum_coarse_rad);
  }
  return s;
}

}  // namespace pmg::evidence
