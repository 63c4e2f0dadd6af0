#include "retargeting/human_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "files/config_error.hpp"
#include "mocap/activities.hpp"
#include "mocap/gait_events.hpp"
#include "mocap/signals.hpp"

namespace pmg::retargeting {
namespace {
using mocap::KeyBody;
using mocap::Positions;
using mocap::Recording;
using mocap::Side;

constexpr std::size_t kDirections = 5;  // of a side: thigh, shank, sole, upper arm, forearm
constexpr std::size_t kOthers = 3;      // pelvis roll, shoulder yaw, pelvis to the left

void expect_legs(const Recording& recording) {
  for (const KeyBody left : {KeyBody::left_hip, KeyBody::left_knee, KeyBody::left_ankle, KeyBody::left_toe}) {
    for (const Side side : {Side::left, Side::right}) {
      const KeyBody key = of_side(left, side);
      if (!recording.body(key).known() || !recording.body(KeyBody::pelvis).known()) {
        files::raise({recording.file}, "",
                     std::string("lacks ") + mocap::kKeyBodyNames[static_cast<std::size_t>(key)] + " or pelvis",
                     "pelvis, hips, knees, ankles and toes, by the names of config/mocap/names.yaml");
      }
    }
  }
}

/// Positions interpolated and smoothed as for gait events.
class FineRecording {
 public:
  explicit FineRecording(const Recording& coarse) : factor_(mocap::finer_factor(coarse.rate_hz, options_.rate_hz)) {
    recording_.rate_hz = coarse.rate_hz * factor_;
    for (std::size_t b = 0; b < mocap::kKeyBodies; ++b) {
      if (!coarse.bodies[b].known()) continue;
      recording_.bodies[b].position_m = fine(coarse.bodies[b].position_m);
      recording_.frames = recording_.bodies[b].position_m.size();
    }
    for (const Side side : {Side::left, Side::right}) {
      const mocap::Sole sole = mocap::sole_of(coarse, side);
      sole_[static_cast<std::size_t>(side)] = {fine(sole.heel), fine(sole.toe)};
    }
  }
  const Recording& recording() const { return recording_; }
  const mocap::Sole& sole(Side side) const { return sole_[static_cast<std::size_t>(side)]; }

 private:
  Positions fine(const Positions& coarse) const {
    return mocap::smoothed(mocap::finer(coarse, factor_), recording_.rate_hz, options_.smoothing_s);
  }
  mocap::GaitEventOptions options_;
  int factor_;
  Recording recording_;
  std::array<mocap::Sole, 2> sole_;
};

/// The frame that turns steadily: yaw = first + rate (t - from).
struct SteadyHeading {
  double first_rad = 0.0, rate_rad_s = 0.0, from_s = 0.0;
  double at(double t_s) const { return first_rad + rate_rad_s * (t_s - from_s); }
};

std::pair<std::size_t, std::size_t> frames_between(const Recording& recording, double from_s, double to_s) {
  const auto last = static_cast<double>(recording.frames - 1);
  const auto frame = [&](double t_s) {
    return static_cast<std::size_t>(std::lround(std::clamp(t_s * recording.rate_hz, 0.0, last)));
  };
  return {frame(from_s), frame(to_s)};
}

SteadyHeading steady_heading(const Recording& recording, const mocap::BodyCourse& course, double from_s, double to_s) {
  const auto [first, last] = frames_between(recording, from_s, to_s);
  SteadyHeading steady{0.0, (course.heading_rad[last] - course.heading_rad[first]) / (to_s - from_s), from_s};
  double sum = 0.0;
  for (std::size_t f = first; f < last; ++f)
    sum += course.heading_rad[f] - steady.at(static_cast<double>(f) / recording.rate_hz);
  steady.first_rad = sum / static_cast<double>(last - first);
  return steady;
}

Eigen::Vector3d direction(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d d = to - from;
  return d.norm() > 0.0 ? Eigen::Vector3d(d.normalized()) : d;
}

double unit_atan(const Eigen::Vector3d& v) { return std::atan2(v.z(), std::hypot(v.x(), v.y())); }

}  // namespace

PoseCurves pose_curves(const Recording& coarse, double from_s, double to_s) {
  expect_legs(coarse);
  const FineRecording fine(coarse);
  const Recording& recording = fine.recording();
  const mocap::BodyCourse course = mocap::course_of(recording);
  const SteadyHeading heading = steady_heading(recording, course, from_s, to_s);
  PoseCurves result;
  result.arms_known = true;
  for (const KeyBody left : {KeyBody::left_shoulder, KeyBody::left_elbow, KeyBody::left_wrist}) {
    for (const Side side : {Side::left, Side::right})
      result.arms_known = result.arms_known && recording.body(of_side(left, side)).known();
  }
  result.curves.rate_hz = recording.rate_hz;
  result.curves.angle_rad.resize(2 * kDirections * 3 + kOthers);
  result.curves.names.resize(result.curves.angle_rad.size());

  const auto [first, last] = frames_between(recording, from_s, to_s);
  const double cycle_s = static_cast<double>(last - first) / recording.rate_hz;
  for (std::size_t f = first; f < last; ++f) {
    const Eigen::AngleAxisd back(-heading.at((static_cast<double>(f) + 0.5) / recording.rate_hz),
                                 Eigen::Vector3d::UnitZ());
    result.mean_velocity += back * (course.pelvis_m[f + 1] - course.pelvis_m[f]) / cycle_s;
  }
  result.mean_velocity.z() = heading.rate_rad_s;

  double left_m = 0.0;
  for (std::size_t f = 0; f < recording.frames; ++f) {
    const Eigen::Matrix3d back =
        Eigen::AngleAxisd(-heading.at(static_cast<double>(f) / recording.rate_hz), Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
    const auto at = [&](KeyBody key) -> const Eigen::Vector3d& { return recording.body(key).position_m[f]; };
    std::size_t curve = 0;
    const auto add = [&](double value) { result.curves.angle_rad[curve++].push_back(value); };
    const auto add_direction = [&](const Eigen::Vector3d& d) {
      const Eigen::Vector3d seen = back * d;
      for (const double value : {seen.x(), seen.y(), seen.z()}) add(value);
    };
    for (const Side side : {Side::left, Side::right}) {
      const auto body = [&](KeyBody left) -> const Eigen::Vector3d& { return at(of_side(left, side)); };
      add_direction(direction(body(KeyBody::left_hip), body(KeyBody::left_knee)));
      add_direction(direction(body(KeyBody::left_knee), body(KeyBody::left_ankle)));
      add_direction(direction(fine.sole(side).heel[f], fine.sole(side).toe[f]));
      add_direction(result.arms_known ? direction(body(KeyBody::left_shoulder), body(KeyBody::left_elbow))
                                      : Eigen::Vector3d(-Eigen::Vector3d::UnitZ()));
      add_direction(result.arms_known ? direction(body(KeyBody::left_elbow), body(KeyBody::left_wrist))
                                      : Eigen::Vector3d(-Eigen::Vector3d::UnitZ()));
    }
    add(unit_atan(at(KeyBody::left_hip) - at(KeyBody::right_hip)));
    double shoulder_yaw = 0.0;
    if (result.arms_known) {
      const Eigen::Vector3d left = back * (at(KeyBody::left_shoulder) - at(KeyBody::right_shoulder));
      shoulder_yaw = std::atan2(-left.x(), left.y());
    }
    add(shoulder_yaw);
    // Sideways of the line that the pelvis would follow at its mean velocity.
    if (f > 0) {
      const Eigen::Vector3d step = back * (course.pelvis_m[f] - course.pelvis_m[f - 1]);
      left_m += step.y() - result.mean_velocity.y() / recording.rate_hz;
    }
    add(left_m);
  }
  return result;
}

HumanPose pose_of(const std::vector<double>& values, bool arms_known) {
  HumanPose pose;
  pose.arms_known = arms_known;
  std::size_t at = 0;
  const auto next = [&] {
    const Eigen::Vector3d d(values[at], values[at + 1], values[at + 2]);
    at += 3;
    return d.norm() > 0.0 ? Eigen::Vector3d(d.normalized()) : d;
  };
  for (SidePose& side : pose.side) {
    side.thigh = next();
    side.shank = next();
    side.sole = next();
    side.upper_arm = next();
    side.forearm = next();
  }
  pose.pelvis_roll_rad = values[at];
  pose.shoulder_yaw_rad = values[at + 1];
  pose.pelvis_left_m = values[at + 2];
  return pose;
}

Recording mirrored(const Recording& recording) {
  Recording image = recording;
  for (mocap::Body& body : image.bodies) {
    for (Eigen::Vector3d& p : body.position_m) p.y() = -p.y();
    for (Eigen::Quaterniond& q : body.orientation) q = Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z());
  }
  for (std::size_t b = 0; b < mocap::kKeyBodies; ++b) {
    const std::string name = mocap::kKeyBodyNames[b];
    if (name.starts_with("left_")) std::swap(image.bodies[b], image.bodies[b + 1]);
  }
  return image;
}

double thigh_pitch_rad(const SidePose& pose) { return std::atan2(pose.thigh.x(), -pose.thigh.z()); }

double knee_flexion_rad(const SidePose& pose) {
  return std::atan2(pose.thigh.cross(pose.shank).norm(), pose.thigh.dot(pose.shank));
}

double ankle_flexion_rad(const SidePose& pose) {
  return unit_atan(pose.sole) - std::atan2(pose.shank.x(), -pose.shank.z());
}

}  // namespace pmg::retargeting
