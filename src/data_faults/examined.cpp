#include "data_faults/examined.hpp"

#include <algorithm>
#include <cmath>

#include "bench/noise_floor.hpp"
#include "fitting/statistics.hpp"

namespace pmg::data_faults {

namespace {

/// The error that a perfect model would have by QuickFit::log_error; 0 without repeats.
double floor_of(const std::vector<bench::BenchRun>& runs) {
  std::vector<const bench::BenchRun*> all;
  std::vector<double> noise_rad;
  for (const bench::BenchRun& run : runs) {
    all.push_back(&run);
    noise_rad.push_back(bench::sensor_noise_rad(run.recording));
  }
  const double repeats_rad = bench::noise_floor(all).rms_rad;
  return repeats_rad > 0.0 ? std::hypot(repeats_rad, fitting::median(noise_rad)) : 0.0;
}

/// Indices spread over the list by steps of the golden ratio, to avoid its periods; in their order.
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  std::vector<bool> taken(count, count <= most);
  double position = 0.5;
  for (std::size_t found = count <= most ? most : 0; found < most; position = std::fmod(position + kGoldenRatio, 1.0)) {
    const auto index = static_cast<std::size_t>(position * static_cast<double>(count));
    if (!taken[index]) ++found;
    taken[index] = true;
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < count; ++i) {
    if (taken[i]) indices.push_back(i);
  }
  return indices;
}

}  // namespace

Examined::Examined(const bench::Bench& bench, std::vector<bench::BenchRun> runs,
                   const std::optional<model::ActuatorParameters>& given, const DataFaultOptions& options,
                   unsigned threads)
    : bench_(&bench),
      runs_(std::move(runs)),
      options_(options),
      model_(bench, given, threads),
      few_(spread(runs_.size(), static_cast<std::size_t>(options.fitted_runs))),
      floor_rad_(floor_of(runs_)) {}

std::vector<bench::BenchRun> Examined::with(const std::vector<bench::Correction>& corrections) const {
  std::vector<bench::BenchRun> found = runs_;
  for (bench::BenchRun& run : found) {
    for (const bench::Correction& correction : corrections) bench::correct(run, correction);
  }
  return found;
}

void Examined::apply(const std::vector<bench::Correction>& corrections) {
  for (bench::BenchRun& run : runs_) {
    for (const bench::Correction& correction : corrections) bench::correct(run, correction);
  }
}

std::vector<calib::SingleJoint> Examined::few_of(const std::vector<bench::BenchRun>& runs) const {
  std::vector<calib::SingleJoint> found;
  for (const std::size_t i : few_) found.push_back(model_.joint(runs[i]));
  return found;
}

void Examined::fit() {
  const std::vector<calib::SingleJoint> few = few_of(runs_);
  fit_ = fit_ ? model_.refit(few, *fit_, {}, 4) : model_.fit(few);
  log_error_ = model_.log_errors(model_.joints(runs_), fit_->model);
}

double Examined::floors(const QuickFit& fit) const { return std::exp(fitting::median(fit.log_error)) / floor_rad_; }

double Examined::log_floor() const { return std::log(floor_rad_); }

double Examined::usual_log_error() const {
  const double middle = fitting::median(log_error_);
  std::vector<double> apart;
  for (const double log : log_error_) apart.push_back(std::abs(log - middle));
  const double deviation = fitting::median(apart) / fitting::kNormalMedianDeviation;
  return middle + std::clamp(options_.usual_deviations * deviation, std::log(options_.usual_error),
                             std::log(options_.largest_usual_error));
}

}  // namespace pmg::data_faults
