#include "diagnosis/next_excitation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <tuple>

namespace pmg::diagnosis {

namespace {

constexpr double kDuration_s = 6.0;
constexpr double kRest_s = 0.3;  // before the first motion

/// -1 .. 1 over time, of the range that the runs' commands had.
struct Shape {
  const char* name;
  std::function<double(double t_s)> at;
};

double wave(double cycles) { return std::sin(2.0 * std::numbers::pi * cycles); }
double triangle(double cycles) { return 2.0 / std::numbers::pi * std::asin(wave(cycles)); }

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> kShapes = {
      {"large steps of 1 s", [](double t) { return wave(0.5 * t) >= 0.0 ? 0.9 : -0.9; }},
      {"small steps of 0.5 s", [](double t) { return wave(t) >= 0.0 ? 0.15 : -0.15; }},
      {"steps of growing size", [](double t) { return (wave(0.8 * t) >= 0.0 ? 1.0 : -1.0) * (0.1 + 0.13 * t); }},
      {"a slow sweep through the whole range", [](double t) { return 0.95 * triangle(t / kDuration_s); }},
      {"a slow sweep and back, twice", [](double t) { return 0.9 * triangle(2.0 * t / kDuration_s); }},
      {"slow small reversals", [](double t) { return 0.12 * triangle(0.5 * t); }},
      {"fast small reversals", [](double t) { return 0.12 * triangle(2.5 * t); }},
      {"a sine from 0.3 to 4 Hz", [](double t) { return 0.5 * wave(0.3 * t + 0.3 * t * t); }},
      {"a large sine of 1 Hz", [](double t) { return 0.9 * wave(t); }},
      {"slow reversals off centre", [](double t) { return 0.6 + 0.3 * triangle(0.4 * t); }},
  };
  return kShapes;
}

double mean_or(const std::vector<double>& values, double otherwise) {
  if (values.empty()) return otherwise;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The shape as a run like the other one.
calib::BenchRun run_like(const calib::Bench& bench, const calib::BenchRun& like, const Shape& shape, double low_rad,
                         double high_rad) {
  calib::BenchRun run = like;
  calib::Recording r;
  const auto count = static_cast<std::size_t>(kDuration_s * bench.sample_rate_hz);
  for (std::size_t k = 0; k < count; ++k) {
    const double t_s = static_cast<double>(k) / bench.sample_rate_hz;
    const double level = t_s < kRest_s ? shape.at(0.0) : shape.at(t_s - kRest_s);
    r.t_s.push_back(t_s);
    r.q_cmd_rad.push_back(0.5 * (low_rad + high_rad) + 0.5 * (high_rad - low_rad) * std::clamp(level, -1.0, 1.0));
  }
  r.q_rad.assign(count, r.q_cmd_rad.front());
  r.valid.assign(count, true);
  if (!like.recording.bus_V.empty()) r.bus_V.assign(count, mean_or(like.recording.bus_V, bench.supply_V));
  if (!like.recording.temp_C.empty()) r.temp_C.assign(count, mean_or(like.recording.temp_C, 25.0));
  run.recording = r;
  return run;
}

/// One run of each gain and load, at most so many.
std::vector<const calib::BenchRun*> settings(const std::vector<calib::SingleJoint>& runs) {
  constexpr std::size_t kMost = 8;
  std::set<std::tuple<double, double, double, double>> seen;
  std::vector<const calib::BenchRun*> found;
  for (const calib::SingleJoint& joint : runs) {
    const calib::BenchRun& run = joint.run();
    if (seen.size() < kMost && seen.insert({run.kp, run.kd, run.load.inertia_kg_m2, run.load.gravity_Nm}).second)
      found.push_back(&run);
  }
  return found;
}

void name_load(const calib::Bench& bench, NextExcitation& next) {
  for (const calib::BenchLoad& load : bench.loads) {
    if (load.load.inertia_kg_m2 != next.load.inertia_kg_m2 || load.load.gravity_Nm != next.load.gravity_Nm) continue;
    next.load_mass_kg = load.mass_kg;
    next.load_length_m = load.length_m;
  }
}

constexpr double kTimesRecorded = 2.0;
constexpr double kSame_rad = 1e-9;

/// Rms between the run's readings and the model once it has been fitted to it and, by its blocks, to the runs before.
double apart_once_fitted_rad(const NestedFit& run, const NestedModel& model, const Misses& misses) {
  const Eigen::Index count = model.coordinates.size();
  const double samples = std::max(1.0, run.samples());
  if (misses.empty()) return 0.0;
  if (count == 0) return std::sqrt(run.squares(misses) / samples);
  const Eigen::MatrixXd slope = run.slopes(model, misses).of_run.front();
  Eigen::MatrixXd information = prior(model).information + kTimesRecorded * slope.transpose() * slope;
  for (const BlockNormal& block : model.blocks) information += block.information;
  const Eigen::VectorXd gradient = kTimesRecorded * slope.transpose() * misses.front();
  const Eigen::VectorXd step = bounded_step(information, gradient, model.unknowns, model.coordinates, 1e-6);
  return (misses.front() + slope * step).norm() / std::sqrt(samples);
}

/// The run as the model would do it.
NestedFit played(const calib::Bench& bench, calib::BenchRun run, const calib::JointModel& model, double step_s) {
  run.recording.q_rad = calib::SingleJoint(bench, run, step_s).rollout(model);
  std::vector<calib::SingleJoint> joints;
  joints.emplace_back(bench, std::move(run), step_s);
  return {std::move(joints), 1};
}

/// Whichever of the two would absorb more.
double separation_rad(const calib::Bench& bench, const calib::BenchRun& run, const NestedModel& first,
                      const NestedModel& second, double step_s) {
  const NestedFit as_first = played(bench, run, first.model, step_s);
  const NestedFit as_second = played(bench, run, second.model, step_s);
  return std::min(apart_once_fitted_rad(as_first, second, as_first.misses(second.model)),
                  apart_once_fitted_rad(as_second, first, as_second.misses(first.model)));
}

}  // namespace

std::optional<NextExcitation> next_excitation(const calib::Bench& bench, const std::vector<calib::SingleJoint>& runs,
                                              const Rivals& rivals) {
  if (bench.law == calib::DriveLaw::kTorque || runs.empty()) return std::nullopt;
  double low_rad = runs.front().run().recording.q_cmd_rad.front(), high_rad = low_rad;
  for (const calib::SingleJoint& joint : runs) {
    for (const double q_rad : joint.run().recording.q_cmd_rad) {
      low_rad = std::min(low_rad, q_rad);
      high_rad = std::max(high_rad, q_rad);
    }
  }
  std::optional<NextExcitation> best;
  for (const calib::BenchRun* like : settings(runs)) {
    for (const Shape& shape : shapes()) {
      const calib::BenchRun run = run_like(bench, *like, shape, low_rad, high_rad);
      double apart_rad = std::numeric_limits<double>::infinity();
      for (const NestedModel& other : rivals.others) {
        apart_rad = std::min(apart_rad, separation_rad(bench, run, rivals.first, other, runs.front().step_s()));
      }
      if (best && apart_rad <= best->separation_rad) continue;
      best.emplace();
      best->tells_apart = rivals.names;
      best->kp = like->kp;
      best->kd = like->kd;
      best->load = like->load;
      best->t_s = run.recording.t_s;
      best->q_cmd_rad = run.recording.q_cmd_rad;
      best->separation_rad = apart_rad;
      name_load(bench, *best);
      const std::string load = best->load_mass_kg > 0.0 ? fmt::format(", load {:.3g} kg", best->load_mass_kg) : "";
      best->text = fmt::format("{} at kp {:.4g}{}: {} then differ by {:.3g} {} rms, each fitted again", shape.name,
                               like->kp, load, fmt::join(rivals.names, " and "), 1e3 * apart_rad,
                               bench.rig == calib::Rig::kLinear ? "mm" : "mrad");
    }
  }
  if (best && best->separation_rad < kSame_rad) return std::nullopt;
  return best;
}

}  // namespace pmg::diagnosis
