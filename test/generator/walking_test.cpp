// Z1 walks by its clips: the generator's references on the ground found by the ground-aware optimisation, in steady
// state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "gco/steady_walk.hpp"
#include "model/clip_library_file.hpp"
#include "model/robot_model.hpp"

namespace pmg::generator {
namespace {

class WalkingZ1 : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    robot_ = new model::RobotModel(model::load_robot(model::find_robot("z1")));
    ClipLibrary library = model::load_clip_library(robot_->directory / "clips", *robot_);
    library.inverse = {};  // only the clips; make_command_inverse_test.cpp tests the inverse
    library_ = new ClipLibrary(std::move(library));
  }
  static void TearDownTestSuite() {
    delete library_;
    delete robot_;
  }

  static gco::SteadyWalk walk(const Command& command) { return gco::walk_steadily(*robot_, *library_, command); }

  static void expect_feet_on_the_ground(const gco::SteadyWalk& walk, const std::string& what) {
    EXPECT_EQ(walk.slip.not_converged_ticks, 0) << what;
    EXPECT_LE(walk.pure_single_support_m_s, 0.001) << what;
    EXPECT_LE(walk.slip.double_support_mean_m_s, 0.03) << what;
    EXPECT_LE(walk.slip.double_support_p95_m_s, 0.10) << what;
    EXPECT_LE(walk.slip.lower_foot_height_max_m, 0.001) << what;
    EXPECT_LE(walk.slip.other_foot_height_max_m, 0.010) << what;
  }

  inline static const model::RobotModel* robot_ = nullptr;
  inline static const ClipLibrary* library_ = nullptr;
};

TEST_F(WalkingZ1, KeepsItsFeetOnTheGroundAndItsVelocityAlongEveryAxis) {
  for (const Channel channel : {kVx, kVy, kOmega}) {
    for (const double sign : {1.0, -1.0}) {
      const double scale =
          sign > 0.0 ? robot_->velocity_scale_positive[channel] : robot_->velocity_scale_negative[channel];
      for (const double gain : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        Command command;
        command[channel] = sign * gain * scale;
        const std::string what = std::string(kChannelNames[channel]) + " = " + std::to_string(command[channel]);
        const gco::SteadyWalk walked = walk(command);
        expect_feet_on_the_ground(walked, what);
        EXPECT_FALSE(walked.limited) << what;
        for (const Channel velocity : {kVx, kVy, kOmega}) {
          EXPECT_NEAR(walked.mean[velocity], command[velocity], 0.05) << what << ", " << kChannelNames[velocity];
        }
      }
    }
  }
}

struct Mixture {
  const char* name;
  Command command;  ///< vx, vy, omega, pitch, roll, height
};

// The mixtures of config/scenarios/tour.yaml.
const std::vector<Mixture> kTour = {{"circle", {{0.5, 0.0, 0.4, 0.0, 0.0, 0.0}}},
                                    {"diagonal", {{0.4, 0.2, 0.0, 0.0, 0.0, 0.0}}},
                                    {"crouched", {{0.4, 0.0, 0.0, 0.0, 0.0, -0.08}}},
                                    {"bent forward", {{0.4, 0.0, 0.0, 0.25, 0.0, 0.0}}},
                                    {"leaning to the right", {{0.4, 0.0, 0.0, 0.0, 0.12, 0.0}}},
                                    {"leaning to the left", {{0.4, 0.0, 0.0, 0.0, -0.12, 0.0}}},
                                    {"turning crouched", {{0.0, 0.0, 0.5, 0.0, 0.0, -0.05}}},
                                    {"all six", {{0.3, 0.1, 0.2, 0.1, 0.05, -0.04}}}};

TEST_F(WalkingZ1, KeepsItsFeetOnTheGroundInTheToursMixtures) {
  for (const Mixture& mixture : kTour) {
    expect_feet_on_the_ground(walk(mixture.command), mixture.name);
  }
}

// With superposition alone (no clips of two velocities), the limits hold on average over the box, not for each command.
TEST_F(WalkingZ1, CombinedCommandsKeepTheirSizeAndTheFeetOnTheGroundOnAverageUnderCorners) {
  ClipLibrary corners = *library_;
  corners.blend = Blend::kCorners;
  constexpr int kCommands = 40;
  double slip_m_s = 0.0, slip_p95_m_s = 0.0;
  for (const Command& command : gco::commands_over_the_box(*robot_, kCommands, 11, 0.0)) {
    const gco::SteadyWalk walked = gco::walk_steadily(*robot_, corners, command);
    double asked = 0.0;
    for (const Channel channel : {kVx, kVy, kOmega}) {
      const double scale =
          command[channel] < 0.0 ? robot_->velocity_scale_negative[channel] : robot_->velocity_scale_positive[channel];
      asked += std::abs(command[channel]) / scale;
    }
    const double share = std::min(1.0, kCornerReach / asked);
    for (const Channel channel : {kVx, kVy, kOmega}) {
      EXPECT_NEAR(walked.admissible[channel], share * command[channel], 1e-9);
      // Without the command inverse: joints blend linearly, but the feet don't move linearly.
      EXPECT_NEAR(walked.mean[channel], share * command[channel], 0.10) << kChannelNames[channel];
    }
    EXPECT_LE(walked.pure_single_support_m_s, 0.001);
    EXPECT_LE(walked.slip.lower_foot_height_max_m, 0.001);
    EXPECT_FALSE(walked.clamped);
    slip_m_s += walked.slip.double_support_mean_m_s / kCommands;
    slip_p95_m_s += walked.slip.double_support_p95_m_s / kCommands;
  }
  EXPECT_LE(slip_m_s, 0.03);
  EXPECT_LE(slip_p95_m_s, 0.10);
}

}  // namespace
}  // namespace pmg::generator
