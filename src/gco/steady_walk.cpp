#include "gco/steady_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "gco/ground_aware_command.hpp"
#include "gco/motion_composition.hpp"
#include "model/constants.hpp"
#include "model/leg_kinematics.hpp"
#include "pmg/generator.hpp"

namespace pmg::gco {
namespace {

constexpr double kSettleWalk_s = 4.0;  // rate limits of commands and the held height have settled
constexpr int kCycles = 4;             // in each, the ticks fall on other phases

/// Heights of sole points above the ground, from the optimised height.
class Soles {
 public:
  explicit Soles(const model::RobotModel& robot)
      : legs_(robot), attitude_(robot), standing_height_m_(robot.standing_height_m) {}

  void measure(const Reference& reference, const Result& result, SteadyWalk& walk) {
    const auto base = attitude_.compute(reference.q, reference.dq, reference.command[kPitch], reference.command[kRoll],
                                        reference.command_rate[kPitch], reference.command_rate[kRoll]);
    const PerFoot<model::FootKinematics>& feet = legs_.compute(reference.q, reference.dq);
    PerFoot<double> inner = {std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
    PerFoot<double> front = {std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest()};
    PerFoot<double> rear = {std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    for (const Foot foot : {kLeft, kRight}) {
      double lowest = std::numeric_limits<double>::max();
      for (const Eigen::Vector3d& corner_B : feet[foot].sole_B) {
        const Eigen::Vector3d corner = base.R_HB * corner_B;
        lowest = std::min(lowest, corner.z() + standing_height_m_ + result.command[kHeight]);
        front[foot] = std::max(front[foot], corner.x());
        rear[foot] = std::min(rear[foot], corner.x());
        inner[foot] = foot == kLeft ? std::min(inner[foot], corner.y()) : std::max(inner[foot], corner.y());
      }
      if (reference.contact_weight[foot] > 0.0) continue;
      walk.lowest_swing_m = std::min(walk.lowest_swing_m, lowest);
      const double to_middle = wrap_half_cycle(reference.phase - reference.contact_center[foot] - 0.5);
      if (std::abs(to_middle) < 0.2 * (1.0 - reference.duty_factor[foot])) {
        walk.clearance_m = std::min(walk.clearance_m, lowest);
      }
    }
    const bool abreast = rear[kLeft] < front[kRight] && rear[kRight] < front[kLeft];
    if (abreast) walk.foot_gap_m = std::min(walk.foot_gap_m, inner[kLeft] - inner[kRight]);
  }

 private:
  model::LegKinematics legs_;
  model::BaseAttitude attitude_;
  double standing_height_m_;
};

}  // namespace

SteadyWalk walk_steadily(const model::RobotModel& robot, const ClipLibrary& library, const Command& command) {
  Generator generator(library, generator_options(robot));
  GroundAwareCommand ground(robot);
  Soles soles(robot);
  for (double t = 0.0; t < kSettleWalk_s; t += model::kControlPeriod_s)
    ground.solve(generator.step(command, model::kControlPeriod_s));
  SteadyWalk walk;
  walk.lowest_swing_m = walk.clearance_m = walk.foot_gap_m = 1.0;
  SlipStatistics statistics;
  const double rate_per_s = generator.reference().phase_rate_per_s;
  const double whole_cycles_s = rate_per_s > 0.0 ? kCycles / rate_per_s : 1.0;
  for (double duration_s = 0.0; duration_s < whole_cycles_s; duration_s += model::kControlPeriod_s) {
    const Reference& reference = generator.step(command, model::kControlPeriod_s);
    const Result& result = ground.solve(reference);
    statistics.add(reference, result);
    soles.measure(reference, result, walk);
    // The last tick counts only up to the end of the cycles.
    const double dt_s = std::min(model::kControlPeriod_s, whole_cycles_s - duration_s);
    for (std::size_t channel = 0; channel < kChannels; ++channel) {
      walk.mean.u[channel] += result.command.u[channel] * dt_s / whole_cycles_s;
    }
    for (const Foot foot : {kLeft, kRight}) {
      if (reference.contact_weight[foot == kLeft ? kRight : kLeft] == 0.0) {
        walk.pure_single_support_m_s = std::max(walk.pure_single_support_m_s, result.foot[foot].after_m_s);
      }
    }
    walk.limited = walk.limited || reference.command_limited;
    walk.clamped = walk.clamped || reference.joint_clamped;
  }
  walk.slip = statistics.summary();
  walk.admissible = generator.reference().command;
  return walk;
}

std::vector<Command> commands_over_the_box(const model::RobotModel& robot, int count, std::uint64_t seed,
                                           double posture_share) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Command> commands;
  const CommandLimits& limits = robot.command_limits;
  while (std::ssize(commands) < count) {
    Command command;
    bool moves = false;
    for (std::size_t channel = 0; channel < kVelocityChannels; ++channel) {
      if (uniform(0.0, 1.0) < 0.3) continue;
      command.u[channel] = uniform(limits.lower[channel], limits.upper[channel]);
      moves = true;
    }
    if (!moves) continue;
    if (uniform(0.0, 1.0) < 0.5) {
      for (std::size_t channel = kVelocityChannels; channel < kChannels; ++channel) {
        command.u[channel] = posture_share * uniform(limits.lower[channel], limits.upper[channel]);
      }
    }
    commands.push_back(command);
  }
  return commands;
}

}  // namespace pmg::gco
