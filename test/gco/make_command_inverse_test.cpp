// The effect of a robot's command inverse: u' averages to the user's command.
#include "gco/make_command_inverse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "model/clip_library_file.hpp"
#include "model/command_inverse_file.hpp"
#include "model/robot_model.hpp"

namespace pmg::gco {
namespace {

class CommandInverseOfZ1 : public testing::Test {
 protected:
  const model::RobotModel robot_ = model::load_robot(model::find_robot("z1"));
  const ClipLibrary library_ = model::load_clip_library(robot_.directory / "clips", robot_);

  /// |u' - u| of vx, vy, omega, height.
  CommandInverse::Node error(const Command& asked, const Command& user) const {
    const Command mean = mean_optimised_command(robot_, library_, asked);
    CommandInverse::Node error{};
    for (std::size_t a = 0; a < error.size(); ++a) {
      error[a] = std::abs(mean[CommandInverse::kAxes[a]] - user[CommandInverse::kAxes[a]]);
    }
    return error;
  }

  Command draw(std::mt19937& random) const {
    Command command;
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    // Velocities that the clips can give together, with room for the correction.
    std::array<double, kVelocityChannels> share{};
    double sum = 0.0;
    for (double& s : share) sum += s = uniform(0.0, 1.0) < 0.5 ? 0.0 : uniform(0.1, 1.0);
    for (std::size_t c = 0; c < kVelocityChannels; ++c) {
      const bool negative = uniform(0.0, 1.0) < 0.5;
      const double scale = negative ? -robot_.velocity_scale_negative[c] : robot_.velocity_scale_positive[c];
      command.u[c] = 0.8 * scale * share[c] / std::max(1.0, sum);
    }
    command[kPitch] = uniform(0.0, 0.2);
    command[kRoll] = uniform(-0.1, 0.1);
    command[kHeight] = uniform(-0.10, -0.02);
    return command;
  }
};

TEST_F(CommandInverseOfZ1, BringsTheMeanOptimisedCommandToTheUsers) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random(kSeed);
  constexpr int kCommands = 200;
  CommandInverse::Node before{}, after{}, worst{};
  for (int i = 0; i < kCommands; ++i) {
    const Command user = draw(random);
    const auto plain = error(user, user), corrected = error(library_.inverse.apply(user), user);
    for (std::size_t a = 0; a < plain.size(); ++a) {
      before[a] += plain[a] / kCommands;
      after[a] += corrected[a] / kCommands;
      worst[a] = std::max(worst[a], corrected[a]);
    }
  }
  // Residual errors from the grid's spacing, about twice the measured ones. They include pitch and roll, which the
  // table doesn't know.
  const CommandInverse::Node left = {0.008, 0.008, 0.014, 0.003}, left_at_most = {0.07, 0.08, 0.09, 0.015};
  for (std::size_t a = 0; a < before.size(); ++a) {
    SCOPED_TRACE(kChannelNames[CommandInverse::kAxes[a]]);
    EXPECT_LT(after[a], 0.7 * before[a]);
    EXPECT_LT(after[a], left[a]);
    EXPECT_LT(worst[a], left_at_most[a]);
  }
}

TEST_F(CommandInverseOfZ1, LeavesRestAtRest) {
  Command posture;
  posture[kPitch] = 0.3;
  posture[kHeight] = -0.13;
  EXPECT_EQ(library_.inverse.apply(posture), posture);
}

TEST_F(CommandInverseOfZ1, IsWhatPmgClipsMakesOfTheClips) {
  ASSERT_FALSE(library_.inverse.empty());
  const CommandInverse again = make_command_inverse(robot_, library_);
  EXPECT_EQ(again.axis(), library_.inverse.axis());
  ASSERT_EQ(again.correction().size(), library_.inverse.correction().size());
  for (std::size_t i = 0; i < again.correction().size(); ++i) {
    for (std::size_t a = 0; a < CommandInverse::kAxes.size(); ++a) {
      // Another machine's libm rounds differently: micrometres after a cycle of kinematics.
      EXPECT_NEAR(again.correction()[i][a], library_.inverse.correction()[i][a], 1e-6) << "node " << i;
    }
  }
}

}  // namespace
}  // namespace pmg::gco
