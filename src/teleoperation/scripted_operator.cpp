#include "teleoperation/scripted_operator.hpp"

#include <algorithm>
#include <cmath>

#include "arms_operator/arms_text.hpp"
#include "pmg_msgs/arms_state_t.hpp"
#include "pmg_msgs/mode_t.hpp"
#include "vr/head_motion.hpp"

namespace pmg::teleoperation {

namespace {

/// The share of its range that a value is, in [-1, 1].
double share_of(const CommandLimits& limits, Channel channel, double value) {
  const double most = value < 0.0 ? -limits.lower[channel] : limits.upper[channel];
  return most > 0.0 ? std::clamp(value / most, -1.0, 1.0) : 0.0;
}

constexpr double kStood_s = 3.0;
constexpr double kDown_m_s = 0.12, kBend_rad_s = 0.2;  // of its own head
constexpr double kGain_per_s = 1.5;                    // of a hand that closes a gap

}  // namespace

void ScriptedOperator::step(LedRobot& robot) {
  const double now_s = robot.time_s();
  limits_ = robot.model().command_limits;
  for (const Foot side : {kLeft, kRight}) {
    person_.move_hand(side, Eigen::Vector3d::Zero());
    person_.turn_hand(side, Eigen::Vector3d::Zero());
  }
  const double down_m = kDown_m_s * control::ControlCycle::kPeriod_s,
               bend_rad = kBend_rad_s * control::ControlCycle::kPeriod_s;
  down_m_ += std::clamp(down_to_m_ - down_m_, -down_m, down_m);
  bent_rad_ += std::clamp(bent_to_rad_ - bent_rad_, -bend_rad, bend_rad);
  if (look(now_s)) act(robot, now_s);
  robot.step(&person_.next(robot.now_ns()));
}

bool ScriptedOperator::takes_over(const LedRobot& robot, double now_s) {
  if (!person_.squeezes()) {
    if (robot.mode() != pmg_msgs::mode_t::STAND || now_s < kStood_s) return false;
    person_.squeeze();
    squeezed_s_ = now_s;
  }
  if (now_s - squeezed_s_ > 0.3) walk(0.12, 0.0, 0.0);
  return robot.driving() && robot.mode() == pmg_msgs::mode_t::WALK;
}

void ScriptedOperator::walk(double ahead_m_s, double left_m_s, double turn_rad_s) {
  const Eigen::Vector2d lean_m = lean_for({share_of(limits_, kVx, std::clamp(ahead_m_s, -0.2, 0.25)),
                                           share_of(limits_, kVy, std::clamp(left_m_s, -0.2, 0.2))});
  person_.lean({lean_m.x(), lean_m.y(), -down_m_},
               turn_for(share_of(limits_, kOmega, std::clamp(turn_rad_s, -0.3, 0.3))), bent_rad_);
}

void ScriptedOperator::stay() { person_.lean({0.0, 0.0, -down_m_}, 0.0, bent_rad_); }

void ScriptedOperator::crouch(double height_m, double pitch_rad) noexcept {
  down_to_m_ = height_m < 0.0 ? vr::kHeightDead_m - height_m : 0.0;
  bent_to_rad_ = bend_for(share_of(limits_, kPitch, pitch_rad));
}

double ScriptedOperator::towards(double gap, double small, double least) {
  return std::abs(gap) < 0.6 * small ? 0.0 : 0.6 * gap + std::copysign(least, gap);
}

void ScriptedOperator::raise(const LedRobot& robot, const Picture& picture, const PerFoot<Eigen::Vector3d>& to_m,
                             double now_s) {
  for (const Foot side : {kLeft, kRight}) {
    if (!person_.pulls(side) || (!follows(robot, side) && now_s - pulled_s_[side] > 1.0)) {
      person_.release(side);
      if (now_s - pulled_s_[side] > 1.2) {
        person_.pull(side);
        pulled_s_[side] = now_s;
      }
    } else if (picture.palm_m[side]) {
      steer(side, to_m[side] - *picture.palm_m[side]);
    } else {
      person_.move_hand(side, {0.1, 0.0, 0.15});
    }
  }
}

bool ScriptedOperator::follows(const LedRobot& robot, Foot side) {
  const ops::HeardArms* arms = robot.arms();
  return arms != nullptr && ops::arm_news(arms->state, side).activity != pmg_msgs::arms_state_t::REFERENCE;
}

void ScriptedOperator::steer(Foot side, const Eigen::Vector3d& error_m) {
  person_.move_hand(side, kGain_per_s * error_m);
}

}  // namespace pmg::teleoperation
