#include "robot_diagnosis/robot_parameters.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/variation.hpp"
#include "sim/world.hpp"

namespace pmg::robot_diagnosis {

namespace {

using Kind = RobotParameter::Kind;

/// Adds the parameters link by link and joint by joint.
class ParameterListBuilder {
 public:
  ParameterListBuilder(const model::RobotModel& robot, const RobotTolerances& tolerances, const RobotCauseSizes& sizes)
      : robot_(robot), tolerances_(tolerances), sizes_(sizes), moved_kg_m2_(moved_inertia_kg_m2(robot)) {}

  RobotParameterList build() {
    add_links();
    add_torso();
    add_hands();
    add_imu();
    for (int j = 0; j < robot_.joint_index.size(); ++j) add_joint(j);
    return std::move(list_);
  }

 private:
  int add(RobotParameter parameter) {
    list_.parameters.push_back(std::move(parameter));
    return static_cast<int>(list_.parameters.size()) - 1;
  }

  void add_links() {
    for (const auto& [name, link] : robot_.urdf->links_) {
      if (!link->inertial || link->inertial->mass < sizes_.lightest_link_kg) continue;
      add({.kind = Kind::kLinkMass, .link = name, .tolerance = tolerances_.link_mass_share, .wide = 0.0});
    }
  }

  void add_torso() {
    const int mass = add({.kind = Kind::kTorsoMass,
                          .link = robot_.torso_link,
                          .tolerance = tolerances_.payload_kg,
                          .wide = sizes_.torso_payload_kg.wide,
                          .relevant = sizes_.torso_payload_kg.relevant});
    list_.candidates.push_back({"payload", robot_.torso_link, {mass}});
    std::vector<int> center;
    for (int axis = 0; axis < 3; ++axis) {
      center.push_back(add({.kind = Kind::kTorsoCenter,
                            .link = robot_.torso_link,
                            .axis = axis,
                            .tolerance = tolerances_.torso_center_m,
                            .wide = sizes_.torso_center_m.wide,
                            .relevant = sizes_.torso_center_m.relevant}));
    }
    list_.candidates.push_back({"center_of_mass", robot_.torso_link, center});
  }

  void add_hands() {
    PerFoot<std::string> hands;
    try {
      hands = sim::hand_links(robot_);
    } catch (const std::invalid_argument&) {  // a robot without hands
      return;
    }
    for (const std::string& hand : hands) {
      const int payload = add({.kind = Kind::kHandPayload,
                               .link = hand,
                               .tolerance = tolerances_.payload_kg,
                               .wide = sizes_.hand_payload_kg.wide,
                               .relevant = sizes_.hand_payload_kg.relevant});
      list_.candidates.push_back({"payload", hand, {payload}});
    }
  }

  void add_imu() {
    std::vector<int> imu;
    for (int axis = 0; axis < 3; ++axis) {
      imu.push_back(add({.kind = Kind::kImu,
                         .link = robot_.imu.link,
                         .axis = axis,
                         .tolerance = tolerances_.imu_rad,
                         .wide = sizes_.imu_rad.wide,
                         .relevant = sizes_.imu_rad.relevant}));
    }
    list_.candidates.push_back({"imu_mounting", robot_.imu.link, imu});
  }

  void add_joint(int j) {
    const model::Joint& joint = robot_.joints[static_cast<std::size_t>(j)];
    const RobotTolerances& t = tolerances_;
    const auto effect = [&](const char* name, Kind kind, double tolerance, const CauseSize& size, double scale = 1.0) {
      const int index = add({.kind = kind,
                             .joint = j,
                             .tolerance = tolerance,
                             .wide = size.wide * scale,
                             .relevant = size.relevant * scale});
      list_.candidates.push_back({name, joint.name, {index}});
    };
    effect("gain", Kind::kKp, t.kp_share, sizes_.kp_share);
    effect("damping_gain", Kind::kKd, t.kd_share, sizes_.kd_share);
    const double friction_Nm = std::max(joint.friction_Nm, sizes_.coulomb_least_of_effort * joint.effort_limit_Nm);
    effect("coulomb", Kind::kCoulomb, std::max<double>(t.friction_share * joint.friction_Nm, t.friction_least_Nm),
           sizes_.coulomb_share, friction_Nm);
    const double viscous = std::max<double>(joint.damping_Nm_s_per_rad, sizes_.viscous_least_Nm_s_per_rad);
    effect("viscous", Kind::kViscous, t.friction_share * viscous, sizes_.viscous_share, viscous);
    const double armature = std::max<double>(joint.armature_kg_m2, sizes_.armature_least_kg_m2);
    effect("armature", Kind::kArmature, std::hypot(t.armature_share * armature, t.inertia_share * moved_kg_m2_[j]),
           sizes_.armature_share, armature);
    effect("zero_offset", Kind::kZeroOffset, t.zero_offset_rad, sizes_.zero_offset_rad);
    effect("delay", Kind::kDelay, t.delay_s, sizes_.delay_s);
  }

  const model::RobotModel& robot_;
  const RobotTolerances& tolerances_;
  const RobotCauseSizes& sizes_;
  const JointVector moved_kg_m2_;
  RobotParameterList list_;
};

const char* axis_name(int axis) { return axis == 0 ? "x" : axis == 1 ? "y" : "z"; }

}  // namespace

JointVector moved_inertia_kg_m2(const model::RobotModel& robot) {
  const sim::World world(robot, {});
  const mjModel* m = world.mj_model();
  JointVector inertia(robot.joint_index.size());
  for (int j = 0; j < inertia.size(); ++j)
    inertia[j] = m->dof_M0[m->jnt_dofadr[mj_name2id(m, mjOBJ_JOINT, robot.joint_index.name(j).c_str())]];
  return inertia;
}

RobotParameterList robot_parameters(const model::RobotModel& robot, const RobotTolerances& tolerances,
                                    const RobotCauseSizes& sizes) {
  return ParameterListBuilder(robot, tolerances, sizes).build();
}

std::string name(const RobotParameter& parameter) {
  switch (parameter.kind) {
    case Kind::kLinkMass:
      return "link_mass_share";
    case Kind::kTorsoMass:
    case Kind::kHandPayload:
      return "mass_kg";
    case Kind::kTorsoCenter:
      return std::string("shift_") + axis_name(parameter.axis) + "_m";
    case Kind::kImu:
      return std::string("rotation_") + axis_name(parameter.axis) + "_rad";
    case Kind::kKp:
      return "kp_error_share";
    case Kind::kKd:
      return "kd_error_share";
    case Kind::kCoulomb:
      return "coulomb_more_Nm";
    case Kind::kViscous:
      return "viscous_more_Nm_s_per_rad";
    case Kind::kArmature:
      return "armature_more_kg_m2";
    case Kind::kZeroOffset:
      return "zero_offset_rad";
    case Kind::kDelay:
      return "delay_s";
  }
  throw std::logic_error("no such parameter");
}

std::string unit(const RobotParameter& parameter) {
  switch (parameter.kind) {
    case Kind::kLinkMass:
    case Kind::kKp:
    case Kind::kKd:
      return "1";
    case Kind::kTorsoMass:
    case Kind::kHandPayload:
      return "kg";
    case Kind::kTorsoCenter:
      return "m";
    case Kind::kImu:
    case Kind::kZeroOffset:
      return "rad";
    case Kind::kCoulomb:
      return "Nm";
    case Kind::kViscous:
      return "Nm s/rad";
    case Kind::kArmature:
      return "kg m^2";
    case Kind::kDelay:
      return "s";
  }
  throw std::logic_error("no such parameter");
}

}  // namespace pmg::robot_diagnosis
