#include "mocap/gait_events.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/statistics.hpp"

namespace pmg::mocap {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kAdultLeg_m = 0.85;  ///< where a recording has no whole leg

/// One foot's motion on a fine grid of time.
struct FootMotion {
  double rate_hz = 0.0;
  std::vector<double> slower_m_s;  ///< speed of the slower of heel and toe
  std::vector<double> middle_m_s;  ///< speed of the middle of heel and toe
  std::vector<double> height_m;    ///< of the point that is closer to its own lowest height
};

std::vector<double> heights_above_lowest(const Positions& points) {
  std::vector<double> z;
  for (const Eigen::Vector3d& p : points) z.push_back(p.z());
  const double lowest = fitting::quantile(z, 0.05);
  for (double& value : z) value -= lowest;
  return z;
}

FootMotion foot_motion(const Sole& sole, double rate_hz, const GaitEventOptions& options) {
  const int factor = finer_factor(rate_hz, options.rate_hz);
  FootMotion motion;
  motion.rate_hz = rate_hz * factor;
  const Positions heel = smoothed(finer(sole.heel, factor), motion.rate_hz, options.smoothing_s);
  const Positions toe = smoothed(finer(sole.toe, factor), motion.rate_hz, options.smoothing_s);
  const Positions v_heel = velocity(heel, motion.rate_hz), v_toe = velocity(toe, motion.rate_hz);
  const std::vector<double> heel_m = heights_above_lowest(heel), toe_m = heights_above_lowest(toe);
  for (std::size_t i = 0; i < heel.size(); ++i) {
    motion.slower_m_s.push_back(std::min(v_heel[i].norm(), v_toe[i].norm()));
    motion.middle_m_s.push_back(0.5 * (v_heel[i] + v_toe[i]).norm());
    motion.height_m.push_back(std::min(heel_m[i], toe_m[i]));
  }
  return motion;
}

/// Samples [begin, end) of one swing around its fastest one.
struct Swing {
  std::size_t begin, end, peak;
};

/// Stretches in which both points are fast, those joined between which the foot stayed in the air.
std::vector<Swing> rough_swings(const FootMotion& foot, double slowest_m_s, double ground_m) {
  std::vector<Swing> swings;
  const std::vector<double>& speed = foot.slower_m_s;
  for (std::size_t i = 0; i < speed.size();) {
    if (speed[i] <= slowest_m_s) {
      ++i;
      continue;
    }
    Swing swing{i, i, i};
    while (swing.end < speed.size() && speed[swing.end] > slowest_m_s) {
      if (speed[swing.end] > speed[swing.peak]) swing.peak = swing.end;
      ++swing.end;
    }
    i = swing.end;
    const auto height = [&](std::size_t k) { return foot.height_m.begin() + static_cast<std::ptrdiff_t>(k); };
    if (!swings.empty() && *std::min_element(height(swings.back().end), height(swing.begin)) > ground_m) {
      if (speed[swing.peak] < speed[swings.back().peak]) swing.peak = swings.back().peak;
      swing.begin = swings.back().begin;
      swings.back() = swing;
    } else {
      swings.push_back(swing);
    }
  }
  return swings;
}

/// When the speed passes the threshold between the samples i and i + 1.
double crossing_s(const FootMotion& foot, std::size_t i, double threshold) {
  const double a = foot.slower_m_s[i], b = foot.slower_m_s[i + 1];
  const double share = a == b ? 0.5 : std::clamp((threshold - a) / (b - a), 0.0, 1.0);
  return (static_cast<double>(i) + share) / foot.rate_hz;
}

/// shortest_m: the shortest path of a whole swing. Lift and landing by the thresholds that belong to the step's own
/// speed. The speed needs the swing and the swing the speed: a few rounds settle both. Nothing if the thresholds leave
/// no swing.
std::optional<Step> fine_step(const FootMotion& foot, const Swing& rough, double shortest_m,
                              const GaitEventOptions& options) {
  constexpr int kRounds = 8;
  const std::vector<double>& speed = foot.slower_m_s;
  std::size_t begin = rough.begin, end = rough.end;
  Step step;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += foot.middle_m_s[i];
    step.speed_m_s = sum / static_cast<double>(end - begin);
    const double walking_m_s = options.swing_share * step.speed_m_s;
    const double lift = options.lifting_share * walking_m_s, land = options.landing_share * walking_m_s;
    if (speed[rough.peak] <= std::max(lift, land)) return std::nullopt;
    // From the outside inwards: within a swing that was joined from several the foot may rest in the air.
    begin = rough.begin;
    while (begin > 0 && speed[begin] > lift) --begin;
    while (begin < rough.peak && speed[begin] <= lift) ++begin;
    end = rough.end;
    while (end < speed.size() && speed[end - 1] > land) ++end;
    while (end > rough.peak + 1 && speed[end - 1] <= land) --end;
    step.lift_s.reset();
    step.land_s.reset();
    if (begin > 0) step.lift_s = crossing_s(foot, begin - 1, lift);
    if (end < speed.size()) step.land_s = crossing_s(foot, end - 1, land);
  }
  if (!step.lift_s && !step.land_s) return std::nullopt;  // longer than the recording
  const bool whole = step.lift_s && step.land_s;
  if (whole && step.speed_m_s * (*step.land_s - *step.lift_s) < shortest_m) return std::nullopt;
  return step;
}

double leg_length(const Recording& recording) {
  return recording.leg_length_m > 0.0 ? recording.leg_length_m : kAdultLeg_m;
}

/// A heel that is fixed to the ankle's body, from the frames in which the foot rests.
Positions made_heel(const Body& ankle, const Body& toe, double rate_hz) {
  const Positions v_ankle = velocity(ankle.position_m, rate_hz), v_toe = velocity(toe.position_m, rate_hz);
  std::vector<double> speed;
  for (std::size_t f = 0; f < v_toe.size(); ++f) speed.push_back(std::max(v_ankle[f].norm(), v_toe[f].norm()));
  const double slow = fitting::quantile(speed, 0.2);
  std::array<std::vector<double>, 3> offset;
  for (std::size_t f = 0; f < speed.size(); ++f) {
    if (speed[f] > slow) continue;
    const Eigen::Vector3d along = toe.position_m[f] - ankle.position_m[f];
    const Eigen::Vector3d heel = Eigen::Vector3d(-0.5 * along.x(), -0.5 * along.y(), along.z());
    const Eigen::Vector3d local = ankle.orientation[f].conjugate() * heel;
    for (int i = 0; i < 3; ++i) offset[static_cast<std::size_t>(i)].push_back(local[i]);
  }
  const Eigen::Vector3d middle(fitting::quantile(offset[0], 0.5), fitting::quantile(offset[1], 0.5),
                               fitting::quantile(offset[2], 0.5));
  Positions heel;
  for (std::size_t f = 0; f < speed.size(); ++f) heel.emplace_back(ankle.position_m[f] + ankle.orientation[f] * middle);
  return heel;
}

}  // namespace

Sole sole_of(const Recording& recording, Side side) {
  const Body &heel = recording.body(of_side(KeyBody::left_heel, side)),
             &toe = recording.body(of_side(KeyBody::left_toe, side)),
             &ankle = recording.body(of_side(KeyBody::left_ankle, side));
  Sole sole;
  if (heel.known())
    sole.heel = heel.position_m;
  else if (ankle.known() && toe.known() && !ankle.orientation.empty())
    sole.heel = made_heel(ankle, toe, recording.rate_hz);
  else if (ankle.known())
    sole.heel = ankle.position_m;
  sole.toe = toe.known() ? toe.position_m : sole.heel;
  if (sole.heel.empty()) sole.heel = sole.toe;
  return sole;
}

std::vector<Step> find_steps(const Recording& recording, const GaitEventOptions& options) {
  const double leg_m = leg_length(recording);
  const double slowest_m_s = options.slowest_swing * std::sqrt(kGravity_m_s2 * leg_m);
  std::vector<Step> steps;
  if (recording.rate_hz < options.slowest_rate_hz) return steps;
  for (const Side side : {Side::left, Side::right}) {
    const Sole sole = sole_of(recording, side);
    if (sole.heel.size() < 3) continue;
    const FootMotion foot = foot_motion(sole, recording.rate_hz, options);
    for (const Swing& swing : rough_swings(foot, slowest_m_s, options.ground_height * leg_m)) {
      std::optional<Step> step = fine_step(foot, swing, options.shortest_path * leg_m, options);
      if (!step) continue;
      step->side = side;
      // Two rough swings may settle on the same fine one.
      const bool again = !steps.empty() && steps.back().side == side && step->from_s() <= steps.back().to_s();
      if (!again) steps.push_back(*step);
    }
  }
  std::ranges::sort(steps, {}, &Step::to_s);
  return steps;
}

std::array<FootEvents, 2> events_of(const std::vector<Step>& steps) {
  std::array<FootEvents, 2> events;
  for (const Step& step : steps) {
    FootEvents& foot = events[static_cast<std::size_t>(step.side)];
    if (step.lift_s) foot.off_s.push_back(*step.lift_s);
    if (step.land_s) foot.contact_s.push_back(*step.land_s);
  }
  return events;
}

double ground_height_m(const Recording& recording) {
  std::vector<double> lower;
  for (const Side side : {Side::left, Side::right}) {
    const Sole sole = sole_of(recording, side);
    for (std::size_t f = 0; f < sole.heel.size(); ++f) lower.push_back(std::min(sole.heel[f].z(), sole.toe[f].z()));
  }
  return fitting::quantile(std::move(lower), 0.05);
}

}  // namespace pmg::mocap
