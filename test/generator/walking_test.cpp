// The clips of Z1 as the robot walks by them: the generator's references on the ground that the ground-aware
// optimisation finds, in steady state.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "gco/ground_aware_command.hpp"
#include "gco/motion_composition.hpp"
#include "gco/slip_statistics.hpp"
#include "model/clip_library_file.hpp"
#include "model/robot_model.hpp"
#include "pmg/generator.hpp"

namespace pmg::generator {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kSettle_s = 4.0;  // commands at their rate limits, height of the ground-aware optimisation
constexpr int kCycles = 4;         // ticks fall on other phases in each

struct Walk {
  gco::SlipSummary slip;
  double pure_single_support_m_s = 0.0;  ///< largest slip where the other foot has no contact weight
  Command mean;                          ///< u' over whole cycles
  bool limited = false;
};

class WalkingZ1 : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    robot_ = new model::RobotModel(model::load_robot(model::find_robot("z1")));
    ClipLibrary library = model::load_clip_library(robot_->directory / "clips", *robot_);
    library.inverse = {};  // the clips themselves; make_command_inverse_test.cpp has the inverse
    library_ = new ClipLibrary(std::move(library));
  }
  static void TearDownTestSuite() {
    delete library_;
    delete robot_;
  }

  static Walk walk(const Command& command) {
    Generator generator(*library_, gco::generator_options(*robot_));
    gco::GroundAwareCommand ground(*robot_);
    for (double t = 0.0; t < kSettle_s; t += kTick_s) {
      ground.solve(generator.step(command, kTick_s));
    }
    Walk out;
    gco::SlipStatistics statistics;
    double duration_s = 0.0;
    const double whole_cycles_s = kCycles / generator.reference().phase_rate_per_s;
    while (duration_s < whole_cycles_s) {
      const Reference& reference = generator.step(command, kTick_s);
      const gco::Result& result = ground.solve(reference);
      statistics.add(reference, result);
      // The last tick counts as far as the cycles last.
      const double dt_s = std::min(kTick_s, whole_cycles_s - duration_s);
      duration_s += kTick_s;
      for (std::size_t channel = 0; channel < kChannels; ++channel) {
        out.mean.u[channel] += result.command.u[channel] * dt_s / whole_cycles_s;
      }
      for (const Foot foot : {kLeft, kRight}) {
        if (reference.contact_weight[foot == kLeft ? kRight : kLeft] == 0.0) {
          out.pure_single_support_m_s = std::max(out.pure_single_support_m_s, result.foot[foot].after_m_s);
        }
      }
      out.limited = out.limited || reference.command_limited;
    }
    out.slip = statistics.summary();
    return out;
  }

  static void expect_feet_on_the_ground(const Walk& walk, const std::string& what) {
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
        const Walk walked = walk(command);
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

// Those of config/scenarios/tour.yaml.
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

}  // namespace
}  // namespace pmg::generator
