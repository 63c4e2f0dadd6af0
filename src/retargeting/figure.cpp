#include "retargeting/figure.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "generator/joint_roles.hpp"
#include "generator/leg_geometry.hpp"
#include "mocap/activities.hpp"
#include "mocap/gait_events.hpp"
#include "model/leg_kinematics.hpp"
#include "retargeting/arm_points.hpp"
#include "retargeting/leg_imitation.hpp"

namespace pmg::retargeting {
namespace {
using mocap::KeyBody;
using mocap::Side;

std::optional<Eigen::Vector3d>& at(Figure& figure, KeyBody key) { return figure[static_cast<std::size_t>(key)]; }

/// Linear between the frames around it.
Eigen::Vector3d between(const mocap::Positions& positions, double frame) {
  const double last = static_cast<double>(positions.size()) - 1.0;
  const double clamped = std::clamp(frame, 0.0, last);
  const auto before = static_cast<std::size_t>(clamped), after = std::min(before + 1, positions.size() - 1);
  const double share = clamped - std::floor(clamped);
  return (1.0 - share) * positions[before] + share * positions[after];
}

double between(const std::vector<double>& values, double frame) {
  const double clamped = std::clamp(frame, 0.0, static_cast<double>(values.size()) - 1.0);
  const auto before = static_cast<std::size_t>(clamped), after = std::min(before + 1, values.size() - 1);
  const double share = clamped - std::floor(clamped);
  return (1.0 - share) * values[before] + share * values[after];
}

void add_arm(ArmChain& arm, const JointVector& q, const Eigen::Matrix3d& R_HB, Side side, Figure& figure) {
  const ArmPoints points = arm.compute(q);
  at(figure, of_side(KeyBody::left_shoulder, side)) = R_HB * points.shoulder;
  at(figure, of_side(KeyBody::left_elbow, side)) = R_HB * points.elbow;
  at(figure, of_side(KeyBody::left_wrist, side)) = R_HB * points.wrist;
}

}  // namespace

const std::vector<std::pair<KeyBody, KeyBody>>& figure_bones() {
  static const std::vector<std::pair<KeyBody, KeyBody>> bones = [] {
    std::vector<std::pair<KeyBody, KeyBody>> list = {{KeyBody::pelvis, KeyBody::neck}, {KeyBody::neck, KeyBody::head}};
    for (const Side side : {Side::left, Side::right}) {
      const auto of = [side](KeyBody left) { return of_side(left, side); };
      for (const auto& [a, b] :
           {std::pair{KeyBody::left_hip, KeyBody::left_knee}, std::pair{KeyBody::left_knee, KeyBody::left_ankle},
            std::pair{KeyBody::left_ankle, KeyBody::left_heel}, std::pair{KeyBody::left_heel, KeyBody::left_toe},
            std::pair{KeyBody::left_ankle, KeyBody::left_toe}, std::pair{KeyBody::left_shoulder, KeyBody::left_elbow},
            std::pair{KeyBody::left_elbow, KeyBody::left_wrist}})
        list.emplace_back(of(a), of(b));
      list.emplace_back(KeyBody::pelvis, of(KeyBody::left_hip));
      list.emplace_back(KeyBody::neck, of(KeyBody::left_shoulder));
    }
    return list;
  }();
  return bones;
}

std::vector<Figure> figures_of(const mocap::Recording& recording, const HumanCycle& human) {
  const mocap::BodyCourse course = mocap::course_of(recording);
  const double ground_m = mocap::ground_height_m(recording);
  const std::array<mocap::Sole, 2> soles = {sole_of(recording, Side::left), sole_of(recording, Side::right)};
  const auto frame_of = [&](double t_s) { return t_s * recording.rate_hz; };
  // The frame that turns steadily, its yaw that of the pelvis in the mean.
  const double from = frame_of(human.cut.from_s), to = frame_of(human.cut.to_s);
  const double turned = between(course.heading_rad, to) - between(course.heading_rad, from);
  double first_yaw = 0.0;
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    first_yaw += (between(course.heading_rad, from + share * (to - from)) - share * turned) / kSteps;
  }
  std::vector<Figure> figures;
  for (const double phase : human.recorded_phase) {
    const double frame = from + phase * (to - from);
    const Eigen::AngleAxisd back(-(first_yaw + phase * turned), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d pelvis = between(recording.body(KeyBody::pelvis).position_m, frame);
    const Eigen::Vector3d origin(pelvis.x(), pelvis.y(), ground_m);
    const auto seen = [&](const mocap::Positions& of) { return Eigen::Vector3d(back * (between(of, frame) - origin)); };
    Figure figure;
    for (std::size_t b = 0; b < mocap::kKeyBodies; ++b) {
      if (recording.bodies[b].known()) figure[b] = seen(recording.bodies[b].position_m);
    }
    for (const Side side : {Side::left, Side::right}) {
      const mocap::Sole& sole = soles[static_cast<std::size_t>(side)];
      if (sole.heel.empty()) continue;
      at(figure, of_side(KeyBody::left_heel, side)) = seen(sole.heel);
      at(figure, of_side(KeyBody::left_toe, side)) = seen(sole.toe);
    }
    figures.push_back(figure);
  }
  return figures;
}

std::vector<Figure> figures_of(const model::RobotModel& robot, const DynamicClip& clip) {
  const generator::JointRoles roles = generator::find_joint_roles(robot);
  const PerFoot<generator::LegGeometry> legs = {leg_geometry(robot, roles, kLeft), leg_geometry(robot, roles, kRight)};
  PerFoot<std::optional<ArmChain>> arms = {ArmChain::of(robot, roles, kLeft), ArmChain::of(robot, roles, kRight)};
  model::BaseAttitude attitude(robot);
  model::ChainKinematics torso(robot.torso_chain, robot.torso_joints);
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < clip.q.size(); ++k) {
    const JointVector& q = clip.q[k];
    const Eigen::Matrix3d R_HB = attitude.compute(q, JointVector::Zero(q.size()), 0.0, 0.0, 0.0, 0.0).R_HB;
    Figure figure;
    at(figure, KeyBody::pelvis) = Eigen::Vector3d::Zero();
    double lowest_m = 0.0;
    for (const Foot foot : {kLeft, kRight}) {
      const auto side = static_cast<Side>(foot);
      generator::LegVector<double> leg;
      for (std::size_t role = 0; role < generator::kLegJoints; ++role)
        leg[static_cast<Eigen::Index>(role)] = q[roles.leg[foot][role]];
      const LegPoints points = leg_points(legs[foot], leg);
      at(figure, of_side(KeyBody::left_hip, side)) = R_HB * points.hip;
      at(figure, of_side(KeyBody::left_knee, side)) = R_HB * points.knee;
      at(figure, of_side(KeyBody::left_ankle, side)) = R_HB * points.ankle;
      at(figure, of_side(KeyBody::left_toe, side)) = R_HB * (0.5 * (points.sole[0] + points.sole[1]));
      at(figure, of_side(KeyBody::left_heel, side)) = R_HB * (0.5 * (points.sole[2] + points.sole[3]));
      for (const Eigen::Vector3d& corner : points.sole) lowest_m = std::min(lowest_m, (R_HB * corner).z());
      if (arms[foot]) add_arm(*arms[foot], q, R_HB, side, figure);
    }
    if (at(figure, KeyBody::left_shoulder) && at(figure, KeyBody::right_shoulder)) {
      at(figure, KeyBody::neck) = 0.5 * (*at(figure, KeyBody::left_shoulder) + *at(figure, KeyBody::right_shoulder));
    } else {
      torso.compute(q);
      at(figure, KeyBody::neck) = R_HB * torso.p();
    }
    for (std::optional<Eigen::Vector3d>& body : figure) {
      if (body) body->z() -= lowest_m;
    }
    figures.push_back(figure);
  }
  return figures;
}

}  // namespace pmg::retargeting
