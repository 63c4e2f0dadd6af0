#include "generator/ground_cost.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pmg::generator {
namespace {

constexpr int kFeatures = 10;  ///< of FootOnGround: contact p and v, omega_z, toes_up, side_up, inner_edge_y
using Derivatives = Eigen::Matrix<double, kFeatures, 2 * kLegJoints>;  ///< columns: q, then dq, by LegRole

struct DifferentiatedFoot {
  FootOnGround<double> value;
  Derivatives by_joints;
};

/// (q, dq) => (foot, derivatives). With the joints' axes a_j and origins o_j in H, and a point c of the foot:
///   v(c) = omega_HB x c + sum_j dq_j a_j x (c - o_j)
///   dc/dq_k = a_k x (c - o_k),  da_j/dq_k = a_k x a_j for j > k, else 0
///   dv/dq_k = a_k x v_after(c) + omega_upto x dc/dq_k
/// with the part v_after of v that the joints after k cause, and omega_upto = omega_HB + sum_{j <= k} dq_j a_j.
class FootDerivatives {
 public:
  FootDerivatives(const GroundResiduals& residuals, Foot f, const LegVector<double>& q, const LegVector<double>& dq)
      : leg_(residuals.leg(f)), omega_(residuals.omega_HB()) {
    Eigen::Matrix3d R = residuals.R_HB();
    Eigen::Vector3d o = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < kLegJoints; ++j) {
      const LegGeometry::Segment& segment = leg_.segments[j];
      const auto role = static_cast<Eigen::Index>(segment.role);
      o += R * segment.p;
      R = R * segment.R;
      axis_[j] = R * segment.axis;
      origin_[j] = o;
      omega_ += dq[role] * axis_[j];
      omega_upto_[j] = omega_;
      R = R * Eigen::AngleAxisd(q[role], segment.axis).toRotationMatrix();
    }
    // Of the joints after each one: omega_after, and v_after(c) = omega_after x c - moment_after.
    Eigen::Vector3d omega_after = Eigen::Vector3d::Zero(), moment_after = Eigen::Vector3d::Zero();
    for (std::size_t j = kLegJoints; j-- > 0;) {
      omega_after_[j] = omega_after;
      moment_after_[j] = moment_after;
      const Eigen::Vector3d turning = dq[static_cast<Eigen::Index>(leg_.segments[j].role)] * axis_[j];
      omega_after += turning;
      moment_after += turning.cross(origin_[j]);
    }
    moment_ = moment_after;
    R_ = R;
    p_ = o;
  }

  DifferentiatedFoot of(Foot f) const {
    DifferentiatedFoot foot;
    std::array<Eigen::Vector3d, 4> corner;
    for (std::size_t c = 0; c < 4; ++c) corner[c] = R_ * leg_.sole[c] + p_;
    const auto lowest =
        std::ranges::min_element(corner, {}, [](const Eigen::Vector3d& point) { return point.z(); })->z();
    std::array<double, 4> weight{};
    double total = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      weight[c] = std::exp((lowest - corner[c].z()) / GroundResiduals::kSoftness_m);
      total += weight[c];
    }
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (std::size_t c = 0; c < 4; ++c) {
      weight[c] /= total;
      p += weight[c] * corner[c];
    }
    std::size_t inner = 0;
    for (std::size_t c = 1; c < 4; ++c) {
      if (f == kLeft ? corner[c].y() < corner[inner].y() : corner[c].y() > corner[inner].y()) inner = c;
    }
    foot.value = {{p, velocity(p)}, omega_.z(), R_(2, 0), R_(2, 1), corner[inner].y()};

    for (std::size_t k = 0; k < kLegJoints; ++k) {
      const auto q = static_cast<Eigen::Index>(leg_.segments[k].role), dq = q + kLegJoints;
      // The contact point moves with the sole, and over it as the corners' heights change.
      Eigen::Vector3d moved = Eigen::Vector3d::Zero();
      for (std::size_t c = 0; c < 4; ++c) {
        const Eigen::Vector3d with_sole = by_angle(k, corner[c]);
        moved += weight[c] * (with_sole - with_sole.z() / GroundResiduals::kSoftness_m * (corner[c] - p));
      }
      const Eigen::Vector3d with_sole = by_angle(k, p);
      auto by_q = foot.by_joints.col(q), by_dq = foot.by_joints.col(dq);
      by_q.segment<3>(0) = moved;
      by_q.segment<3>(3) = axis_[k].cross(omega_after_[k].cross(p) - moment_after_[k]) +
                           omega_upto_[k].cross(with_sole) + omega_.cross(moved - with_sole);
      by_q[6] = axis_[k].cross(omega_after_[k]).z();
      by_q[7] = axis_[k].cross(R_.col(0)).z();
      by_q[8] = axis_[k].cross(R_.col(1)).z();
      by_q[9] = by_angle(k, corner[inner]).y();
      by_dq.setZero();
      by_dq.segment<3>(3) = with_sole;
      by_dq[6] = axis_[k].z();
    }
    return foot;
  }

 private:
  Eigen::Vector3d by_angle(std::size_t k, const Eigen::Vector3d& point) const {
    return axis_[k].cross(point - origin_[k]);
  }
  Eigen::Vector3d velocity(const Eigen::Vector3d& point) const { return omega_.cross(point) - moment_; }

  const LegGeometry& leg_;
  std::array<Eigen::Vector3d, kLegJoints> axis_, origin_, omega_upto_, omega_after_, moment_after_;
  Eigen::Vector3d omega_, moment_, p_;
  Eigen::Matrix3d R_;
};

using Feature = ceres::Jet<double, 2 * kFeatures>;

/// A foot whose features differentiate by themselves, from this index on.
FootOnGround<Feature> independent(const FootOnGround<double>& foot, int first) {
  FootOnGround<Feature> out;
  for (int i = 0; i < 3; ++i) {
    out.contact.p[i] = Feature(foot.contact.p[i], first + i);
    out.contact.v[i] = Feature(foot.contact.v[i], first + 3 + i);
  }
  out.omega_z = Feature(foot.omega_z, first + 6);
  out.toes_up = Feature(foot.toes_up, first + 7);
  out.side_up = Feature(foot.side_up, first + 8);
  out.inner_edge_y = Feature(foot.inner_edge_y, first + 9);
  return out;
}

}  // namespace

bool GroundCost::Evaluate(const double* const* knots, double* residual, double** jacobian) const {
  if (jacobian == nullptr) {
    return residuals_(knots[0], knots[1], knots[2], knots[3], knots[4], knots[5], knots[6], knots[7], residual);
  }
  PerFoot<DifferentiatedFoot> foot;
  PerFoot<FootOnGround<Feature>> independent_foot;
  for (const Foot f : {kLeft, kRight}) {
    const std::size_t first = f == kLeft ? 0 : 4;
    LegVector<double> q, dq;
    residuals_.joints<double>(f, {knots[first], knots[first + 1], knots[first + 2], knots[first + 3]}, q, dq);
    foot[f] = FootDerivatives(residuals_, f, q, dq).of(f);
    independent_foot[f] = independent(foot[f].value, f == kLeft ? 0 : kFeatures);
  }
  std::array<Feature, kGroundResiduals> by_feature;
  residuals_.ground(independent_foot, by_feature.data());
  Eigen::Matrix<double, kGroundResiduals, 2 * kFeatures> J_feature;
  for (int r = 0; r < kGroundResiduals; ++r) {
    residual[r] = by_feature[static_cast<std::size_t>(r)].a;
    J_feature.row(r) = by_feature[static_cast<std::size_t>(r)].v;
  }
  for (const Foot f : {kLeft, kRight}) {
    const Eigen::Matrix<double, kGroundResiduals, 2 * kLegJoints> J_joints =
        J_feature.middleCols<kFeatures>(f == kLeft ? 0 : kFeatures) * foot[f].by_joints;
    for (std::size_t k = 0; k < 4; ++k) {
      double* const block = jacobian[(f == kLeft ? 0 : 4) + k];
      if (block == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, kGroundResiduals, kLegJoints, Eigen::RowMajor>> J(block);
      for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kLegJoints); ++i) {
        J.col(i) = residuals_.dq_dknot(f, k, i) * J_joints.col(i) +
                   residuals_.drate_dknot(f, k, i) * J_joints.col(i + static_cast<Eigen::Index>(kLegJoints));
      }
    }
  }
  return true;
}

}  // namespace pmg::generator
