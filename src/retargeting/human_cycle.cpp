#include "retargeting/human_cycle.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/config_error.hpp"
#include "fitting/statistics.hpp"
#include "generator/gait_task.hpp"

namespace pmg::retargeting {
namespace {
using generator::kClipSamples;

constexpr std::size_t kFineSamples = 800;  // of the closed curves: far finer than a recording's frames
/// A sole is flat within this of its resting pitch: a foot of 0.25 m then lifts one end by less than 2.5 cm.
constexpr double kFlat_rad = 0.1;

double wrapped(double phase) { return phase - std::floor(phase); }

/// A monotone cubic through points that repeat after one cycle: x + 1 -> y + 1.
class PeriodicWarp {
 public:
  PeriodicWarp(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)) {
    const std::size_t n = x_.size();
    x_.push_back(x_[0] + 1.0);
    y_.push_back(y_[0] + 1.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double after = secant(i), before = secant(i == 0 ? n - 1 : i - 1);
      slope_.push_back(2.0 * after * before / (after + before));  // harmonic mean: monotone
    }
    slope_.push_back(slope_[0]);
  }

  double operator()(double x) const {
    std::size_t i = 0;
    while (i + 2 < x_.size() && x >= x_[i + 1]) ++i;
    const double width = x_[i + 1] - x_[i], t = (x - x_[i]) / width, h = t * t * (3.0 - 2.0 * t);
    return (1.0 - h) * y_[i] + h * y_[i + 1] + width * t * (1.0 - t) * ((1.0 - t) * slope_[i] - t * slope_[i + 1]);
  }

 private:
  double secant(std::size_t i) const { return (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]); }
  std::vector<double> x_, y_, slope_;
};

/// From the clip's phase to that of the cut.
PeriodicWarp alignment(const mocap::Recording& recording, const mocap::GaitCycle& cut, double duty_factor) {
  std::array<double, 2> land{}, lift{};
  for (std::size_t side = 0; side < 2; ++side) {
    const mocap::FootContact& contact = cut.contact[side];
    land[side] = wrapped(contact.center - 0.5 * contact.duty_factor);
    lift[side] = wrapped(contact.center + 0.5 * contact.duty_factor);
  }
  const double left = land[0];
  const std::vector<double> human = {left, left + wrapped(lift[1] - left), left + wrapped(land[1] - left),
                                     left + wrapped(lift[0] - left)};
  const std::vector<double> clip = {0.0, duty_factor - 0.5, 0.5, duty_factor};
  if (!std::ranges::is_sorted(human, std::ranges::less_equal{}) || clip[1] <= 0.0) {
    files::raise({recording.file}, "",
                 fmt::format("the cycle from {:.3f} to {:.3f} s has no two double supports (right foot lifts {:.2f} of "
                             "a cycle after the left one lands, lands {:.2f} after; the left one lifts {:.2f} after)",
                             cut.from_s, cut.to_s, human[1] - left, human[2] - left, human[3] - left),
                 "walking: each foot lifts after the other one landed");
  }
  return {clip, human};
}

double phase_of(std::size_t sample) { return static_cast<double>(sample) / static_cast<double>(kClipSamples); }

bool in_stance(std::size_t sample, std::size_t side, double duty_factor) {
  return std::abs(generator::stance_phase(phase_of(sample), static_cast<Foot>(side), duty_factor)) <= 0.5 * duty_factor;
}

double pitch_of(const Eigen::Vector3d& d) { return std::atan2(d.z(), std::hypot(d.x(), d.y())); }

/// The pitch that a sole keeps in stance: the median over the quieter half of the stance.
double resting_pitch(const HumanCycle& cycle, std::size_t side) {
  std::vector<std::pair<double, double>> speed_and_pitch;
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    if (!in_stance(k, side, cycle.duty_factor)) continue;
    const double before = pitch_of(cycle.pose[(k + kClipSamples - 1) % kClipSamples].side[side].sole);
    const double after = pitch_of(cycle.pose[(k + 1) % kClipSamples].side[side].sole);
    speed_and_pitch.emplace_back(std::abs(after - before), pitch_of(cycle.pose[k].side[side].sole));
  }
  std::ranges::sort(speed_and_pitch);
  std::vector<double> quiet;
  for (std::size_t i = 0; i < (speed_and_pitch.size() + 1) / 2; ++i) quiet.push_back(speed_and_pitch[i].second);
  return fitting::median(quiet);
}

/// Turns the sole about its own horizontal lateral axis, so that its resting pitch becomes 0.
void level_sole(HumanCycle& cycle, std::size_t side) {
  const double resting_rad = resting_pitch(cycle, side);
  for (HumanPose& pose : cycle.pose) {
    Eigen::Vector3d& sole = pose.side[side].sole;
    const Eigen::Vector3d lateral(-sole.y(), sole.x(), 0.0);
    if (lateral.norm() > 0.0) sole = Eigen::AngleAxisd(resting_rad, lateral.normalized()) * sole;
  }
}

/// The longest run of the stance in which the sole is flat, as shares of the stance.
std::pair<double, double> flat_part(const HumanCycle& cycle, std::size_t side) {
  std::vector<std::pair<double, bool>> stance;
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    if (!in_stance(k, side, cycle.duty_factor)) continue;
    const double s = generator::stance_phase(phase_of(k), static_cast<Foot>(side), cycle.duty_factor);
    stance.emplace_back(s / cycle.duty_factor + 0.5, std::abs(pitch_of(cycle.pose[k].side[side].sole)) < kFlat_rad);
  }
  std::ranges::sort(stance);
  std::pair<double, double> longest{0.5, 0.5};
  for (std::size_t i = 0; i < stance.size(); ++i) {
    std::size_t end = i;
    while (end < stance.size() && stance[end].second) ++end;
    if (end > i && stance[end - 1].first - stance[i].first > longest.second - longest.first)
      longest = {stance[i].first, stance[end - 1].first};
    i = end;
  }
  return longest;
}

/// Amplitude of cos(2 pi (phase - peak)) in a curve, by projection.
template <typename Curve>
double amplitude(const HumanCycle& cycle, double peak, Curve curve) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kClipSamples; ++k)
    sum += curve(cycle.pose[k]) * std::cos(2.0 * std::numbers::pi * (phase_of(k) - peak));
  return 2.0 * sum / static_cast<double>(kClipSamples);
}

}  // namespace

double duty_factor_of(const mocap::GaitCycle& cut) {
  return 0.5 * (cut.contact[0].duty_factor + cut.contact[1].duty_factor);
}

HumanCycle human_cycle(const mocap::Recording& recording, const mocap::GaitCycle& cut,
                       std::optional<double> duty_factor) {
  HumanCycle cycle;
  cycle.cut = cut;
  cycle.leg_length_m = recording.leg_length_m;
  cycle.period_s = cut.period_s();
  cycle.duty_factor = duty_factor.value_or(duty_factor_of(cut));
  const PeriodicWarp warp = alignment(recording, cut, cycle.duty_factor);
  const PoseCurves recorded = pose_curves(recording, cut.from_s, cut.to_s);
  cycle.mean_velocity = recorded.mean_velocity;
  const mocap::ClosedCycle closed = mocap::close_cycle(recorded.curves, cut, {.samples = kFineSamples});
  cycle.seam_before_rad = closed.seam_before_rad;
  cycle.closing_moved_rad = closed.moved_rad;

  double shift = 0.0;
  for (std::size_t k = 0; k < kClipSamples; ++k) shift += (warp(phase_of(k)) - phase_of(k)) / kClipSamples;
  for (std::size_t k = 0; k < kClipSamples; ++k) {
    const double phase = warp(phase_of(k));
    cycle.recorded_phase.push_back(wrapped(phase));
    cycle.warp_cycles = std::max(cycle.warp_cycles, std::abs(phase - phase_of(k) - shift));
    const double at = wrapped(phase) * static_cast<double>(kFineSamples);
    const auto before = static_cast<std::size_t>(at) % kFineSamples, after = (before + 1) % kFineSamples;
    const double share = at - std::floor(at);
    std::vector<double> values;
    for (const std::vector<double>& curve : closed.angle_rad)
      values.push_back((1.0 - share) * curve[before] + share * curve[after]);
    cycle.pose.push_back(pose_of(values, recorded.arms_known));
  }
  for (std::size_t side = 0; side < 2; ++side) level_sole(cycle, side);
  const auto left = flat_part(cycle, 0), right = flat_part(cycle, 1);
  cycle.flat_from = std::max(left.first, right.first);
  cycle.flat_to = std::max(cycle.flat_from, std::min(left.second, right.second));
  cycle.hike_rad =
      amplitude(cycle, cycle.duty_factor + 0.03, [](const HumanPose& pose) { return pose.pelvis_roll_rad; });
  cycle.sway_m = amplitude(cycle, 0.5 * cycle.duty_factor, [](const HumanPose& pose) { return pose.pelvis_left_m; });
  return cycle;
}

}  // namespace pmg::retargeting
