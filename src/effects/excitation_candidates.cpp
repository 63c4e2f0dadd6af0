#include "effects/excitation_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <tuple>

namespace pmg::effects {

namespace {

constexpr double kDuration_s = 6.0, kGlide_s = 0.6;
constexpr double kShapeLasts_s = kDuration_s - kGlide_s;

/// Command over time, -1..1 over the range of the recorded commands.
struct Shape {
  std::string name;
  std::function<double(double t_s)> at;
};

double wave(double cycles) { return std::sin(2.0 * std::numbers::pi * cycles); }
double square(double cycles) { return wave(cycles) >= 0.0 ? 1.0 : -1.0; }
double triangle(double cycles) { return 2.0 / std::numbers::pi * std::asin(wave(cycles)); }

/// Percent of half the range.
int percent(double share) { return static_cast<int>(std::lround(100.0 * share)); }

void add_steps(std::vector<Shape>& shapes) {
  for (const double size : {0.95, 0.5, 0.15}) {
    for (const double dwell_s : {0.5, 1.0}) {
      shapes.push_back({fmt::format("steps of {} % of the range every {} s", percent(size), dwell_s),
                        [=](double t_s) { return size * square(0.5 * t_s / dwell_s); }});
    }
  }
  shapes.push_back({"steps of growing size", [](double t_s) { return square(0.8 * t_s) * (0.1 + 0.15 * t_s); }});
  for (const double side : {-0.75, 0.75}) {
    shapes.push_back({fmt::format("small steps about {} % of the range", percent(side)),
                      [=](double t_s) { return side + 0.2 * square(0.7 * t_s); }});
  }
}

/// A staircase through the range, up and down, with a rest at each step.
void add_stairs(std::vector<Shape>& shapes) {
  for (const int stairs : {4, 8}) {
    shapes.push_back({fmt::format("a staircase of {} steps through the range and back", stairs), [=](double t_s) {
                        const double way = 2.0 * std::clamp(t_s / kShapeLasts_s, 0.0, 0.999);
                        const double share = way < 1.0 ? way : 2.0 - way;
                        return 0.95 * (2.0 * std::floor(share * (stairs + 1)) / stairs - 1.0);
                      }});
  }
}

void add_sweeps(std::vector<Shape>& shapes) {
  for (const double period_s : {kShapeLasts_s, 0.5 * kShapeLasts_s, 1.35}) {
    shapes.push_back({fmt::format("sweeps through the whole range, there and back in {:.2g} s", period_s),
                      [=](double t_s) { return 0.95 * triangle(t_s / period_s); }});
  }
  for (const double period_s : {2.0, 0.4}) {
    shapes.push_back({fmt::format("small reversals every {} s", 0.5 * period_s),
                      [=](double t_s) { return 0.12 * triangle(t_s / period_s); }});
  }
  for (const double side : {-0.65, 0.65}) {
    shapes.push_back({fmt::format("slow reversals about {} % of the range", percent(side)),
                      [=](double t_s) { return side + 0.3 * triangle(0.4 * t_s); }});
  }
}

void add_sines(std::vector<Shape>& shapes) {
  for (const double size : {0.6, 0.15}) {
    shapes.push_back({fmt::format("a sine of {} % of the range from 0.3 to 4 Hz", percent(size)),
                      [=](double t_s) { return size * wave(0.3 * t_s + 0.34 * t_s * t_s); }});
  }
  shapes.push_back({"a sine of 8 % of the range from 1 to 10 Hz",
                    [](double t_s) { return 0.08 * wave(1.0 * t_s + 0.83 * t_s * t_s); }});
  shapes.push_back({"a large sine of 1 Hz", [](double t_s) { return 0.9 * wave(t_s); }});
}

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> kShapes = [] {
    std::vector<Shape> all;
    add_steps(all);
    add_stairs(all);
    add_sweeps(all);
    add_sines(all);
    return all;
  }();
  return kShapes;
}

struct CommandRange {
  double start_rad = 0.0, low_rad = 0.0, high_rad = 0.0;
};

CommandRange commanded(const std::vector<calib::SingleJoint>& runs) {
  CommandRange range;
  range.start_rad = range.low_rad = range.high_rad = runs.front().run().recording.q_cmd_rad.front();
  for (const calib::SingleJoint& joint : runs) {
    for (const double q_rad : joint.run().recording.q_cmd_rad) {
      range.low_rad = std::min(range.low_rad, q_rad);
      range.high_rad = std::max(range.high_rad, q_rad);
    }
  }
  return range;
}

double mean_or(const std::vector<double>& values, double otherwise) {
  if (values.empty()) return otherwise;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

bench::Recording recording_of(const bench::Bench& bench, const bench::Recording& like, const Shape& shape,
                              const CommandRange& range) {
  bench::Recording r;
  const auto count = static_cast<std::size_t>(kDuration_s * bench.sample_rate_hz);
  const double centre_rad = 0.5 * (range.low_rad + range.high_rad), half_rad = 0.5 * (range.high_rad - range.low_rad);
  for (std::size_t k = 0; k < count; ++k) {
    const double t_s = static_cast<double>(k) / bench.sample_rate_hz;
    const double there_rad = centre_rad + half_rad * std::clamp(shape.at(std::max(0.0, t_s - kGlide_s)), -1.0, 1.0);
    const double s = std::min(1.0, t_s / kGlide_s);
    r.t_s.push_back(t_s);
    r.q_cmd_rad.push_back(range.start_rad + s * s * (3.0 - 2.0 * s) * (there_rad - range.start_rad));
  }
  r.q_rad.assign(count, r.q_cmd_rad.front());
  r.valid.assign(count, true);
  if (!like.bus_V.empty()) r.bus_V.assign(count, mean_or(like.bus_V, bench.supply_V));
  if (!like.temp_C.empty()) r.temp_C.assign(count, mean_or(like.temp_C, 25.0));
  return r;
}

/// The lowest, middle and highest of sorted values.
template <typename Value>
std::vector<Value> three_of(const std::vector<Value>& sorted) {
  if (sorted.size() <= 3) return sorted;
  return {sorted.front(), sorted[sorted.size() / 2], sorted.back()};
}

/// One run for each setting to try; its recording is a placeholder from another run.
std::vector<bench::BenchRun> settings(const bench::Bench& bench, const std::vector<calib::SingleJoint>& runs) {
  std::set<std::pair<double, double>> gains;
  std::set<std::tuple<double, double, double>> loads;
  for (const calib::SingleJoint& joint : runs) {
    const bench::BenchRun& run = joint.run();
    gains.insert({run.kp, run.kd});
    loads.insert({run.load.gravity_Nm, run.load.inertia_kg_m2, run.load.hangs_at_rad});
  }
  for (const bench::BenchLoad& one : bench.loads) {
    loads.insert({one.load.gravity_Nm, one.load.inertia_kg_m2, one.load.hangs_at_rad});
  }
  std::vector<bench::BenchRun> found;
  for (const auto& [gravity_Nm, inertia_kg_m2, hangs_at_rad] : three_of(std::vector(loads.begin(), loads.end()))) {
    for (const auto& [kp, kd] : three_of(std::vector(gains.begin(), gains.end()))) {
      bench::BenchRun run = runs.front().run();
      run.kp = kp;
      run.kd = kd;
      run.load = {inertia_kg_m2, gravity_Nm, hangs_at_rad};
      found.push_back(run);
    }
  }
  return found;
}

}  // namespace

std::vector<ExcitationCandidate> excitation_candidates(const bench::Bench& bench,
                                                       const std::vector<calib::SingleJoint>& runs) {
  const CommandRange range = commanded(runs);
  std::vector<ExcitationCandidate> found;
  for (const bench::BenchRun& setting : settings(bench, runs)) {
    for (const Shape& shape : shapes()) {
      found.push_back({shape.name, setting});
      found.back().run.recording = recording_of(bench, setting.recording, shape, range);
    }
  }
  return found;
}

}  // namespace pmg::effects
