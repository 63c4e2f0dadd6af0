#include "report/run_judgement.hpp"

#include <algorithm>

#include "report/measured_command.hpp"

namespace pmg::report {

namespace {

model::GroundTruth truth_of(const pmg_msgs::ground_truth_t& message) {
  model::GroundTruth truth;
  truth.p_WB = Eigen::Map<const Eigen::Vector3d>(message.p_WB_m);
  truth.q_WB = to_quaternion(message.q_WB);
  truth.v_WB_W = Eigen::Map<const Eigen::Vector3d>(message.v_WB_W_m_s);
  truth.omega_WB_B = Eigen::Map<const Eigen::Vector3d>(message.omega_WB_B_rad_s);
  truth.q_WT = to_quaternion(message.q_WT);
  for (const std::size_t foot : {kLeft, kRight}) {
    truth.foot_force_N[foot] = message.foot_force_N[foot];
    truth.foot_slip_m_s[foot] = message.foot_slip_m_s[foot];
  }
  return truth;
}

}  // namespace

RunJudgement::RunJudgement(double standing_height_m) : measure_(standing_height_m) {}

void RunJudgement::command(const pmg_msgs::command_t& message) {
  commands_[message.source] = {.u = {message.vx_m_s, message.vy_m_s, message.omega_rad_s, message.pitch_rad,
                                     message.roll_rad, message.height_m}};
}

void RunJudgement::reference(const pmg_msgs::reference_t& message) {
  reference_ns_ = message.stamp_ns;
  Reference& reference = tick_.reference;
  reference.phase_rate_per_s = message.phase_rate_per_s;
  reference.gain = message.gain;
  std::ranges::copy(message.user, tick_.user.u.begin());
  std::ranges::copy(message.command, reference.command.u.begin());
  reference.command_limited = message.command_limited != 0;
  tick_.optimised.status = static_cast<gco::Status>(message.gco_status);
  for (const Foot foot : {kLeft, kRight}) {
    reference.contact[foot] = message.contact[foot] != 0;
    tick_.optimised.foot[foot].before_m_s = message.slip_before_m_s[foot];
    tick_.optimised.foot[foot].after_m_s = message.slip_after_m_s[foot];
    tick_.optimised.foot[foot].height_m = message.foot_height_m[foot];
  }
}

void RunJudgement::status(const pmg_msgs::status_t& message) {
  tick_.mode = static_cast<control::Mode>(message.mode);
  driving_ = message.driving_source;
  if (!driving_.empty()) last_driving_ = driving_;
  has_status_ = true;
  if (reference_ns_ == message.stamp_ns) measure_.add_reference(tick_);
}

void RunJudgement::truth(const pmg_msgs::ground_truth_t& message) {
  if (has_status_) measure_.add_truth(tick_, truth_of(message), message.hoisted != 0, asked());
}

Command RunJudgement::asked() const {
  const std::string& source = tick_.mode == control::Mode::kFault ? last_driving_ : driving_;
  const auto found = commands_.find(source);
  return found != commands_.end() ? found->second : Command{};
}

sil::TrackingSummary errors_between(const sil::TrackingSummary& before, const sil::TrackingSummary& after) {
  sil::TrackingSummary mean;
  mean.followed_s = after.followed_s - before.followed_s;
  if (mean.followed_s <= 0.0) return mean;
  using Summary = sil::TrackingSummary;
  for (double Summary::*error :
       {&Summary::lin_vel_mae_m_s, &Summary::lin_vel_raw_mae_m_s, &Summary::yaw_vel_mae_rad_s,
        &Summary::yaw_vel_raw_mae_rad_s, &Summary::roll_mae_rad, &Summary::roll_raw_mae_rad, &Summary::pitch_mae_rad,
        &Summary::pitch_raw_mae_rad, &Summary::height_mae_m, &Summary::height_raw_mae_m}) {
    mean.*error = (after.*error * after.followed_s - before.*error * before.followed_s) / mean.followed_s;
  }
  return mean;
}

}  // namespace pmg::report
