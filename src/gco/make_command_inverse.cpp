#include "gco/make_command_inverse.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gco/ground_aware_command.hpp"
#include "gco/motion_composition.hpp"
#include "pmg/generator.hpp"

namespace pmg::gco {
namespace {

constexpr std::size_t kAxes = CommandInverse::kAxes.size();
constexpr double kStep_s = 0.02;    ///< 50 to 60 samples per cycle: u' is smooth in the phase
constexpr double kSettle_s = 0.4;   ///< past the stance ramp and the first step of full rates
constexpr double kEnough_s = 10.0;  ///< longer than any gait's period
constexpr int kRounds = 6;          ///< of the fixed point; it converges in three or four
constexpr double kLargestShare = 0.4;

GeneratorOptions immediate(const model::RobotModel& robot) {
  GeneratorOptions options = generator_options(robot);
  options.limits.rate_per_s.fill(1e3);
  options.double_support_rate = 1.0;
  return options;
}

ClipLibrary without_inverse(ClipLibrary library) {
  library.inverse = {};
  return library;
}

/// Generator and optimisation, built once for many commands.
class Measurement {
 public:
  Measurement(const model::RobotModel& robot, const ClipLibrary& library)
      : generator_(without_inverse(library), immediate(robot)), gco_(robot) {}

  /// u' averaged over one cycle, weighted by phase; at rest the first u'.
  Command mean(const Command& command) {
    generator_.reset();
    gco_.reset();
    for (double t = 0.0; t < kSettle_s; t += kStep_s) gco_.solve(generator_.step(command, kStep_s));
    Command sum;
    double cycles = 0.0;
    for (double t = 0.0; cycles < 1.0 && t < kEnough_s; t += kStep_s) {
      const Reference& reference = generator_.step(command, kStep_s);
      const Command& optimised = gco_.solve(reference).command;
      if (reference.gain == 0.0) return optimised;
      // The last step counts only up to the end of the cycle.
      const double share = std::min(reference.phase_rate_per_s * kStep_s, 1.0 - cycles);
      for (std::size_t c = 0; c < kChannels; ++c) sum.u[c] += share * optimised.u[c];
      cycles += share;
    }
    return sum;
  }

 private:
  Generator generator_;
  GroundAwareCommand gco_;
};

/// The command, scaled down to 90 % of the velocities' common reach. The generator scales larger ones down itself, and
/// with them any correction.
Command within_reach(const model::RobotModel& robot, const ClipLibrary& library, const Command& command) {
  const double reach = 0.9 * (library.blend == Blend::kCorners ? kCornerReach : 1.0);
  const VelocityScale scale =
      library.velocity_scale.value_or(VelocityScale{robot.velocity_scale_negative, robot.velocity_scale_positive});
  double asked = 0.0;
  for (std::size_t c = 0; c < kVelocityChannels; ++c)
    asked += std::abs(command.u[c]) / (command.u[c] < 0.0 ? scale.negative[c] : scale.positive[c]);
  Command target = command;
  for (std::size_t c = 0; c < kVelocityChannels; ++c) target.u[c] /= std::max(1.0, asked / reach);
  return target;
}

std::array<std::vector<double>, kAxes> grid(const model::RobotModel& robot) {
  std::array<std::vector<double>, kAxes> axis;
  for (std::size_t a = 0; a < kAxes; ++a) {
    const Channel channel = CommandInverse::kAxes[a];
    const double lower = robot.command_limits.lower[channel], upper = robot.command_limits.upper[channel];
    // Finer near rest: a small gain of one clip already has most of its effect on the others.
    for (const double share : {1.0, 0.6, 0.25}) {
      if (lower < 0.0) axis[a].push_back(share * lower);
    }
    axis[a].push_back(0.0);
    for (const double share : {0.25, 0.6, 1.0}) {
      if (upper > 0.0 && channel != kHeight) axis[a].push_back(share * upper);
    }
  }
  return axis;
}

/// Fixed point of correction += target - mean(target + correction); returns the correction with the smallest error.
CommandInverse::Node correction_at(const model::RobotModel& robot, const Command& target, Measurement& measurement) {
  const CommandLimits& limits = robot.command_limits;
  CommandInverse::Node correction{}, best{};
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    Command asked = target;
    for (std::size_t a = 0; a < kAxes; ++a) asked.u[CommandInverse::kAxes[a]] += correction[a];
    const Command mean = measurement.mean(asked);
    double error = 0.0;
    CommandInverse::Node next = correction;
    for (std::size_t a = 0; a < kAxes; ++a) {
      const Channel c = CommandInverse::kAxes[a];
      const double range = limits.upper[c] - limits.lower[c];
      error += std::pow((target[c] - mean[c]) / range, 2);
      const double largest = kLargestShare * 0.5 * range;
      next[a] = std::clamp(correction[a] + target[c] - mean[c], std::max(-largest, limits.lower[c] - target[c]),
                           std::min(largest, limits.upper[c] - target[c]));
    }
    if (error < least) {
      least = error;
      best = correction;
    }
    correction = next;
  }
  return best;
}

}  // namespace

Command mean_optimised_command(const model::RobotModel& robot, const ClipLibrary& library, const Command& command) {
  return Measurement(robot, library).mean(command);
}

CommandInverse make_command_inverse(const model::RobotModel& robot, const ClipLibrary& library,
                                    const work::Progress& progress) {
  const auto axis = grid(robot);
  std::size_t nodes = 1;
  for (const std::vector<double>& values : axis) nodes *= values.size();
  std::vector<CommandInverse::Node> correction(nodes);
  Measurement measurement(robot, library);
  for (std::size_t i = 0; i < nodes; ++i) {
    Command command;
    std::size_t index = i;
    for (std::size_t a = kAxes; a-- > 0;) {
      command[CommandInverse::kAxes[a]] = axis[a][index % axis[a].size()];
      index /= axis[a].size();
    }
    const bool rest = command[kVx] == 0.0 && command[kVy] == 0.0 && command[kOmega] == 0.0;
    if (!rest) correction[i] = correction_at(robot, within_reach(robot, library, command), measurement);
    progress.report_or_throw(static_cast<double>(i + 1) / static_cast<double>(nodes));
  }
  return {axis, correction};
}

}  // namespace pmg::gco
