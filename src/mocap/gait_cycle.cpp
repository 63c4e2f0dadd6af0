#include "mocap/gait_cycle.hpp"

#include <algorithm>
#include <cmath>

#include "mocap/activities.hpp"

namespace pmg::mocap {
namespace {

/// Positions of the key bodies at a time, relative to the pelvis and in the heading frame; bodies of both times alone.
std::vector<Eigen::Vector3d> pose_at(const Recording& recording, const BodyCourse& course, double t_s) {
  const double at = std::clamp(t_s * recording.rate_hz, 0.0, static_cast<double>(recording.frames - 1));
  const auto f = std::min(static_cast<std::size_t>(at), recording.frames - 2);
  const double share = at - static_cast<double>(f);
  const double heading = (1.0 - share) * course.heading_rad[f] + share * course.heading_rad[f + 1];
  const Body& pelvis = recording.body(KeyBody::pelvis);
  const auto between = [&](const Body& body) -> Eigen::Vector3d {
    return (1.0 - share) * body.position_m[f] + share * body.position_m[f + 1];
  };
  Eigen::Vector3d origin = between(pelvis);
  origin.z() = 0.0;  // a pelvis at another height is another pose
  std::vector<Eigen::Vector3d> pose;
  for (const Body& body : recording.bodies) {
    if (body.known())
      pose.emplace_back(Eigen::AngleAxisd(-heading, Eigen::Vector3d::UnitZ()) * (between(body) - origin));
  }
  return pose;
}

/// The foot's swings that end in (from_s, to_s].
std::vector<const Step*> swings_within(const std::vector<Step>& steps, Side side, double from_s, double to_s) {
  std::vector<const Step*> found;
  for (const Step& step : steps) {
    if (step.side == side && step.lift_s && step.land_s && *step.lift_s > from_s && *step.land_s <= to_s)
      found.push_back(&step);
  }
  return found;
}

FootContact contact_around(const Step& swing, double from_s, double period_s) {
  const double middle = ((*swing.lift_s + *swing.land_s) / 2.0 - from_s) / period_s;
  return {std::fmod(middle + 0.5, 1.0), 1.0 - (*swing.land_s - *swing.lift_s) / period_s};
}

}  // namespace

std::optional<GaitCycle> best_cycle(const Recording& recording, const std::vector<Step>& steps, double from_s,
                                    double to_s) {
  const BodyCourse course = course_of(recording);
  if (course.pelvis_m.size() < 2) return std::nullopt;
  std::optional<GaitCycle> best;
  for (const Step& begin : steps) {
    if (!begin.land_s || *begin.land_s < from_s) continue;
    const Side other = begin.side == Side::left ? Side::right : Side::left;
    const auto next = std::ranges::find_if(steps, [&](const Step& step) {
      return step.side == begin.side && step.land_s && *step.land_s > *begin.land_s;
    });
    if (next == steps.end() || *next->land_s > to_s || !next->lift_s) continue;
    const std::vector<const Step*> others = swings_within(steps, other, *begin.land_s, *next->land_s);
    if (others.size() != 1) continue;
    GaitCycle cycle;
    cycle.side = begin.side;
    cycle.from_s = *begin.land_s;
    cycle.to_s = *next->land_s;
    const auto first = pose_at(recording, course, cycle.from_s), last = pose_at(recording, course, cycle.to_s);
    double sum = 0.0;
    for (std::size_t b = 0; b < first.size(); ++b) sum += (last[b] - first[b]).squaredNorm();
    cycle.loop_error_m = std::sqrt(sum / static_cast<double>(first.size()));
    cycle.contact[static_cast<std::size_t>(begin.side)] = contact_around(*next, cycle.from_s, cycle.period_s());
    cycle.contact[static_cast<std::size_t>(other)] = contact_around(*others.front(), cycle.from_s, cycle.period_s());
    if (!best || cycle.loop_error_m < best->loop_error_m) best = cycle;
  }
  return best;
}

}  // namespace pmg::mocap
