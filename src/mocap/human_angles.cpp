#include <algorithm>
#include <cmath>

#include "mocap/activities.hpp"
#include "mocap/gait_cycle.hpp"

namespace pmg::mocap {
namespace {

/// Builds the angles of one recording, one curve at a time.
class AngleCurves {
 public:
  AngleCurves(const Recording& recording, const BodyCourse& course, HumanAngles& angles)
      : recording_(recording), course_(course), angles_(angles) {}

  /// Direction from one body to the other in the heading frame, of each frame; empty if one is missing.
  Positions direction(KeyBody from, KeyBody to) const {
    Positions result;
    const Body &a = recording_.body(from), &b = recording_.body(to);
    if (!a.known() || !b.known()) return result;
    for (std::size_t f = 0; f < recording_.frames; ++f) {
      const Eigen::Vector3d d = Eigen::AngleAxisd(-course_.heading_rad[f], Eigen::Vector3d::UnitZ()) *
                                Eigen::Vector3d(b.position_m[f] - a.position_m[f]);
      result.push_back(d.norm() > 0.0 ? Eigen::Vector3d(d.normalized()) : d);
    }
    return result;
  }

  template <typename Angle>
  void add(const std::string& name, const Positions& d, Angle angle) {
    if (d.empty()) return;
    std::vector<double> curve;
    for (const Eigen::Vector3d& v : d) curve.push_back(angle(v));
    unwrap(curve);
    angles_.names.push_back(name);
    angles_.angle_rad.push_back(std::move(curve));
  }

  /// The angle between two directions, 0 if they are the same.
  void add_bend(const std::string& name, const Positions& a, const Positions& b) {
    if (a.empty() || b.empty()) return;
    std::vector<double> curve;
    for (std::size_t f = 0; f < a.size(); ++f) curve.push_back(std::atan2(a[f].cross(b[f]).norm(), a[f].dot(b[f])));
    angles_.names.push_back(name);
    angles_.angle_rad.push_back(std::move(curve));
  }

 private:
  const Recording& recording_;
  const BodyCourse& course_;
  HumanAngles& angles_;
};

/// The bodies' positions as gait events take them: interpolated to a rate, and smoothed.
Recording fine_recording(const Recording& coarse, const GaitEventOptions& options) {
  Recording fine;
  const int factor = finer_factor(coarse.rate_hz, options.rate_hz);
  fine.rate_hz = coarse.rate_hz * factor;
  for (std::size_t b = 0; b < kKeyBodies; ++b) {
    if (!coarse.bodies[b].known()) continue;
    fine.bodies[b].position_m = smoothed(finer(coarse.bodies[b].position_m, factor), fine.rate_hz, options.smoothing_s);
    fine.frames = fine.bodies[b].position_m.size();
  }
  return fine;
}

}  // namespace

HumanAngles human_angles(const Recording& coarse, const GaitEventOptions& options) {
  HumanAngles angles;
  const Recording recording = fine_recording(coarse, options);
  angles.rate_hz = recording.rate_hz;
  const BodyCourse course = course_of(recording);
  if (course.pelvis_m.empty()) return angles;
  AngleCurves curves(recording, course, angles);
  const Positions trunk = curves.direction(KeyBody::pelvis, KeyBody::neck);
  curves.add("trunk_pitch", trunk, [](const Eigen::Vector3d& v) { return std::atan2(v.x(), v.z()); });
  curves.add("trunk_roll", trunk,
             [](const Eigen::Vector3d& v) { return std::atan2(-v.y(), std::hypot(v.x(), v.z())); });
  for (const Side side : {Side::left, Side::right}) {
    const std::string name = side == Side::left ? "left_" : "right_";
    const double out = side == Side::left ? 1.0 : -1.0;
    const auto down_pitch = [](const Eigen::Vector3d& v) { return std::atan2(v.x(), -v.z()); };
    const auto down_roll = [out](const Eigen::Vector3d& v) {
      return std::atan2(out * v.y(), std::hypot(v.x(), v.z()));
    };
    const auto body = [side](KeyBody left) { return of_side(left, side); };
    const Positions thigh = curves.direction(body(KeyBody::left_hip), body(KeyBody::left_knee));
    const Positions shank = curves.direction(body(KeyBody::left_knee), body(KeyBody::left_ankle));
    const Positions upper_arm = curves.direction(body(KeyBody::left_shoulder), body(KeyBody::left_elbow));
    const Positions forearm = curves.direction(body(KeyBody::left_elbow), body(KeyBody::left_wrist));
    curves.add(name + "thigh_pitch", thigh, down_pitch);
    curves.add(name + "thigh_roll", thigh, down_roll);
    curves.add_bend(name + "knee_flexion", thigh, shank);
    curves.add(name + "foot_pitch", curves.direction(body(KeyBody::left_ankle), body(KeyBody::left_toe)),
               [](const Eigen::Vector3d& v) { return std::atan2(v.z(), v.x()); });
    curves.add(name + "upper_arm_pitch", upper_arm, down_pitch);
    curves.add(name + "upper_arm_roll", upper_arm, down_roll);
    curves.add_bend(name + "elbow_flexion", upper_arm, forearm);
  }
  return angles;
}

}  // namespace pmg::mocap
