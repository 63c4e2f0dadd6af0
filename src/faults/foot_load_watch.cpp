#include "faults/foot_load_watch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/link_chain.hpp"
#include "pmg/types.hpp"

namespace pmg::faults {

namespace {

double sum(const PerFoot<double>& shares) noexcept { return shares[kLeft] + shares[kRight]; }

int ticks(double time_s, double dt_s) { return std::max(1, static_cast<int>(std::lround(time_s / dt_s))); }

const FootLoadOptions& checked(const FootLoadOptions& options) {
  if (!(options.lost_share < options.found_share))
    throw std::invalid_argument("FootLoadWatch: lost_share; expected less than found_share");
  if (!(options.least_walking_share < options.lost_walking_share && options.lost_walking_share < 1.0))
    throw std::invalid_argument(
        "FootLoadWatch: lost_walking_share; expected more than least_walking_share, less than 1");
  for (const double value : {options.lost_s, options.found_s, options.filter_s, options.change_per_sqrt_s,
                             options.acceleration_s, options.walking_s, options.blind_share}) {
    if (!(value > 0.0))
      throw std::invalid_argument("FootLoadWatch: times, change_per_sqrt_s and blind_share; expected more than 0");
  }
  if (!(options.wrong_inertia_share >= 0.0))
    throw std::invalid_argument("FootLoadWatch: wrong_inertia_share; expected 0 or more");
  return options;
}

}  // namespace

FootLoadWatch::FootLoadWatch(const model::RobotModel& robot, const FootLoadOptions& options, double dt_s)
    : loads_(robot),
      base_to_imu_link_(model::chain_between(robot, robot.base_link, robot.imu.link)),
      R_LI_(robot.imu.T_LI.linear()),
      options_(checked(options)),
      weight_N_(robot.total_mass_kg * kGravity_m_s2),
      dt_s_(dt_s),
      filter_gain_(1.0 - std::exp(-dt_s / options.filter_s)),
      acceleration_gain_(1.0 - std::exp(-dt_s / options.acceleration_s)),
      walking_gain_(1.0 - std::exp(-dt_s / options.walking_s)),
      change_variance_(options.change_per_sqrt_s * options.change_per_sqrt_s * dt_s),
      lost_ticks_needed_(ticks(options.lost_s, dt_s)),
      found_ticks_needed_(ticks(options.found_s, dt_s)),
      dq_before_(JointVector::Zero(robot.joint_index.size())),
      acceleration_sq_(dq_before_) {}

void FootLoadWatch::start() noexcept {
  footing_ = Footing::kUnknown;
  begun_ = false;
  lost_ticks_ = found_ticks_ = 0;
  measured_ = asked_ = {};
  held_ = 0.0;
  walking_share_ = 1.0;
}

const PerFoot<double>& FootLoadWatch::share() const noexcept {
  return sum(measured_) >= sum(asked_) ? measured_ : asked_;
}

void FootLoadWatch::update(const model::RobotState& state, const model::JointCommand& in_force, bool walks) noexcept {
  if (!can_be_judged(state, in_force)) return;
  measure(state, in_force);
  if (std::sqrt(sum(variance_)) > options_.blind_share) return;
  const double carried = sum(share());
  const bool held = held_ > options_.held_share;
  lost_ticks_ = carried < options_.lost_share && held ? lost_ticks_ + 1 : 0;
  found_ticks_ = carried > options_.found_share ? found_ticks_ + 1 : 0;
  if (!walks || footing_ != Footing::kStands) walking_share_ = 1.0;
  if (walks && held)
    walking_share_ += walking_gain_ * (std::max(carried, options_.least_walking_share) - walking_share_);
  if (found_ticks_ >= found_ticks_needed_) footing_ = Footing::kStands;
  if (lost_ticks_ >= lost_ticks_needed_ || walking_share_ < options_.lost_walking_share) footing_ = Footing::kHangs;
}

bool FootLoadWatch::can_be_judged(const model::RobotState& state, const model::JointCommand& in_force) const noexcept {
  const Eigen::Index n = in_force.q.size();
  return state.q.size() == n && state.dq.size() == n && state.tau.size() == n && state.q.allFinite() &&
         state.dq.allFinite() && state.tau.allFinite() && state.acceleration_m_s2.allFinite() &&
         state.gyro_rad_s.allFinite() && in_force.q.allFinite() &&
         std::abs(state.orientation_WI.norm() - 1.0) < 0.1;  // false of NaN
}

void FootLoadWatch::measure(const model::RobotState& state, const model::JointCommand& in_force) noexcept {
  if (!begun_) {
    dq_before_ = state.dq;
    acceleration_sq_.setZero();
    variance_ = {1.0, 1.0};
  }
  const JointVector ddq = (state.dq - dq_before_) / dt_s_;
  dq_before_ = state.dq;
  acceleration_sq_ += acceleration_gain_ * (ddq.cwiseAbs2() - acceleration_sq_);
  const JointVector uncertain_rad_s2 = options_.wrong_inertia_share * acceleration_sq_.cwiseSqrt();

  base_to_imu_link_.compute(state.q);
  const Eigen::Matrix3d R_BI = base_to_imu_link_.R() * R_LI_;
  const Eigen::Vector3d omega_B = R_BI * state.gyro_rad_s;
  const Eigen::Vector3d alpha_B =
      begun_ ? Eigen::Vector3d((omega_B - omega_before_B_) / dt_s_) : Eigen::Vector3d::Zero();
  omega_before_B_ = omega_B;
  const Eigen::Vector3d gravity_I = state.orientation_WI.conjugate() * -Eigen::Vector3d::UnitZ();
  loads_.set_motion({.q = state.q,
                     .dq = state.dq,
                     .ddq = ddq,
                     .gravity_B = (R_BI * gravity_I).normalized(),
                     .specific_force_B = R_BI * state.acceleration_m_s2,
                     .omega_B = omega_B,
                     .alpha_B = alpha_B});
  const JointVector asked_Nm = in_force.kp.cwiseProduct(in_force.q - state.q) +
                               in_force.kd.cwiseProduct(in_force.dq - state.dq) + in_force.tau_ff;
  const PerFoot<model::SoleLoad> measured = loads_.of(state.tau), asked = loads_.of(asked_Nm);
  const double gain = begun_ ? filter_gain_ : 1.0;
  // A Kalman filter of one state a foot, whose gain is at most the low-pass filter's, and 0 where the error is
  // infinite.
  for (const Foot foot : {kLeft, kRight}) {
    const double error = loads_.error_N(foot, uncertain_rad_s2) / weight_N_;
    variance_[foot] = std::min(1.0, variance_[foot] + change_variance_);
    const double weight = std::min(gain, variance_[foot] / (variance_[foot] + error * error));
    variance_[foot] *= 1.0 - weight;
    measured_[foot] += weight * (measured[foot].vertical_N / weight_N_ - measured_[foot]);
    asked_[foot] += weight * (asked[foot].vertical_N / weight_N_ - asked_[foot]);
  }
  const double up_m_s2 = -gravity_I.dot(state.acceleration_m_s2);
  held_ += gain * (up_m_s2 / kGravity_m_s2 - held_);
  begun_ = true;
}

}  // namespace pmg::faults
