#include "control/robot_excitation_player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace pmg::control {

namespace {

void expect(bool holds, const std::string& text) {
  if (!holds) throw std::invalid_argument("excitation: " + text);
}

bool finite_and_whole(const model::JointCommand& command, int joints) {
  return std::ranges::all_of(std::array{&command.q, &command.dq, &command.kp, &command.kd, &command.tau_ff},
                             [&](const JointVector* v) { return v->size() == joints && v->allFinite(); });
}

}  // namespace

void check(const RobotExcitationPlan& plan, const model::RobotModel& robot, const hal::GuardOptions& guard) {
  expect(!plan.commands.empty(), "no command; expected at least one");
  const int joints = robot.joint_index.size();
  for (std::size_t k = 0; k < plan.commands.size(); ++k) {
    const model::JointCommand& command = plan.commands[k];
    expect(finite_and_whole(command, joints), fmt::format("command {} isn't finite and of {} joints", k, joints));
    for (int j = 0; j < joints; ++j) {
      const model::Joint& joint = robot.joints[static_cast<std::size_t>(j)];
      expect(command.q[j] >= joint.lower_rad && command.q[j] <= joint.upper_rad,
             fmt::format("command {} has {} at {:.3f} rad; expected {:.3f} to {:.3f}", k, joint.name, command.q[j],
                         joint.lower_rad, joint.upper_rad));
      expect(std::abs(command.dq[j]) <= joint.velocity_limit_rad_s,
             fmt::format("command {} has {} at {:.3f} rad/s; expected {:.3f} at most", k, joint.name, command.dq[j],
                         joint.velocity_limit_rad_s));
      expect(
          command.kp[j] > 0.0 && command.kp[j] <= guard.max_kp_Nm_per_rad && command.kd[j] >= 0.0 &&
              command.kd[j] <= guard.max_kd_Nm_s_per_rad && command.tau_ff[j] == 0.0,
          fmt::format("command {} has {} with gains {:g}, {:g} and torque {:g}; expected kp up to {:g} Nm/rad, kd up "
                      "to {:g} Nm s/rad and no torque",
                      k, joint.name, command.kp[j], command.kd[j], command.tau_ff[j], guard.max_kp_Nm_per_rad,
                      guard.max_kd_Nm_s_per_rad));
    }
  }
  const model::JointCommand& first = plan.commands.front();
  expect(first.q == robot.q_stand() && first.dq.isZero(), "the first command isn't the standing posture at rest");
}

RobotExcitationPlayer::RobotExcitationPlayer(RobotExcitationPlan plan, const model::RobotModel& robot, double dt_s,
                                             const faults::FootLoadOptions& foot_load, const hal::GuardOptions& guard)
    : plan_(std::move(plan)), feet_(robot, foot_load, dt_s), dt_s_(dt_s) {
  check(plan_, robot, guard);
  last_ = plan_.commands.front();
}

void RobotExcitationPlayer::start() noexcept {
  feet_.start();
  settled_s_ = 0.0;
}

void RobotExcitationPlayer::watch(const model::RobotState& state, const model::JointCommand& in_force) noexcept {
  feet_.update(state, in_force, false);
  const double carried = feet_.share()[kLeft] + feet_.share()[kRight];
  carried_ = phase_ == Phase::kPlay ? carried_ + dt_s_ / plan_.average_s * (carried - carried_) : carried;
}

bool RobotExcitationPlayer::lost_footing() const noexcept {
  return plan_.footing == faults::Footing::kHangs ? carried_ > plan_.set_down_share : carried_ < plan_.lifted_share;
}

void RobotExcitationPlayer::settle() noexcept {
  settled_s_ = feet_.footing() == plan_.footing ? settled_s_ + dt_s_ : 0.0;
  if (settled_s_ < plan_.settle_s) return;
  phase_ = Phase::kPlay;
  progress_.run = 0;
}

void RobotExcitationPlayer::play(model::JointCommand& command) noexcept {
  const auto sample = static_cast<std::size_t>(progress_.sample + 1);
  if (sample == plan_.commands.size() || lost_footing()) {
    end_play(sample < plan_.commands.size());
    come_back(command);
    return;
  }
  ++progress_.sample;
  const model::JointCommand& told = plan_.commands[sample];
  command.q = last_.q = told.q;
  command.dq = last_.dq = told.dq;
  command.kp = last_.kp = told.kp;
  command.kd = last_.kd = told.kd;
}

void RobotExcitationPlayer::end_play(bool given_up) noexcept {
  progress_.run = progress_.sample = -1;
  progress_.given_up = given_up;
  phase_ = Phase::kReturn;
}

/// From the last command to the one at rest: position, speed and gains.
void RobotExcitationPlayer::come_back(model::JointCommand& command) noexcept {
  returned_s_ += dt_s_;
  const double t = std::min(returned_s_ / plan_.return_s, 1.0), share = t * t * (3.0 - 2.0 * t);
  command.q = last_.q + share * (command.q - last_.q);
  command.dq = (1.0 - share) * last_.dq;
  command.kp = last_.kp + share * (command.kp - last_.kp);
  command.kd = last_.kd + share * (command.kd - last_.kd);
  if (t < 1.0) return;
  phase_ = Phase::kOver;
  progress_.over = true;
}

void RobotExcitationPlayer::step(model::JointCommand& command) noexcept {
  if (phase_ == Phase::kSettle) settle();
  if (phase_ == Phase::kPlay) {
    play(command);
  } else if (phase_ == Phase::kReturn) {
    come_back(command);
  }
}

void RobotExcitationPlayer::give_up() noexcept {
  if (phase_ == Phase::kSettle || phase_ == Phase::kOver) return;
  phase_ = Phase::kOver;
  progress_ = {.over = true, .given_up = true};
}

}  // namespace pmg::control
