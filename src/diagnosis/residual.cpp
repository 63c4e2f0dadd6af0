#include "diagnosis/residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "evidence/motion.hpp"
#include "fitting/blocks.hpp"
#include "fitting/statistics.hpp"
#include "work/parallel.hpp"

namespace pmg::diagnosis {

namespace {

constexpr std::size_t kFewestBlocks = 3;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Column {
  const char *name, *unit, *linear_unit;
};
constexpr Column kColumns[] = {{"velocity", "rad/s", "m/s"},
                               {"position", "rad", "m"},
                               {"load", "Nm", "N"},
                               {"drive", "Nm", "N"},
                               {"temperature", "degC", "degC"},
                               {"time since the command changed", "s", "s"},
                               {"time", "s", "s"}};

constexpr std::size_t kDrive = 3;  // of the columns

struct RunSamples {
  std::vector<double> residual_rad;
  std::vector<std::size_t> block;
  std::vector<double> values[std::size(kColumns)];
};

RunSamples read(const bench::Bench& bench, const calib::SingleJoint& joint, const calib::JointModel& model,
                std::size_t every, const evidence::StepOptions& steps) {
  const bench::Recording& r = joint.run().recording;
  const std::vector<double> simulated_rad = joint.rollout(model);
  const evidence::Motion m = evidence::motion(bench, joint.run(), 0.05, steps);
  RunSamples samples;
  for (std::size_t k = 0; k < r.t_s.size(); k += every) {
    if (!r.valid[k]) continue;
    samples.residual_rad.push_back(simulated_rad[k] - r.q_rad[k]);
    samples.block.push_back(static_cast<std::size_t>((r.t_s[k] - r.t_s.front()) / fitting::Blocks::kLength_s));
    const double row[] = {m.dq_rad_s[k],
                          r.q_rad[k],
                          m.gravity_Nm[k],
                          m.drive[k],
                          r.temp_C.empty() ? kNaN : r.temp_C[k],
                          m.since_step_s[k],
                          r.t_s[k] - r.t_s.front()};
    for (std::size_t c = 0; c < std::size(kColumns); ++c) samples.values[c].push_back(row[c]);
  }
  return samples;
}

const char* unit(const bench::Bench& bench, std::size_t column) {
  const bool volts = bench.law == bench::DriveLaw::kServoVoltage || bench.law == bench::DriveLaw::kCascadePd;
  if (column == kDrive && volts) return "V";
  return bench.rig == bench::Rig::kLinear ? kColumns[column].linear_unit : kColumns[column].unit;
}

bool varies(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low < high;
}

/// Bin of each sample, by rank: bins have equal numbers of samples. `bins` marks an unknown circumstance.
std::vector<std::size_t> bins_of(const std::vector<double>& values, std::size_t bins) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<std::size_t> bin(values.size(), bins);
  for (std::size_t rank = 0; rank < order.size(); ++rank) bin[order[rank]] = rank * bins / order.size();
  // Equal values share a bin.
  for (std::size_t rank = 1; rank < order.size(); ++rank) {
    if (values[order[rank]] == values[order[rank - 1]]) bin[order[rank]] = bin[order[rank - 1]];
  }
  return bin;
}

/// Mean of one bin, with the cluster-robust variance of a ratio: B / (B - 1) * sum over its B blocks of
/// (sum_b - n_b mean)^2 / n^2.
ResidualBin bin_mean(const ResidualSamples& samples, const std::vector<double>& values,
                     const std::vector<std::size_t>& bin, std::size_t which) {
  std::vector<double> sum(samples.blocks, 0.0), count(samples.blocks, 0.0);
  ResidualBin found;
  double total_rad = 0.0;
  for (std::size_t i = 0; i < bin.size(); ++i) {
    if (bin[i] != which) continue;
    sum[samples.block[i]] += samples.residual_rad[i];
    count[samples.block[i]] += 1.0;
    total_rad += samples.residual_rad[i];
    found.at += values[i];
    ++found.samples;
  }
  if (found.samples == 0) return found;
  const auto n = static_cast<double>(found.samples);
  found.at /= n;
  const double mean_rad = total_rad / n;
  double squares = 0.0;
  for (std::size_t b = 0; b < samples.blocks; ++b) {
    if (count[b] == 0.0) continue;
    ++found.blocks;
    const double off = sum[b] - count[b] * mean_rad;
    squares += off * off;
  }
  const auto blocks = static_cast<double>(found.blocks);
  const double deviation_rad = found.blocks > 1 ? std::sqrt(squares * blocks / (blocks - 1.0)) / n : 0.0;
  found.mean_rad = {mean_rad, mean_rad - fitting::kNormal95 * deviation_rad,
                    mean_rad + fitting::kNormal95 * deviation_rad};
  return found;
}

/// Twofold cross-validation: alternate runs (seconds, with fewer than four runs) form two halves, and each half's bin
/// means predict the other half's residual.
evidence::Interval explained_share(const ResidualSamples& samples, const std::vector<std::size_t>& bin,
                                   std::size_t bins) {
  const std::size_t runs = samples.run.empty() ? 0 : samples.run.back() + 1;
  const auto half = [&](std::size_t i) { return (runs >= 4 ? samples.run[i] : samples.block[i] / 2) % 2; };
  std::vector<double> sum[2], count[2];
  for (auto& s : sum) s.assign(bins, 0.0);
  for (auto& c : count) c.assign(bins, 0.0);
  double whole_sum[2] = {0.0, 0.0}, whole_count[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < bin.size(); ++i) {
    if (bin[i] == bins) continue;
    sum[half(i)][bin[i]] += samples.residual_rad[i];
    count[half(i)][bin[i]] += 1.0;
    whole_sum[half(i)] += samples.residual_rad[i];
    whole_count[half(i)] += 1.0;
  }
  std::vector<double> gained(samples.blocks, 0.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < bin.size(); ++i) {
    if (bin[i] == bins) continue;
    const std::size_t other = 1 - half(i);
    if (whole_count[other] == 0.0) continue;
    const double residual = samples.residual_rad[i];
    const double predicted = count[other][bin[i]] > 0.0 ? sum[other][bin[i]] / count[other][bin[i]] : 0.0;
    gained[samples.block[i]] += residual * residual - (residual - predicted) * (residual - predicted);
    squares += residual * residual;
  }
  if (!(squares > 0.0)) return {};
  const double share = std::accumulate(gained.begin(), gained.end(), 0.0) / squares;
  double variance = 0.0;
  const double mean = std::accumulate(gained.begin(), gained.end(), 0.0) / static_cast<double>(gained.size());
  for (const double g : gained) variance += (g - mean) * (g - mean);
  const double deviation = std::sqrt(variance) / squares;
  return {share, share - fitting::kNormal95 * deviation, share + fitting::kNormal95 * deviation};
}

}  // namespace

ResidualSamples residual_samples(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                                 const calib::JointModel& model, unsigned threads, const evidence::StepOptions& steps,
                                 std::size_t most) {
  std::size_t all = 0;
  for (const calib::SingleJoint& joint : runs) all += joint.run().recording.t_s.size();
  const std::size_t every = all / most + 1;
  std::vector<RunSamples> by_run(runs.size());
  work::for_each_in_parallel(runs.size(), threads,
                             [&](std::size_t i) { by_run[i] = read(bench, runs[i], model, every, steps); });
  ResidualSamples samples;
  std::vector<double> values[std::size(kColumns)];
  for (std::size_t i = 0; i < by_run.size(); ++i) {
    const RunSamples& run = by_run[i];
    samples.residual_rad.insert(samples.residual_rad.end(), run.residual_rad.begin(), run.residual_rad.end());
    samples.run.insert(samples.run.end(), run.residual_rad.size(), i);
    for (const std::size_t block : run.block) samples.block.push_back(samples.blocks + block);
    if (!run.block.empty()) samples.blocks += run.block.back() + 1;
    for (std::size_t c = 0; c < std::size(kColumns); ++c) {
      values[c].insert(values[c].end(), run.values[c].begin(), run.values[c].end());
    }
  }
  for (std::size_t c = 0; c < std::size(kColumns); ++c) {
    if (varies(values[c])) samples.circumstances.push_back({kColumns[c].name, unit(bench, c), std::move(values[c])});
  }
  return samples;
}

std::vector<Dependence> dependences(const ResidualSamples& samples, std::size_t bins) {
  std::vector<Dependence> found;
  for (const Circumstance& circumstance : samples.circumstances) {
    Dependence dependence{circumstance.name, circumstance.unit, {}, {}};
    const std::vector<std::size_t> bin = bins_of(circumstance.values, bins);
    for (std::size_t b = 0; b < bins; ++b) {
      const ResidualBin mean = bin_mean(samples, circumstance.values, bin, b);
      if (mean.blocks >= kFewestBlocks) dependence.bins.push_back(mean);
    }
    dependence.explained_share = explained_share(samples, bin, bins);
    found.push_back(std::move(dependence));
  }
  std::stable_sort(found.begin(), found.end(), [](const Dependence& a, const Dependence& b) {
    return a.explained_share.value > b.explained_share.value;
  });
  return found;
}

std::vector<std::string> significant_dependences(const ResidualSamples& samples) {
  std::vector<std::string> names;
  for (const Dependence& d : dependences(samples)) {
    if (d.significant()) names.push_back(d.name);
  }
  return names;
}

}  // namespace pmg::diagnosis
