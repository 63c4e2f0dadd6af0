#include "mocap/activities.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fitting/statistics.hpp"

namespace pmg::mocap {
namespace {

/// The frames and the body that activities are found in.
struct Scene {
  const BodyCourse& course;
  const ActivityOptions& options;
  double rate_hz, leg_m, cycle_s;
  std::size_t frame(double t_s) const {
    const double f = std::clamp(t_s * rate_hz, 0.0, static_cast<double>(course.pelvis_m.size() - 1));
    return static_cast<std::size_t>(std::lround(f));
  }
};

/// Mean velocity in the heading frame, turn, and extremes of posture between two times.
Activity measured(const Scene& scene, double from_s, double to_s) {
  const BodyCourse& course = scene.course;
  Activity activity;
  activity.from_s = from_s;
  activity.to_s = to_s;
  const std::size_t begin = scene.frame(from_s), end = std::max(scene.frame(to_s), begin + 1);
  Eigen::Vector2d travelled = Eigen::Vector2d::Zero();
  const std::size_t last = std::min(end, course.pelvis_m.size() - 1);
  for (std::size_t f = begin; f < last; ++f) {
    const Eigen::Vector2d moved = (course.pelvis_m[f + 1] - course.pelvis_m[f]).head<2>();
    travelled += Eigen::Rotation2Dd(-course.heading_rad[f]) * moved;
  }
  const double duration_s = static_cast<double>(std::max<std::size_t>(last - begin, 1)) / scene.rate_hz;
  activity.vx_m_s = travelled.x() / duration_s;
  activity.vy_m_s = travelled.y() / duration_s;
  activity.yaw_rad = course.heading_rad[last] - course.heading_rad[begin];
  for (std::size_t f = begin; f <= last; ++f) {
    activity.pelvis_drop_m = std::max(activity.pelvis_drop_m, course.standing_height_m - course.pelvis_m[f].z());
    if (course.pitch_rad.empty()) continue;
    if (std::abs(course.pitch_rad[f]) > std::abs(activity.pitch_rad)) activity.pitch_rad = course.pitch_rad[f];
    if (std::abs(course.roll_rad[f]) > std::abs(activity.roll_rad)) activity.roll_rad = course.roll_rad[f];
  }
  return activity;
}

/// What the person does around one step, from one gait cycle around its middle.
ActivityKind kind_of_step(const Scene& scene, const Step& step) {
  const double middle_s = (step.from_s() + step.to_s()) / 2.0;
  const double recorded_s = static_cast<double>(scene.course.pelvis_m.size() - 1) / scene.rate_hz;
  const double from_s = std::clamp(middle_s - scene.cycle_s / 2.0, 0.0, std::max(0.0, recorded_s - scene.cycle_s));
  const Activity around = measured(scene, from_s, std::min(from_s + scene.cycle_s, recorded_s));
  const double cycles = around.duration_s() / scene.cycle_s;
  const double speed = std::hypot(around.vx_m_s, around.vy_m_s);
  const bool walks = speed > scene.options.walking_speed * std::sqrt(9.81 * scene.leg_m);
  const bool turns = std::abs(around.yaw_rad) > scene.options.turning_rad_per_cycle * cycles;
  const bool left = around.yaw_rad > 0.0;
  if (!walks && !turns) return ActivityKind::kStepInPlace;
  if (!walks) return left ? ActivityKind::kTurnLeft : ActivityKind::kTurnRight;
  if (std::abs(around.vy_m_s) > std::abs(around.vx_m_s))
    return around.vy_m_s > 0.0 ? ActivityKind::kSideLeft : ActivityKind::kSideRight;
  if (around.vx_m_s < 0.0) return ActivityKind::kWalkBackward;
  if (turns) return left ? ActivityKind::kCircleLeft : ActivityKind::kCircleRight;
  return ActivityKind::kWalkForward;
}

/// One kind of walking from the step `first` to before the step `last`.
Activity walk_of(const Scene& scene, const std::vector<Step>& steps, std::size_t first, std::size_t last,
                 ActivityKind kind) {
  double from_s = steps[first].from_s(), to_s = steps[first].to_s();
  for (std::size_t i = first; i < last; ++i) {
    from_s = std::min(from_s, steps[i].from_s());
    to_s = std::max(to_s, steps[i].to_s());
  }
  Activity activity = measured(scene, from_s, std::max(to_s, from_s + 1.0 / scene.rate_hz));
  activity.kind = kind;
  activity.steps = static_cast<int>(last - first);
  std::vector<double> landings_s;
  for (std::size_t i = first; i < last; ++i) {
    if (steps[i].land_s) landings_s.push_back(*steps[i].land_s);
  }
  if (landings_s.size() >= 3 && landings_s.back() > landings_s.front()) {
    activity.steps_per_min =
        60.0 * static_cast<double>(landings_s.size() - 1) / (landings_s.back() - landings_s.front());
  }
  return activity;
}

void add_walks(const Scene& scene, const std::vector<Step>& steps, std::vector<Activity>& activities) {
  std::vector<ActivityKind> kinds;
  for (const Step& step : steps) kinds.push_back(kind_of_step(scene, step));
  for (std::size_t i = 1; i + 1 < kinds.size(); ++i) {  // one odd step between two of a kind is of that kind
    if (kinds[i - 1] == kinds[i + 1]) kinds[i] = kinds[i - 1];
  }
  for (std::size_t first = 0; first < steps.size();) {
    std::size_t last = first + 1;
    while (last < steps.size() && kinds[last] == kinds[first] &&
           steps[last].from_s() - steps[last - 1].to_s() < scene.options.longest_pause_cycles * scene.cycle_s) {
      ++last;
    }
    activities.push_back(walk_of(scene, steps, first, last, kinds[first]));
    first = last;
  }
}

/// Stretches in which the value is above the edge and once above the threshold.
void add_episodes(const Scene& scene, const std::vector<double>& values, double threshold, double edge,
                  ActivityKind kind, std::vector<Activity>& activities) {
  for (std::size_t f = 0; f < values.size();) {
    if (values[f] <= edge) {
      ++f;
      continue;
    }
    std::size_t stop = f;
    double most = 0.0;
    for (; stop < values.size() && values[stop] > edge; ++stop) most = std::max(most, values[stop]);
    if (most > threshold) {
      activities.push_back(
          measured(scene, static_cast<double>(f) / scene.rate_hz, static_cast<double>(stop) / scene.rate_hz));
      activities.back().kind = kind;
    }
    f = stop;
  }
}

void add_postures(const Scene& scene, std::vector<Activity>& activities) {
  const BodyCourse& course = scene.course;
  const ActivityOptions& o = scene.options;
  std::vector<double> drop, pitch, left, right;
  for (const Eigen::Vector3d& p : course.pelvis_m) drop.push_back(course.standing_height_m - p.z());
  add_episodes(scene, drop, o.squat_depth * scene.leg_m, o.squat_edge * scene.leg_m, ActivityKind::kSquat, activities);
  const double usual_pitch = fitting::quantile(course.pitch_rad, 0.5),
               usual_roll = fitting::quantile(course.roll_rad, 0.5);
  for (std::size_t f = 0; f < course.pitch_rad.size(); ++f) {
    pitch.push_back(course.pitch_rad[f] - usual_pitch);
    right.push_back(course.roll_rad[f] - usual_roll);
    left.push_back(-right.back());
  }
  add_episodes(scene, pitch, o.bend_rad, o.posture_edge * o.bend_rad, ActivityKind::kBend, activities);
  add_episodes(scene, left, o.lean_rad, o.posture_edge * o.lean_rad, ActivityKind::kLeanLeft, activities);
  add_episodes(scene, right, o.lean_rad, o.posture_edge * o.lean_rad, ActivityKind::kLeanRight, activities);
}

/// Times that no activity covers.
void add_stands(const Scene& scene, std::vector<Activity>& activities) {
  std::ranges::sort(activities, {}, &Activity::from_s);
  std::vector<Activity> stands;
  double free_s = 0.0;
  const double end_s = static_cast<double>(scene.course.pelvis_m.size()) / scene.rate_hz;
  const auto stand_until = [&](double to_s) {
    if (to_s - free_s >= scene.options.shortest_stand_s) stands.push_back(measured(scene, free_s, to_s));
  };
  for (const Activity& activity : activities) {
    stand_until(activity.from_s);
    free_s = std::max(free_s, activity.to_s);
  }
  stand_until(end_s);
  activities.insert(activities.end(), stands.begin(), stands.end());
  std::ranges::sort(activities, {}, &Activity::from_s);
}

}  // namespace

const char* name_of(ActivityKind kind) {
  constexpr std::array kNames = {"walk_forward", "walk_backward", "side_left",  "side_right",    "circle_left",
                                 "circle_right", "turn_left",     "turn_right", "step_in_place", "squat",
                                 "bend",         "lean_left",     "lean_right", "stand"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::vector<Activity> find_activities(const Recording& recording, const BodyCourse& course,
                                      const std::vector<Step>& steps, const ActivityOptions& options) {
  std::vector<Activity> activities;
  if (course.pelvis_m.size() < 2) return activities;
  const double leg_m = recording.leg_length_m > 0.0 ? recording.leg_length_m : course.standing_height_m;
  if (leg_m <= 0.0) return activities;
  const Scene scene{course, options, recording.rate_hz, leg_m, options.free_cycle * std::sqrt(leg_m / 9.81)};
  add_walks(scene, steps, activities);
  add_postures(scene, activities);
  add_stands(scene, activities);
  return activities;
}

}  // namespace pmg::mocap
