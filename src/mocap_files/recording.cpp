#include "mocap_files/recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "files/config_error.hpp"
#include "mocap_files/marker_gaps.hpp"
#include "mocap_files/unit_guess.hpp"

namespace pmg::mocap {
namespace {

using Positions = std::vector<Eigen::Vector3d>;

/// Names of a file in messages: printable ASCII alone.
std::string printable(const std::string& name) {
  std::string text;
  for (const char c : name.substr(0, 60)) text += c >= ' ' && c <= '~' ? c : '?';
  return text;
}

/// The points of "A + B + C"; empty if one of them isn't in the motion.
std::vector<const Point*> points_named(const Motion& motion, const std::string& names) {
  std::vector<const Point*> found;
  for (std::size_t at = 0; at <= names.size();) {
    const std::size_t plus = std::min(names.find('+', at), names.size());
    const std::string wanted = plain_name(names.substr(at, plus - at));
    const auto point =
        std::ranges::find_if(motion.points, [&](const Point& p) { return plain_name(p.name) == wanted; });
    if (wanted.empty() || point == motion.points.end()) return {};
    found.push_back(&*point);
    at = plus + 1;
  }
  return found;
}

Body find_body(const Motion& motion, const std::vector<std::string>& names) {
  Body body;
  for (const std::string& name : names) {
    const std::vector<const Point*> points = points_named(motion, name);
    if (points.empty()) continue;
    body.from = printable(points.size() == 1 ? points[0]->name : name);
    body.position_m.assign(motion.frames, Eigen::Vector3d::Zero());
    for (const Point* point : points) {
      for (std::size_t f = 0; f < motion.frames; ++f) {
        body.position_m[f] += point->position[f] / static_cast<double>(points.size());
      }
    }
    if (points.size() == 1) body.orientation = points[0]->orientation;
    if (std::ranges::any_of(body.position_m, [](const Eigen::Vector3d& p) { return p.allFinite(); })) return body;
    body = {};  // never seen
  }
  return body;
}

Body& at(Recording& recording, KeyBody key) { return recording.bodies[static_cast<std::size_t>(key)]; }

/// The pelvis from the iliac spines, and the hip centres by Harrington's regression [m]: from the middle of the front
/// spines, in pelvis axes (forward, up, right), with pelvic depth and width in mm:
///   forward -0.24 depth - 9.9, up -0.30 width - 10.9, right +-(0.33 width + 7.3).
void add_pelvis_of_markers(Recording& recording, double metres_a_unit) {
  const Body &la = recording.body(KeyBody::left_asis), &ra = recording.body(KeyBody::right_asis);
  const Body &lp = recording.body(KeyBody::left_psis), &rp = recording.body(KeyBody::right_psis);
  if (!la.known() || !ra.known() || !lp.known() || !rp.known()) return;
  Body pelvis, left, right;
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const Eigen::Vector3d front = (la.position_m[f] + ra.position_m[f]) / 2.0,
                          back = (lp.position_m[f] + rp.position_m[f]) / 2.0;
    const Eigen::Vector3d across = ra.position_m[f] - la.position_m[f];
    const double width = across.norm() * metres_a_unit, depth = (front - back).norm() * metres_a_unit;
    const Eigen::Vector3d y_right = across.normalized();
    const Eigen::Vector3d x_raw = front - back;
    const Eigen::Vector3d x_forward = (x_raw - x_raw.dot(y_right) * y_right).normalized();
    const Eigen::Vector3d z_up = y_right.cross(x_forward);
    const auto hip = [&](double side) -> Eigen::Vector3d {
      return front + ((-0.24 * depth - 0.0099) * x_forward + (-0.30 * width - 0.0109) * z_up +
                      side * (0.33 * width + 0.0073) * y_right) /
                         metres_a_unit;
    };
    left.position_m.push_back(hip(-1.0));
    right.position_m.push_back(hip(1.0));
    pelvis.position_m.emplace_back((front + back) / 2.0);
  }
  pelvis.from = "middle of the iliac spines";
  left.from = right.from = "regression from the iliac spines";
  if (!recording.body(KeyBody::pelvis).known()) at(recording, KeyBody::pelvis) = pelvis;
  if (!recording.body(KeyBody::left_hip).known()) at(recording, KeyBody::left_hip) = left;
  if (!recording.body(KeyBody::right_hip).known()) at(recording, KeyBody::right_hip) = right;
}

void set_unit(Recording& recording, const Motion& motion, const RecordingOptions& options) {
  const double leg = median_leg_length(recording);  // in the file's unit
  if (options.unit_m || motion.unit_m) {
    recording.unit_m = options.unit_m ? *options.unit_m : *motion.unit_m;
    recording.unit_from = options.unit_m ? "given" : fmt::format("the file says {}", printable(motion.unit_name));
  } else if (leg > 0.0) {
    const UnitGuess guess = guess_unit(leg);
    recording.unit_m = guess.unit_m;
    recording.unit_from = guess.reason;
  } else {
    recording.unit_from = "assumed: neither the file nor legs tell it";
  }
  recording.leg_length_m = leg * recording.unit_m;
  if (leg > 0.0 && !plausible_leg(recording.leg_length_m)) {
    recording.notes.push_back(
        fmt::format("the legs are {:.3g} m long: is the unit right? --unit sets it", recording.leg_length_m));
  }
}

/// Toes point forward, which is up cross right-to-left of the hips. If not, sides are exchanged or the axes
/// left-handed.
void check_sides(Recording& recording) {
  double forward = 0.0;
  for (const Side side : {Side::left, Side::right}) {
    const Body &ankle = recording.body(of_side(KeyBody::left_ankle, side)),
               &toe = recording.body(of_side(KeyBody::left_toe, side));
    const Body &left = recording.body(KeyBody::left_hip), &right = recording.body(KeyBody::right_hip);
    if (!ankle.known() || !toe.known() || !left.known() || !right.known()) return;
    for (std::size_t f = 0; f < recording.frames; ++f) {
      const Eigen::Vector3d to_left = left.position_m[f] - right.position_m[f];
      forward += (toe.position_m[f] - ankle.position_m[f]).dot(to_left.cross(Eigen::Vector3d::UnitZ()).normalized());
    }
  }
  if (forward < 0.0)
    recording.notes.emplace_back("the toes point backwards: left and right are exchanged, or the axes are left-handed");
}

/// Damaged files have numbers whose squares overflow. No place of a person is as far away.
void expect_bounded_positions(const Recording& recording) {
  constexpr double kFarthest_m = 1e6;
  for (std::size_t b = 0; b < kKeyBodies; ++b) {
    const Body& body = recording.bodies[b];
    for (std::size_t f = 0; f < body.position_m.size(); ++f) {
      if (body.position_m[f].cwiseAbs().maxCoeff() <= kFarthest_m && body.position_m[f].allFinite()) continue;
      files::raise({recording.file}, kKeyBodyNames[b],
                   fmt::format("is {:.3g} m away in frame {}", body.position_m[f].cwiseAbs().maxCoeff(), f + 1),
                   fmt::format("at most {:g} m: a sound file, and its unit", kFarthest_m));
    }
  }
}

}  // namespace

Recording make_recording(const std::string& file, Motion motion, const NameTable& names,
                         const RecordingOptions& options) {
  Recording recording;
  recording.file = file;
  recording.format = motion.format;
  recording.markers = motion.markers;
  recording.frames = motion.frames;
  recording.notes = motion.notes;
  recording.rate_hz =
      options.rate_hz ? *options.rate_hz : motion.rate_hz.value_or(motion.format == "robot CSV" ? 30.0 : 120.0);
  recording.rate_from = options.rate_hz  ? "given"
                        : motion.rate_hz ? "the file"
                                         : "assumed, as the file has none: --rate sets it";
  for (std::size_t b = 0; b < kKeyBodies; ++b) {
    recording.bodies[b] = find_body(motion, names[b]);
    if (recording.bodies[b].known())
      fill_gaps(recording.bodies[b].position_m, kKeyBodyNames[b], recording.rate_hz, recording.notes);
  }
  for (const Side side : {Side::left, Side::right}) {  // a foot that is the ankle already is no toe
    Body& toe = at(recording, of_side(KeyBody::left_toe, side));
    if (toe.from == recording.body(of_side(KeyBody::left_ankle, side)).from) toe = {};
  }
  if (std::ranges::none_of(recording.bodies, &Body::known)) {
    std::vector<std::string> some;
    for (std::size_t i = 0; i < std::min<std::size_t>(motion.points.size(), 8); ++i)
      some.push_back(printable(motion.points[i].name));
    files::raise({file}, "", fmt::format("none of its names is known ({}, ...)", fmt::join(some, ", ")),
                 "names of the table, which --names FILE replaces");
  }
  // Harrington's regression has lengths in it: it needs the unit, and so does without hips only if the file states one.
  const std::optional<double> unit = options.unit_m ? options.unit_m : motion.unit_m;
  if (unit) add_pelvis_of_markers(recording, *unit);
  set_unit(recording, motion, options);
  const Eigen::Matrix3d to_z_up = rotation_to_z_up(recording, options.up);
  for (Body& body : recording.bodies) {
    for (Eigen::Vector3d& p : body.position_m) p = recording.unit_m * (to_z_up * p);
    for (Eigen::Quaterniond& q : body.orientation) q = (Eigen::Quaterniond(to_z_up) * q).normalized();
  }
  expect_bounded_positions(recording);
  check_sides(recording);
  for (const Point& point : motion.points) recording.skeleton.push_back({printable(point.name), point.parent, {}, {}});
  for (const std::string& joint : motion.joints) recording.joints.push_back(printable(joint));
  recording.joint_rad = std::move(motion.joint_rad);
  return recording;
}

}  // namespace pmg::mocap
