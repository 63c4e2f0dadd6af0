#include "gco/contact_problem.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "gco/contact_point.hpp"

namespace pmg::gco {

namespace {

FootTerms foot_terms(const model::FootKinematics& foot, const ContactPoint& contact, const Eigen::Matrix3d& R_HB,
                     double weight) noexcept {
  FootTerms terms;
  terms.lever_H = R_HB * contact.p_BC;
  terms.velocity_H = R_HB * (foot.v_BF + foot.omega_BF.cross(contact.p_BC - foot.p_BF));
  terms.omega_H = R_HB * foot.omega_BF;
  terms.lowest_below_contact_m = contact.height_m - contact.lowest_corner_m;
  terms.weight = weight;
  terms.sqrt_weight = std::sqrt(weight);
  return terms;
}

/// max(0, 1 - 2 total_weight)^2: 0 while the feet have at least half a contact weight together, 1 with none. So the
/// prior takes over within half an edge of the contact weights, not only when they are as small as the prior's 1e-6.
double flight(double total_weight) noexcept {
  const double missing = std::max(0.0, 1.0 - 2.0 * total_weight);
  return missing * missing;
}

}  // namespace

template <int kUnknowns>
void ContactProblem<kUnknowns>::fill_jacobian(const double* x, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, NUM_PARAMETERS>> J(jacobian);
  J.setZero();
  PerFoot<Eigen::Vector3d> lever = {terms.foot[kLeft].lever_H, terms.foot[kRight].lever_H};
  if constexpr (kUnknowns == 7) {
    const Eigen::Matrix3d turn = attitude_change(x);
    for (Eigen::Vector3d& arm : lever) arm = turn * arm;
    const double cy = terms.torso_heading_H.x(), sy = terms.torso_heading_H.y();
    const double cp = std::cos(x[kXPitch]), sp = std::sin(x[kXPitch]);
    // Axes in H of a change of pitch and of roll. Roll comes first; pitch then tilts its axis.
    const std::array<Eigen::Vector3d, 2> axis = {Eigen::Vector3d(-sy, cy, 0.0), Eigen::Vector3d(cp * cy, cp * sy, -sp)};
    const Eigen::Vector3d omega(terms.omega_HB_H.x(), terms.omega_HB_H.y(), x[kXOmega]);
    for (int i = 0; i < 2; ++i) {
      const int column = kXPitch + i;
      const Eigen::Vector3d& a = axis[static_cast<std::size_t>(i)];
      for (const Foot foot : {kLeft, kRight}) {
        const FootTerms& leg = terms.foot[foot];
        const int row = 4 * static_cast<int>(foot);
        const Eigen::Vector3d d_lever = a.cross(lever[foot]);
        J.template block<3, 1>(row, column) =
            leg.sqrt_weight * (omega.cross(d_lever) + a.cross(Eigen::Vector3d(turn * leg.velocity_H)));
        J(row + 3, column) = leg.sqrt_weight * a.cross(Eigen::Vector3d(turn * leg.omega_H)).z();
        J(kHeightRow, column) += terms.sqrt_height_weight * terms.height_share[foot] * d_lever.z();
        J(kLevelRow, column) += terms.sqrt_level_weight * (foot == kLeft ? d_lever.z() : -d_lever.z());
      }
    }
  }
  for (const Foot foot : {kLeft, kRight}) {
    const double weight = terms.foot[foot].sqrt_weight;
    const int row = 4 * static_cast<int>(foot);
    for (int i = 0; i < 3; ++i) J(row + i, i) = weight;
    J(row, kXOmega) = -weight * lever[foot].y();  // z x lever
    J(row + 1, kXOmega) = weight * lever[foot].x();
    J(row + 3, kXOmega) = weight;
  }
  J(kHeightRow, kXHeight) = terms.sqrt_height_weight;
  for (int i = 0; i < kUnknowns; ++i) J(kPriorRow + i, i) = terms.prior_weight[static_cast<std::size_t>(i)];
}

template struct ContactProblem<5>;
template struct ContactProblem<7>;

ContactTerms contact_terms(const Reference& reference, const PerFoot<model::FootKinematics>& feet,
                           const model::BaseAttitude::Result& attitude, double standing_height_m, double prior_weight,
                           double held_height_m) noexcept {
  ContactTerms terms;
  PerFoot<double> height_m;
  PerFoot<double> weight;
  for (const Foot foot : {kLeft, kRight}) {
    weight[foot] = std::clamp(reference.contact_weight[foot], 0.0, 1.0);
    const ContactPoint contact = contact_point(feet[foot].sole_B, attitude.R_HB);
    terms.foot[foot] = foot_terms(feet[foot], contact, attitude.R_HB, weight[foot]);
    height_m[foot] = contact.height_m;
  }
  const double total_weight = weight[kLeft] + weight[kRight];
  terms.omega_HB_H = attitude.omega_HB_H;
  terms.height_share = height_shares(height_m, weight);
  terms.sqrt_height_weight = std::sqrt(std::min(1.0, total_weight));
  terms.sqrt_level_weight = std::sqrt(weight[kLeft] * weight[kRight]);
  terms.standing_height_m = standing_height_m;

  const Command& u = reference.command;
  terms.pitch_rad = u[kPitch];
  terms.roll_rad = u[kRoll];
  const double prior = prior_weight * prior_weight;
  const double hold = flight(total_weight);
  const double height_target = (prior * u[kHeight] + hold * held_height_m) / (prior + hold);
  terms.prior = {u[kVx], u[kVy], 0.0, u[kOmega], height_target, u[kPitch], u[kRoll]};
  terms.prior_weight.fill(std::sqrt(prior + hold));
  return terms;
}

}  // namespace pmg::gco
