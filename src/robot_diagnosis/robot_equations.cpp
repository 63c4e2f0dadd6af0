#include "robot_diagnosis/robot_equations.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "pmg/types.hpp"

namespace pmg::robot_diagnosis {

namespace {

constexpr int kBaseRows = 6, kTiltRows = 4, kHeightRows = 1, kGroundRows = kTiltRows + kHeightRows;
constexpr double kAngleStep_rad = 1e-5, kMassStep_kg = 0.01, kLengthStep_m = 1e-4;

using Kind = RobotParameter::Kind;

bool of_torque(Kind kind) {
  return kind == Kind::kKp || kind == Kind::kKd || kind == Kind::kCoulomb || kind == Kind::kViscous ||
         kind == Kind::kArmature || kind == Kind::kDelay;
}

/// Derivative of a joint's generalised-force residual by one parameter.
double missing_per_unit(const RobotParameter& p, const RobotSample& s) {
  switch (p.kind) {
    case Kind::kKp:
      return -s.spring_Nm[p.joint];
    case Kind::kKd:
      return -s.damper_Nm[p.joint];
    case Kind::kCoulomb:
      return s.direction[p.joint];
    case Kind::kViscous:
      return s.dq[p.joint];
    case Kind::kArmature:
      return s.ddq[p.joint];
    case Kind::kDelay:
      return -s.late_Nm_per_s[p.joint];
    default:
      return 0.0;
  }
}

Eigen::Matrix3d turned(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
}

}  // namespace

RobotEquations::RobotEquations(const model::RobotModel& robot, const RobotParameterList& list,
                               const SupportOptions& support)
    : robot_(robot), list_(list), support_(support), dynamics_(robot), joints_(robot.joint_index.size()) {
  torso_ = dynamics_.body(robot.torso_link);
  in_leg_.assign(static_cast<std::size_t>(joints_), false);
  below_torso_ = in_leg_;
  legs_of_six_ = true;
  for (const Foot foot : {kLeft, kRight}) {
    foot_body_[foot] = dynamics_.body(robot.feet[foot].link);
    legs_of_six_ = legs_of_six_ && robot.leg_joints[foot].size() == 6;
    for (const int j : robot.leg_joints[foot]) in_leg_[static_cast<std::size_t>(j)] = true;
  }
  for (const int j : robot.torso_joints) below_torso_[static_cast<std::size_t>(j)] = true;
}

int RobotEquations::kinds() const { return 3 * (joints_ + kBaseRows + kGroundRows); }

int RobotEquations::kind_of_joint(Support support, int joint) const {
  return static_cast<int>(support) * (joints_ + kBaseRows + kGroundRows) + joint;
}

std::string RobotEquations::kind_name(int kind) const {
  constexpr std::array<const char*, 3> kSupport{"hanging", "standing", "moving"};
  constexpr std::array<const char*, kBaseRows + kGroundRows> kWhole{"force x",
                                                                    "force y",
                                                                    "force z",
                                                                    "moment x",
                                                                    "moment y",
                                                                    "moment z",
                                                                    "left sole pitch",
                                                                    "left sole roll",
                                                                    "right sole pitch",
                                                                    "right sole roll",
                                                                    "difference of sole heights"};
  const int of = kind % (joints_ + kBaseRows + kGroundRows);
  const std::string what = of < joints_ ? robot_.joint_index.name(of) : kWhole[static_cast<std::size_t>(of - joints_)];
  return fmt::format("{}, {}", what, kSupport[static_cast<std::size_t>(kind / (joints_ + kBaseRows + kGroundRows))]);
}

std::vector<int> RobotEquations::joints_of_rows(Support support) const {
  std::vector<int> joints;
  for (int j = 0; j < joints_; ++j) {
    const auto index = static_cast<std::size_t>(j);
    if (support != Support::kHanging && in_leg_[index]) continue;
    if (support == Support::kLoose && below_torso_[index]) continue;
    joints.push_back(j);
  }
  return joints;
}

/// Generalised-force residual [N, Nm]: required minus nominal drive force, M(q) ddq + h + armature ddq + damping dq +
/// friction sign(dq) - (spring + damper + feed-forward torque). Contacts must supply it.
GeneralizedVector RobotEquations::missing(const RobotSample& s, const Change& change) {
  const Eigen::Matrix3d R_BI = robot_.imu.T_LI.linear() * turned(change.imu_rad);
  RobotMotion motion{.q = s.q,
                     .dq = s.dq,
                     .ddq = s.ddq,
                     .omega_B = R_BI * s.omega_I,
                     .alpha_B = R_BI * s.alpha_I,
                     .specific_force_B = R_BI * s.specific_force_I};
  if (change.joint >= 0) motion.q[change.joint] -= change.zero_offset_rad;
  GeneralizedVector force = dynamics_.required(motion);
  for (int j = 0; j < joints_; ++j) {
    const model::Joint& joint = robot_.joints[static_cast<std::size_t>(j)];
    force[6 + j] += joint.armature_kg_m2 * s.ddq[j] + joint.damping_Nm_s_per_rad * s.dq[j] +
                    joint.friction_Nm * s.direction[j] - s.spring_Nm[j] - s.damper_Nm[j] - s.feed_forward_Nm[j];
  }
  return force;
}

Eigen::Matrix<double, 6, 6> RobotEquations::leg_jacobian(const WrenchJacobian& foot, Foot side) const {
  Eigen::Matrix<double, 6, 6> leg;
  for (int i = 0; i < 6; ++i) leg.col(i) = foot.col(6 + robot_.leg_joints[side][static_cast<std::size_t>(i)]);
  return leg;
}

/// Ground's wrench on the foot [N, Nm, B axes, about its link's origin], from the residuals of its leg's six joints.
Eigen::Matrix<double, 6, 1> RobotEquations::foot_wrench(const GeneralizedVector& force, Foot side) {
  Eigen::Matrix<double, 6, 1> leg_force;
  for (int i = 0; i < 6; ++i) leg_force[i] = force[6 + robot_.leg_joints[side][static_cast<std::size_t>(i)]];
  const Eigen::Matrix<double, 6, 6> J = leg_jacobian(dynamics_.jacobian_of_link(foot_body_[side]), side);
  return J.transpose().partialPivLu().solve(leg_force);
}

Eigen::VectorXd RobotEquations::values(const RobotSample& sample, Support support, const Change& change, Legs* legs) {
  const GeneralizedVector force = missing(sample, change);
  const std::vector<int> joints = joints_of_rows(support);
  const auto count = static_cast<Eigen::Index>(joints.size());
  Eigen::VectorXd rows(count + (support == Support::kStanding ? kBaseRows + kGroundRows : 0));
  for (Eigen::Index i = 0; i < count; ++i) rows[i] = force[6 + joints[static_cast<std::size_t>(i)]];
  if (support == Support::kHanging) {
    const WrenchJacobian J = dynamics_.jacobian_of_center(torso_);
    const Eigen::Matrix<double, 6, 1> wrench = J.leftCols<6>().transpose().partialPivLu().solve(force.head<6>().eval());
    for (Eigen::Index i = 0; i < count; ++i) rows[i] -= J.col(6 + joints[static_cast<std::size_t>(i)]).dot(wrench);
  }
  if (support != Support::kStanding) return rows;

  Eigen::Matrix<double, 6, 1> whole = force.head<6>();
  const Eigen::Vector3d up_B = robot_.imu.T_LI.linear() * turned(change.imu_rad) * sample.up_I;
  PerFoot<double> height_m{};
  for (const Foot foot : {kLeft, kRight}) {
    const WrenchJacobian J = dynamics_.jacobian_of_link(foot_body_[foot]);
    const Eigen::Matrix<double, 6, 6> to_base =
        J.leftCols<6>().transpose() * leg_jacobian(J, foot).transpose().inverse();
    for (int i = 0; i < 6; ++i)
      whole -= to_base.col(i) * force[6 + robot_.leg_joints[foot][static_cast<std::size_t>(i)]];
    if (legs != nullptr) legs->to_base[foot] = to_base;
    const Eigen::Matrix3d R_BF = dynamics_.rotation(foot_body_[foot]);
    const Eigen::Vector3d up_F = R_BF.transpose() * up_B;
    rows[count + kBaseRows + 2 * static_cast<int>(foot)] = up_F.x();
    rows[count + kBaseRows + 2 * static_cast<int>(foot) + 1] = up_F.y();
    const model::FootModel& model = robot_.feet[foot];
    const Eigen::Vector3d sole_F = model.box_center_F - model.box_half_size_m.z() * Eigen::Vector3d::UnitZ();
    height_m[foot] = up_B.dot(dynamics_.origin(foot_body_[foot]) + R_BF * sole_F);
  }
  rows.segment<6>(count) = whole;
  rows[count + kBaseRows + kTiltRows] = height_m[kLeft] - height_m[kRight];
  return rows;
}

Eigen::VectorXd RobotEquations::torque_column(const RobotParameter& parameter, const RobotSample& sample,
                                              Support support, const Legs& legs, const Eigen::VectorXd& nominal) const {
  Eigen::VectorXd column = Eigen::VectorXd::Zero(nominal.size());
  const double missing_Nm = missing_per_unit(parameter, sample);
  const std::vector<int> joints = joints_of_rows(support);
  const auto found = std::ranges::find(joints, parameter.joint);
  if (found != joints.end()) {
    const Eigen::Index row = found - joints.begin();
    column[row] = missing_Nm;
  }
  if (support != Support::kStanding) return column;
  for (const Foot foot : {kLeft, kRight}) {
    for (int i = 0; i < 6; ++i) {
      if (robot_.leg_joints[foot][static_cast<std::size_t>(i)] != parameter.joint) continue;
      column.segment<6>(static_cast<Eigen::Index>(joints.size())) = -legs.to_base[foot].col(i) * missing_Nm;
    }
  }
  return column;
}

Eigen::VectorXd RobotEquations::link_column(const RobotParameter& p, const RobotSample& sample, Support support,
                                            const Eigen::VectorXd& nominal) {
  const int body = dynamics_.body(p.link);
  const Eigen::Vector3d axis = p.axis >= 0 ? Eigen::Vector3d::Unit(p.axis) : Eigen::Vector3d::Zero().eval();
  double step = kMassStep_kg;
  switch (p.kind) {
    case Kind::kLinkMass:
      dynamics_.set_link(body, 1.0 + step, 0.0, Eigen::Vector3d::Zero());
      break;
    case Kind::kTorsoCenter:
      step = kLengthStep_m;
      dynamics_.set_link(body, 1.0, 0.0, step * axis);
      break;
    default:
      dynamics_.set_link(body, 1.0, step, Eigen::Vector3d::Zero());
      break;
  }
  const Eigen::VectorXd column = (values(sample, support, {}) - nominal) / step;
  dynamics_.set_link(body, 1.0, 0.0, Eigen::Vector3d::Zero());
  return column;
}

std::vector<RobotRow> RobotEquations::rows(const RobotSample& sample, Support support) {
  Legs legs;
  const Eigen::VectorXd nominal = values(sample, support, {}, &legs);
  const std::vector<int> joints = joints_of_rows(support);
  std::vector<RobotRow> rows(static_cast<std::size_t>(nominal.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool of_joint = i < joints.size();
    rows[i].kind = kind_of_joint(support, of_joint ? joints[i] : joints_ + static_cast<int>(i - joints.size()));
    rows[i].support = support;
    rows[i].residual = nominal[static_cast<Eigen::Index>(i)];
  }
  std::vector<double> all_still(rows.size(), 0.0);
  for (int j = 0; j < joints_; ++j) {  // dry friction of unknown direction
    const double friction_Nm = robot_.joints[static_cast<std::size_t>(j)].friction_Nm;
    RobotParameter coulomb{.kind = Kind::kCoulomb, .joint = j};
    RobotSample one = sample;
    one.direction[j] = 1.0;
    const Eigen::VectorXd effect = torque_column(coulomb, one, support, legs, nominal);
    const double open = std::max(0.0, 1.0 - sample.direction[j] * sample.direction[j]);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double share = effect[static_cast<Eigen::Index>(i)] * friction_Nm;
      rows[i].friction_variance += share * share * open;
      all_still[i] += share * share;
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].standstill = all_still[i] > 0.0 ? rows[i].friction_variance / all_still[i] : 0.0;
  for (std::size_t k = 0; k < list_.parameters.size(); ++k) {
    const RobotParameter& p = list_.parameters[k];
    Eigen::VectorXd column;
    if (of_torque(p.kind)) {
      column = torque_column(p, sample, support, legs, nominal);
    } else if (p.kind == Kind::kZeroOffset) {
      column =
          (values(sample, support, {.joint = p.joint, .zero_offset_rad = kAngleStep_rad}) - nominal) / kAngleStep_rad;
    } else if (p.kind == Kind::kImu) {
      column = (values(sample, support, {.imu_rad = kAngleStep_rad * Eigen::Vector3d::Unit(p.axis)}) - nominal) /
               kAngleStep_rad;
    } else {
      column = link_column(p, sample, support, nominal);
    }
    add_column(static_cast<int>(k), column, rows);
    const auto own = std::ranges::find(joints, p.joint);
    if (p.kind != Kind::kKp || own == joints.end()) continue;
    RobotRow& row = rows[static_cast<std::size_t>(own - joints.begin())];
    if (row.coefficients.empty() || row.coefficients.back().first != static_cast<int>(k)) continue;
    row.own_gain = static_cast<int>(row.coefficients.size()) - 1;
    row.spring_Nm = sample.spring_Nm[p.joint];
  }
  return rows;
}

void RobotEquations::add_column(int parameter, const Eigen::VectorXd& column, std::vector<RobotRow>& rows) const {
  // Leaves out coefficients that are 0 by structure, to save time. Rounding errors of finite differences, up to 1e-7,
  // may stay: the estimates don't notice them.
  const double negligible = 1e-9;  // row's unit per unit of the parameter
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double value = column[static_cast<Eigen::Index>(i)];
    if (std::abs(value) > negligible) rows[i].coefficients.emplace_back(parameter, value);
  }
}

}  // namespace pmg::robot_diagnosis
