#include "gco/ground_aware_command.hpp"

#include <ceres/tiny_solver.h>

#include <cmath>
#include <stdexcept>

#include "gco/contact_problem.hpp"
#include "model/leg_kinematics.hpp"

namespace pmg::gco {

namespace {

template <int kUnknowns>
using Solver = ceres::TinySolver<ContactProblem<kUnknowns>>;

template <int kUnknowns>
typename Solver<kUnknowns>::Options solver_options() {
  typename Solver<kUnknowns>::Options options;
  // With 5 unknowns the problem is linear: the undamped first step is the solution, and the second evaluation confirms
  // it. With 7 the trust region is needed.
  options.initial_trust_region_radius = kUnknowns == 5 ? 1e14 : 1e4;
  options.max_num_iterations = kUnknowns == 5 ? 8 : 50;
  options.gradient_tolerance = 1e-10;  // 1e-4 m/s where only the prior of 1e-3^2 acts, 1e-10 m/s where a foot acts
  // Absolute in TinySolver: (1e-9 m/s)^2; with 7 unknowns (3e-8 m/s)^2, above the rounding of a cost that doesn't
  // vanish there.
  options.function_tolerance = kUnknowns == 5 ? 1e-18 : 1e-15;
  return options;
}

bool finite(const std::array<double, kMaxUnknowns>& x) noexcept {
  for (const double value : x) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

/// Slip for the unknowns x: horizontal speed of the sole at the contact point [m/s].
template <int kUnknowns>
double slip_m_s(const ContactProblem<kUnknowns>& problem, Foot foot, const double* x) noexcept {
  return problem.foot_motion(foot, x).velocity_H.template head<2>().norm();
}

template <int kUnknowns>
void report(const ContactProblem<kUnknowns>& problem, const Command& u, const std::array<double, kMaxUnknowns>& x,
            Result& result) noexcept {
  result.command = u;
  result.command[kVx] = x[kXVx];
  result.command[kVy] = x[kXVy];
  result.command[kOmega] = x[kXOmega];
  result.command[kHeight] = x[kXHeight];
  result.command[kPitch] = x[kXPitch];
  result.command[kRoll] = x[kXRoll];
  result.vz_m_s = x[kXVz];
  result.height_deficit_m = u[kHeight] - x[kXHeight];
  const std::array<double, kMaxUnknowns> user = {u[kVx], u[kVy], 0.0, u[kOmega], u[kHeight], u[kPitch], u[kRoll]};
  const ContactTerms& terms = problem.terms;
  for (const Foot foot : {kLeft, kRight}) {
    FootSlip& slip = result.foot[foot];
    slip = {};
    if (terms.foot[foot].weight <= 0.0) continue;
    const FootMotion<double> after = problem.foot_motion(foot, x.data());
    slip.before_m_s = slip_m_s(problem, foot, user.data());
    slip.after_m_s = after.velocity_H.head<2>().norm();
    slip.yaw_rate_after_rad_s = std::abs(after.yaw_rate);
    slip.height_m = terms.standing_height_m + x[kXHeight] + after.lever_H.z() - terms.foot[foot].lowest_below_contact_m;
  }
}

}  // namespace

struct GroundAwareCommand::Impl {
  Impl(const model::RobotModel& robot, const Options& user_options)
      : joints(robot.joint_index.size()),
        standing_height_m(robot.standing_height_m),
        options(user_options),
        legs(robot),
        base_attitude(robot) {
    solver5.options = solver_options<5>();
    solver7.options = solver_options<7>();
  }

  /// (cos, sin) of the torso's yaw in H: the torso's pitch axis, turned back by 90 degrees.
  Eigen::Vector2d torso_heading(const Reference& reference) noexcept {
    const JointVector still = JointVector::Zero(reference.q.size());
    const Eigen::Vector3d pitch_axis_H =
        base_attitude.compute(reference.q, still, reference.command[kPitch], reference.command[kRoll], 1.0, 0.0)
            .omega_HB_H;
    return {pitch_axis_H.y(), -pitch_axis_H.x()};
  }

  ContactTerms terms_of(const Reference& reference) noexcept {
    const Command& u = reference.command;
    const Command& rate = reference.command_rate;
    const model::BaseAttitude::Result attitude =
        base_attitude.compute(reference.q, reference.dq, u[kPitch], u[kRoll], rate[kPitch], rate[kRoll]);
    ContactTerms terms = contact_terms(reference, legs.compute(reference.q, reference.dq), attitude, standing_height_m,
                                       options.prior_weight, height_known ? result.command[kHeight] : u[kHeight]);
    if (options.optimise_roll_pitch) {
      terms.torso_heading_H = torso_heading(reference);
      terms.prior_weight[kXPitch] = std::hypot(terms.prior_weight[kXPitch], options.attitude_prior_weight);
      terms.prior_weight[kXRoll] = terms.prior_weight[kXPitch];
    }
    return terms;
  }

  template <int kUnknowns>
  Status solve(Solver<kUnknowns>& solver, const ContactTerms& terms, const Command& u) noexcept {
    const ContactProblem<kUnknowns> problem{terms};
    const bool contact = terms.foot[kLeft].weight > 0.0 || terms.foot[kRight].weight > 0.0;
    std::array<double, kMaxUnknowns> x = terms.prior;
    if (contact) {
      typename Solver<kUnknowns>::Parameters unknowns =
          Eigen::Map<const typename Solver<kUnknowns>::Parameters>(terms.prior.data());
      const auto& summary = solver.Solve(problem, &unknowns);
      if (summary.status == Solver<kUnknowns>::HIT_MAX_ITERATIONS || !std::isfinite(summary.final_cost)) {
        return Status::kNotConverged;
      }
      for (int i = 0; i < kUnknowns; ++i) x[static_cast<std::size_t>(i)] = unknowns[i];
    }
    if (!finite(x)) return Status::kNotConverged;
    report(problem, u, x, result);
    height_known = true;
    return contact ? Status::kConverged : Status::kNoContact;
  }

  const int joints;
  const double standing_height_m;
  const Options options;
  model::LegKinematics legs;
  model::BaseAttitude base_attitude;
  Solver<5> solver5;
  Solver<7> solver7;
  bool height_known = false;
  Result result;
};

GroundAwareCommand::GroundAwareCommand(const model::RobotModel& robot, const Options& options) {
  if (!(options.prior_weight > 0.0) || !(options.attitude_prior_weight > 0.0)) {
    throw std::invalid_argument("GroundAwareCommand: prior weights must be positive");
  }
  impl_ = std::make_unique<Impl>(robot, options);
}

GroundAwareCommand::~GroundAwareCommand() = default;

const Result& GroundAwareCommand::solve(const Reference& reference) noexcept {
  Impl& impl = *impl_;
  if (reference.q.size() != impl.joints || reference.dq.size() != impl.joints) {
    impl.result.status = Status::kNotConverged;
    return impl.result;
  }
  const ContactTerms terms = impl.terms_of(reference);
  impl.result.status = impl.options.optimise_roll_pitch ? impl.solve(impl.solver7, terms, reference.command)
                                                        : impl.solve(impl.solver5, terms, reference.command);
  return impl.result;
}

void GroundAwareCommand::reset() noexcept {
  impl_->height_known = false;
  impl_->result = {};
}

}  // namespace pmg::gco
