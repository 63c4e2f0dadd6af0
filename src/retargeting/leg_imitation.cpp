#include "retargeting/leg_imitation.hpp"

#include <ceres/autodiff_cost_function.h>

#include <array>

#include "retargeting/fit_angles.hpp"

namespace pmg::retargeting {
namespace {
using generator::kLegJoints;
using generator::LegGeometry;
using generator::LegVector;
using generator::Matrix3;
using generator::Vector3;

template <typename T>
struct Directions {
  Vector3<T> thigh, shank, sole, lateral;
  Vector3<T> hip, knee, ankle;  // in the base frame [m]
  Matrix3<T> R;                 // of the foot
};

/// Walks the chain once, keeping the origins of hip, knee and ankle.
template <typename T>
Directions<T> directions(const LegGeometry& leg, const T* q) {
  using std::cos;
  using std::sin;
  Matrix3<T> R = Matrix3<T>::Identity();
  Vector3<T> p = Vector3<T>::Zero(), hip = p, knee = p, ankle = p;
  for (const LegGeometry::Segment& segment : leg.segments) {
    p += R * segment.p.cast<T>();
    if (segment.role == generator::kKnee)
      knee = p;
    else if (segment.role == generator::kAnklePitch || segment.role == generator::kAnkleRoll)
      ankle = p;
    else
      hip = p;
    const T angle = q[segment.role];
    const Eigen::Matrix3d K{{0.0, -segment.axis.z(), segment.axis.y()},
                            {segment.axis.z(), 0.0, -segment.axis.x()},
                            {-segment.axis.y(), segment.axis.x(), 0.0}};
    const Matrix3<T> turn =
        Matrix3<T>::Identity() + sin(angle) * K.cast<T>() + (T(1.0) - cos(angle)) * (K * K).cast<T>();
    R = R * segment.R.cast<T>() * turn;
  }
  const Eigen::Vector3d forward = (leg.sole[0] + leg.sole[1] - leg.sole[2] - leg.sole[3]).normalized();
  const Eigen::Vector3d left = (leg.sole[0] - leg.sole[1] + leg.sole[2] - leg.sole[3]).normalized();
  return {(knee - hip).normalized(),
          (ankle - knee).normalized(),
          R * forward.cast<T>(),
          R * left.cast<T>(),
          hip,
          knee,
          ankle,
          R};
}

struct ImitationResiduals {
  static constexpr int kCount = 10 + kLegJoints;
  const LegGeometry& leg;
  const SidePose& human;
  const LegVector<double>& before;

  template <typename T>
  bool operator()(const T* q, T* residual) const {
    const Directions<T> robot = directions(leg, q);
    for (Eigen::Index i = 0; i < 3; ++i) {
      residual[i] = robot.thigh[i] - human.thigh[i];
      residual[3 + i] = robot.shank[i] - human.shank[i];
      residual[6 + i] = robot.sole[i] - human.sole[i];
    }
    residual[9] = robot.lateral.z();
    // A straight leg leaves the hip's yaw open.
    constexpr double kNear = 0.01;
    for (int i = 0; i < kLegJoints; ++i) residual[10 + i] = kNear * (q[i] - before[i]);
    return true;
  }
};

}  // namespace

SidePose leg_directions(const LegGeometry& leg, const LegVector<double>& q) {
  const Directions<double> at = directions<double>(leg, q.data());
  SidePose pose;
  pose.thigh = at.thigh;
  pose.shank = at.shank;
  pose.sole = at.sole;
  return pose;
}

LegPoints leg_points(const LegGeometry& leg, const LegVector<double>& q) {
  const Directions<double> at = directions<double>(leg, q.data());
  LegPoints points{at.hip, at.knee, at.ankle, {}};
  for (std::size_t i = 0; i < leg.sole.size(); ++i) points.sole[i] = at.ankle + at.R * leg.sole[i];
  return points;
}

double leg_length_m(const LegGeometry& leg) {
  double length_m = 0.0;
  std::size_t i = 0;
  while (i < leg.segments.size() && leg.segments[i].role != generator::kKnee) ++i;
  for (; i < leg.segments.size(); ++i) length_m += leg.segments[i].p.norm();
  return length_m;
}

std::vector<generator::LegPose> imitate_legs(const generator::RobotLegs& legs, const std::vector<HumanPose>& poses,
                                             double margin_rad) {
  std::vector<generator::LegPose> result;
  generator::LegPose before = legs.stand;
  for (const HumanPose& pose : poses) {
    for (const Foot foot : {kLeft, kRight}) {
      LegVector<double> q = before[foot];
      using Cost = ceres::AutoDiffCostFunction<ImitationResiduals, ImitationResiduals::kCount, kLegJoints>;
      fit_angles(new Cost(new ImitationResiduals{legs.geometry[foot], pose.side[foot], before[foot]}),
                 legs.lower[foot].array() + margin_rad, legs.upper[foot].array() - margin_rad, q.data());
      before[foot] = q;
    }
    result.push_back(before);
  }
  return result;
}

}  // namespace pmg::retargeting
