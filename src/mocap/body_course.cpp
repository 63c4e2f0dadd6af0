#include <algorithm>
#include <cmath>

#include "fitting/statistics.hpp"
#include "mocap/activities.hpp"

namespace pmg::mocap {
namespace {

/// From right to left, horizontal: of the hips, of the shoulders, or of the pelvis' own y axis.
Eigen::Vector2d to_left(const Recording& recording, std::size_t frame) {
  for (const KeyBody left : {KeyBody::left_hip, KeyBody::left_asis, KeyBody::left_shoulder}) {
    const Body &l = recording.body(left), &r = recording.body(of_side(left, Side::right));
    if (l.known() && r.known()) return (l.position_m[frame] - r.position_m[frame]).head<2>();
  }
  const Body& pelvis = recording.body(KeyBody::pelvis);
  if (pelvis.orientation.empty()) return Eigen::Vector2d::UnitY();
  return (pelvis.orientation[frame] * Eigen::Vector3d::UnitY()).head<2>();
}

}  // namespace

BodyCourse course_of(const Recording& recording) {
  BodyCourse course;
  const Body &pelvis = recording.body(KeyBody::pelvis), &neck = recording.body(KeyBody::neck);
  if (!pelvis.known()) return course;
  const double ground_m = ground_height_m(recording);
  std::vector<double> heights;
  for (std::size_t f = 0; f < recording.frames; ++f) {
    course.pelvis_m.push_back(pelvis.position_m[f] - ground_m * Eigen::Vector3d::UnitZ());
    heights.push_back(course.pelvis_m.back().z());
    const Eigen::Vector2d left = to_left(recording, f);
    course.heading_rad.push_back(std::atan2(-left.x(), left.y()));  // forward is left turned right
  }
  unwrap(course.heading_rad);
  for (std::size_t f = 0; neck.known() && f < recording.frames; ++f) {
    const Eigen::Vector3d up = Eigen::AngleAxisd(-course.heading_rad[f], Eigen::Vector3d::UnitZ()) *
                               Eigen::Vector3d(neck.position_m[f] - pelvis.position_m[f]);
    course.pitch_rad.push_back(std::atan2(up.x(), up.z()));
    course.roll_rad.push_back(std::atan2(-up.y(), std::hypot(up.x(), up.z())));
  }
  course.standing_height_m = fitting::quantile(heights, 0.9);
  return course;
}

}  // namespace pmg::mocap
