#include "control/excitation_player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pmg::control {

namespace {

constexpr double kShortestApproach_s = 0.2;

}  // namespace

void check(const ExcitationPlan& plan, const model::RobotModel& robot, const hal::GuardOptions& guard) {
  const auto expect = [](bool holds, const std::string& text) {
    if (!holds) throw std::invalid_argument("excitation: " + text);
  };
  expect(plan.joint >= 0 && plan.joint < robot.joint_index.size(), "no such joint");
  expect(!plan.runs.empty(), "no run; expected at least one");
  const model::Joint& joint = robot.joints[static_cast<std::size_t>(plan.joint)];
  for (const ExcitationRun& run : plan.runs) {
    expect(!run.q_cmd_rad.empty(), "a run without commands");
    const auto [low, high] = std::minmax_element(run.q_cmd_rad.begin(), run.q_cmd_rad.end());
    expect(*low >= joint.lower_rad && *high <= joint.upper_rad,
           fmt::format("commands from {:.3f} to {:.3f} rad; expected {} within its range, {:.3f} to {:.3f}", *low,
                       *high, joint.name, joint.lower_rad, joint.upper_rad));
    expect(run.kp_Nm_per_rad > 0.0 && run.kp_Nm_per_rad <= guard.max_kp_Nm_per_rad && run.kd_Nm_s_per_rad >= 0.0 &&
               run.kd_Nm_s_per_rad <= guard.max_kd_Nm_s_per_rad,
           fmt::format("gains {:g}, {:g}; expected kp up to {:g} Nm/rad and kd up to {:g} Nm s/rad", run.kp_Nm_per_rad,
                       run.kd_Nm_s_per_rad, guard.max_kp_Nm_per_rad, guard.max_kd_Nm_s_per_rad));
  }
}

ExcitationPlayer::ExcitationPlayer(const ExcitationPlan& plan, const model::RobotModel& robot, const Told& rest,
                                   double dt_s, const hal::GuardOptions& guard)
    : plan_(plan), rest_(rest), told_(rest), dt_s_(dt_s) {
  check(plan, robot, guard);
  approach(0);
}

double ExcitationPlayer::approach_s(double from_rad, double to_rad) const noexcept {
  return std::max(kShortestApproach_s, std::abs(to_rad - from_rad) / plan_.approach_rad_s);
}

/// To where the run begins, with its gains; behind the last run back to rest.
void ExcitationPlayer::approach(std::size_t run) noexcept {
  run_ = run;
  const bool more = run < plan_.runs.size();
  phase_ = more ? Phase::kApproach : Phase::kReturn;
  from_rad_ = told_.q_rad;
  to_rad_ = more ? plan_.runs[run].q_cmd_rad.front() : rest_.q_rad;
  told_.kp_Nm_per_rad = more ? plan_.runs[run].kp_Nm_per_rad : rest_.kp_Nm_per_rad;
  told_.kd_Nm_s_per_rad = more ? plan_.runs[run].kd_Nm_s_per_rad : rest_.kd_Nm_s_per_rad;
  travel_s_ = approach_s(from_rad_, to_rad_);
  elapsed_s_ = 0.0;
}

/// True at the end of the way.
bool ExcitationPlayer::travelled() noexcept {
  elapsed_s_ += dt_s_;
  const double t = std::min(elapsed_s_ / travel_s_, 1.0);
  told_.q_rad = from_rad_ + t * t * (3.0 - 2.0 * t) * (to_rad_ - from_rad_);
  return t == 1.0;
}

void ExcitationPlayer::play() noexcept {
  const std::vector<double>& commands = plan_.runs[run_].q_cmd_rad;
  const auto sample = static_cast<std::size_t>(++progress_.sample);
  if (sample == commands.size()) {
    progress_.run = progress_.sample = -1;
    approach(run_ + 1);
    return;
  }
  told_.q_rad = commands[sample];
}

const ExcitationPlayer::Told& ExcitationPlayer::step() noexcept {
  begun_ = true;
  switch (phase_) {
    case Phase::kApproach:
      if (travelled()) phase_ = Phase::kSettle, elapsed_s_ = 0.0;
      break;
    case Phase::kSettle:
      elapsed_s_ += dt_s_;
      if (elapsed_s_ < plan_.settle_s) break;
      phase_ = Phase::kPlay;
      progress_.run = static_cast<int>(run_);
      progress_.sample = -1;
      [[fallthrough]];
    case Phase::kPlay:
      play();
      break;
    case Phase::kReturn:
      if (!travelled()) break;
      phase_ = Phase::kOver;
      progress_.over = true;
      [[fallthrough]];
    case Phase::kOver:
      told_ = rest_;
      break;
  }
  return told_;
}

void ExcitationPlayer::give_up() noexcept {
  if (!begun_ || progress_.over) return;
  progress_ = {.over = true, .given_up = true};
  phase_ = Phase::kOver;
  told_ = rest_;
}

double ExcitationPlayer::duration_s() const {
  double sum_s = 0.0, at_rad = rest_.q_rad;
  for (const ExcitationRun& run : plan_.runs) {
    sum_s += approach_s(at_rad, run.q_cmd_rad.front()) + plan_.settle_s +
             dt_s_ * static_cast<double>(run.q_cmd_rad.size() + 3);
    at_rad = run.q_cmd_rad.back();
  }
  return sum_s + approach_s(at_rad, rest_.q_rad) + dt_s_;
}

}  // namespace pmg::control
